"""What README and docs say of a benchmark's run."""

import json
import re
from pathlib import Path

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


def test_what_a_run_on_speed_comes_to(dataset: xr.Dataset, priced: xr.Dataset) -> None:
    """A quarter of the costs of conftest's RK4 is Python; natively, the engine is given half of its
    costs."""
    heyoka = dataset.assign_coords(
        solver=[{"RK4": "heyoka"}.get(name, name) for name in dataset["solver"].values]
    )
    fast = heyoka.copy(deep=True)
    fast["marginal_cost"].loc[{"solver": "series"}] *= 0.5
    run = pages.speed_numbers(fast, heyoka, priced)
    assert json.loads(json.dumps(run)) == run
    # of conftest's methods, whose costs are laid down: 1 ms a further second at the default
    assert run["own"] == [{"letter": "a", "ms": pytest.approx(0.5), "error": pytest.approx(5e-11)}]
    assert run["narrow"][0]["ms"] == pytest.approx(1.0)
    assert run["glue"] == [{"letter": letter, "share": pytest.approx(25.0)} for letter in "ab"]
    assert run["costs"]["heyoka"]["(a), times"] == pytest.approx(2 * run["narrowly"][0]["times"])
    assert run["cycle"] == []  # conftest's cycle has no growth rate
    text = "".join(
        pages.passages(run | {"cycle": [{"ms": 1.23}], "scaling": SPEED["scaling"]}).values()
    )
    assert "1.2 ms" in text
    assert "| heyoka | 630 | - |" in text
    assert "Of heyoka's time, 25 % for (a) and 25 % for (b) is spent in Python" in text
    assert "only, the package takes 1 ms for (a). heyoka, which" in text
    with pytest.raises(DiscModelError, match="another machine"):
        pages.speed_numbers(dataset, dataset, priced.assign_attrs(machine="another machine"))
