"""What README and docs say of a benchmark's run."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from disc_model.errors import DiscModelError
from docs import write_benchmark_pages as pages

ROOT = Path(__file__).parents[2]
SPEED, MODES = (json.loads((ROOT / "docs" / f"{name}.json").read_text(encoding="utf-8")) for name in pages.STORED)


def test_every_number_on_speed_and_modes_is_of_the_one_stored_run() -> None:
    known = pages.stored_passages(ROOT / "docs")
    named = set()
    for name in pages.PAGES:
        text = (ROOT / name).read_text(encoding="utf-8")
        assert pages.fill(text, known) == text, f"{name}: run `make bench-pages`"
        named |= set(re.findall(r"<!-- bench (\w+) -->", text))
    assert named == known.keys()


def test_what_a_run_on_speed_comes_to(dataset: xr.Dataset, priced: xr.Dataset) -> None:
    """A quarter of the costs of conftest's RK4 is Python; natively, the engine is given half of its costs."""
    heyoka = dataset.assign_coords(solver=[{"RK4": "heyoka"}.get(name, name) for name in dataset["solver"].values])
    fast = heyoka.copy(deep=True)
    fast["marginal_cost"].loc[{"solver": "series"}] *= 0.5
    run = pages.speed_numbers(fast, heyoka, priced)
    assert json.loads(json.dumps(run)) == run
    # of conftest's methods, whose costs are laid down: 1 ms a further second at the default
    assert run["own"] == [{"letter": "a", "ms": pytest.approx(0.5), "error": pytest.approx(5e-11)}]
    assert run["narrow"][0]["ms"] == pytest.approx(1.0)
    assert run["glue"] == [{"letter": letter, "share": pytest.approx(25.0)} for letter in "ab"]
    assert run["costs"]["heyoka"]["(a), times"] == pytest.approx(2 * run["narrowly"][0]["times"])
    assert run["answers"]["late"]["first_separation"] == {"seconds": 2.0, "at": "tol=0.01", "wrong": [1.0, 0.3]}
    price = {"seconds": 0.018, "at": "tol=1e-4", "wrong": []}
    run["answers"]["series (this package)"] = {"first_separation": price}
    run["answers"]["series, from the cycle itself"]["growth_rate"] = price
    text = "".join(pages.passages(run, MODES).values())
    assert "| heyoka | 630 | - |" in text
    assert "| series, modes, rigid contact | 4, 8 | - | - |" in text
    assert "Python restarts heyoka; this accounts for 25 % for" in text
    assert "only, the package takes 1 ms for (a). heyoka always" in text
    with pytest.raises(DiscModelError, match="another machine"):
        pages.speed_numbers(dataset, dataset, priced.assign_attrs(machine="another machine"))


# ----------------------------------------------------------------------------------------------------
# Numbers of modes


@pytest.fixture
def study() -> xr.Dataset:
    """A case whose residual values have settled from nine modes on, while rigid ones go on growing."""
    rigid, residual = np.array([1.0, 2.0, 3.0, 4.0, 5.0]), np.array([1.0, 2.0, 2.001, 2.0, 2.0])
    dims = ("case", "contact", "model")
    data = {name: (dims, np.array([[rigid, residual]])) for name in pages.TABLED}
    data["modes"] = (dims, np.array([[[1.0, 9.0, 17.0, 34.0, 165.0]] * 2]))
    data["growth_rate"][1][..., -1] = np.nan  # too many modes
    return xr.Dataset(
        data,
        {"case": ["orthonormal, N=1"], "contact": ["rigid", "residual"], "model": ["0,0", "4,0", "8,0", "8,1", "16,4"]},
        {"machine": "a machine", "most_growth": 80},
    )


@pytest.mark.parametrize(
    ("values", "first"),
    [
        ([1.0, 2.0, 2.01, 2.0, 2.0], 1),
        ([2.0, 2.0, 2.5, 2.0, 2.0], None),  # two that agree are too few
        ([2.0, 2.5, 2.0, 2.0, 2.0], 2),  # that the first agrees too is chance
        ([1.0, 2.0, None, None, None], 2),  # settled to none
        ([2.0, 2.0, 2.0, 2.0, None], None),
        ([-2.0, -2.0, -2.01], 0),
    ],
)
def test_what_has_settled_agrees_with_two_larger_models(values: list[float | None], first: int | None) -> None:
    assert pages.settled(values, 0.01) == first


def test_a_run_on_modes_comes_to_words(study: xr.Dataset) -> None:
    run = pages.mode_numbers(study)
    assert json.loads(json.dumps(run)) == run
    known = pages.passages(SPEED, run)
    rigid, residual, _, counted = known["truncation_settled"].strip().splitlines()[2:]
    assert rigid.startswith("| orthonormal, N=1 | rigid | **not** |")
    assert residual.count("| from 9 ") == 7
    counts = "0 of 7 quantities with rigid contact, 7 of 7 quantities with residual contact"
    assert counted == f"Converged within 165 modes: {counts}."
