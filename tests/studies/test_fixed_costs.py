"""What runs of studies take beside their points, and what has changed since the last one."""

from pathlib import Path
from typing import Any

import disc_model as dm
from disc_model.studies.changed_values import changes_since
from disc_model.studies.fixed_costs import BATCH, FIGURE, MERGE, PAGE, START, fixed_costs
from disc_model.studies.grid import GridStudy
from disc_model.studies.plan import plan_of
from disc_model.studies.study import Study, parse_study

PLATE = {"N": 200, "n_diameters": 1}
CURVE = {"kind": "curve", "variable": "growth_rate", "x": "Omega"}


def small(**content: Any) -> Study:
    """A study of two speeds with a figure."""
    known: dict[str, Any] = {"study": "s", "quantity": "floquet", "base": PLATE}
    known |= {"axes": {"Omega": [40, 50]}, "figures": {"f": CURVE}}
    return parse_study(known | content)


def grid_of(study: Study) -> GridStudy:
    """The grid of a study."""
    assert study.grid is not None
    return study.grid


def test_a_run_takes_the_start_of_jobs_and_figures(tmp_path: Path) -> None:
    """A plan said less than a second of a run that took 20 s."""
    study = small()
    grid = grid_of(study)
    figures = study.entries({"s": grid})
    plans = [plan_of(grid, tmp_path)]
    whole = fixed_costs(plans, figures, tmp_path)
    assert whole == (START, (BATCH, MERGE, FIGURE))
    assert fixed_costs(plans, figures, tmp_path, page=True).jobs == (*whole.jobs, PAGE)

    for name in grid.batches:
        file = tmp_path / "s" / "batches" / f"{name}.nc"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.touch()
    done = [plan_of(grid, tmp_path)]
    assert fixed_costs(done, figures, tmp_path) == (START, (FIGURE,))
    picture = tmp_path / "s" / "figures" / "f.png"
    picture.parent.mkdir()
    picture.touch()
    assert fixed_costs(done, figures, tmp_path) == (0.0, ())
    assert fixed_costs(plans, figures, tmp_path) == whole


def test_a_plan_says_which_values_have_changed(tmp_path: Path) -> None:
    """Only "input files updated by another job" was said."""
    content = {"study": "s", "quantity": "floquet", "base": PLATE, "axes": {"Omega": [40, 50]}}
    (tmp_path / "s").mkdir()
    assert changes_since(grid_of(small()), tmp_path) == []
    dm.save(dm.run_study(content), tmp_path / "s" / "s.nc")
    assert changes_since(grid_of(small()), tmp_path) == []

    more = grid_of(small(base=PLATE | {"N": 210, "mu_k": 0.1}, axes={"Omega": [40, 50, 60]}))
    assert changes_since(more, tmp_path) == [
        "base.N: 200 -> 210",
        "base.mu_k: 0.24 -> 0.1",
        "axes.Omega: 2 values -> 3 values",
    ]
    other = grid_of(small(options={"tol": 1e-11}, axes={"Omega": [40, 51]}))
    assert changes_since(other, tmp_path) == [
        "options.tol: 1e-12 -> 1e-11",
        "axes.Omega: other values",
    ]
