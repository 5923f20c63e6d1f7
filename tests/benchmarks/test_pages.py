"""What README and docs say of a benchmark's run."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

from disc_model.errors import DiscModelError
from docs import write_benchmark_pages as pages

ROOT = Path(__file__).parents[2]
SPEED = json.loads((ROOT / "docs" / "benchmark.json").read_text(encoding="utf-8"))


def test_every_number_on_speed_is_of_the_one_stored_run() -> None:
    known = pages.passages(SPEED)
    named = set()
    for name in pages.PAGES:
        text = (ROOT / name).read_text(encoding="utf-8")
        assert pages.fill(text, known) == text, f"{name}: run `make bench-pages`"
        named |= set(re.findall(r"<!-- bench (\w+) -->", text))
    assert named == known.keys()


@pytest.fixture
def heyoka(dataset: xr.Dataset) -> xr.Dataset:
    """Speed against accuracy, with RK4 as heyoka; a quarter of its costs is Python."""
    solvers = dataset["solver"].values
    names = ["heyoka" if name == "RK4" else name for name in solvers]
    return dataset.assign_coords(solver=names)


@pytest.fixture
def run(heyoka: xr.Dataset, priced: xr.Dataset) -> dict[str, Any]:
    """Numbers of a run in which the engine takes half of its costs if compiled natively."""
    fast = heyoka.copy(deep=True)
    fast["marginal_cost"].loc[{"solver": "series"}] *= 0.5
    return pages.speed_numbers(fast, heyoka, priced)


def test_a_run_on_speed_is_stored_as_json(run: dict[str, Any]) -> None:
    assert json.loads(json.dumps(run)) == run


def test_a_run_on_speed_has_the_costs_that_are_laid_down(run: dict[str, Any]) -> None:
    """The engine takes 1 ms a further second at the default."""
    assert run["own"] == [{"letter": "a", "ms": pytest.approx(0.5), "error": pytest.approx(5e-11)}]
    assert run["narrow"][0]["ms"] == pytest.approx(1.0)
    assert run["glue"] == [{"letter": letter, "share": pytest.approx(25.0)} for letter in "ab"]
    narrowly = run["narrowly"][0]["times"]
    assert run["costs"]["heyoka"]["(a), times"] == pytest.approx(2 * narrowly)
    assert run["cycle"] == []  # conftest's cycle has no growth rate


def test_passages_say_the_numbers_of_a_run(run: dict[str, Any]) -> None:
    shares = [
        {
            "quantity": quantity, "points": 4, "seconds": seconds, "simulated": 4000.0,
            "simulation": 60.0, "newton": 25.0, "return_maps": 10.0, "rest": 5.0,
        }
        for quantity, seconds in (("floquet", 0.02), ("outcome", 1.0))
    ]  # fmt: skip
    more = {"cycle": [{"ms": 1.23}], "scaling": SPEED["scaling"], "shares": shares}
    numbers = {**run, **more}
    text = "".join(pages.passages(numbers).values())
    assert "1.2 ms" in text
    assert "| heyoka | 630 | - |" in text
    assert "Of heyoka's time, 25 % for (a) and 25 % for (b) is spent in Python" in text
    assert "only, the package takes 1 ms for (a). heyoka, which" in text
    assert "| `outcome` | 0.25 | 1,000 | 60 % | 25 % | 10 % | 5 % |\n| `floquet` | 0.005 |" in text


def test_times_of_a_quantity_become_percentages() -> None:
    columns = {"seconds": 2.0, "simulation": 1.0, "newton": 0.5, "return_maps": 0.3, "rest": 0.2}
    dataset = xr.Dataset({name: ("row", [value]) for name, value in columns.items()})
    (row,) = pages.share_numbers(dataset)
    assert row["seconds"] == 2.0
    parts = [row[part] for part in ("simulation", "newton", "return_maps", "rest")]
    assert parts == pytest.approx([50, 25, 15, 10])


def test_datasets_of_two_machines_make_no_run(dataset: xr.Dataset, priced: xr.Dataset) -> None:
    with pytest.raises(DiscModelError, match="another machine"):
        pages.speed_numbers(dataset, dataset, priced.assign_attrs(machine="another machine"))
