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


def lab_disc(omega: float) -> dict[str, Any]:
    """A disc of one mode."""
    return {
        "diameters": [1],
        "circles": [0],
        "omega": [omega],
        "amplitude": [1.5],
        "damping_ratio": [0.002],
    }


def changes_between(before: dict[str, Any], now: dict[str, Any], results: Path) -> list[str]:
    """What a plan says has changed between two files of a study, once the first one was computed."""
    folder = results / "s"
    folder.mkdir()
    dm.save(dm.run_study({"study": "s"} | before), folder / "s.nc")
    return changes_since(grid_of(parse_study({"study": "s"} | now)), results)


def cycles(**content: Any) -> dict[str, Any]:
    """A study of cycles at two speeds."""
    return {"quantity": "floquet", "axes": {"Omega": [40, 50]}} | content


def test_a_plan_says_nothing_of_the_plate_beside_a_disc(tmp_path: Path) -> None:
    """Of one change it said twelve: each number that a plate has was "not given" before."""
    given = {"N": 200, "r_0": 0.2, "disc": lab_disc(900), "mu_s": 0.46}
    before = cycles(base=given)
    changed = cycles(base=given | {"mu_s": 0.47})
    assert changes_between(before, changed, tmp_path) == ["base.mu_s: 0.46 -> 0.47"]
    other = grid_of(parse_study({"study": "s"} | cycles(base=given | {"disc": lab_disc(905)})))
    assert changes_since(other, tmp_path) == ["base.disc: other numbers in its table"]
    plate = grid_of(small())
    assert "base.disc: a disc given by 1 mode -> not given" in changes_since(plate, tmp_path)
    assert not any("base.h:" in each for each in changes_since(plate, tmp_path))


def test_a_plan_says_nothing_of_the_plate_beside_an_axis_of_discs(tmp_path: Path) -> None:
    """Each number of a plate was "not given" before, and another table of a disc was not named."""
    discs = {"thin": lab_disc(900), "thick": lab_disc(950)}
    axes = {"Omega": [40, 50], "disc": ["thin", "thick"]}
    before = cycles(base={"N": 200, "r_0": 0.2}, axes=axes, discs=discs)
    now = before | {"discs": discs | {"thick": lab_disc(960)}}
    found = changes_between(before, now, tmp_path)
    assert found == ["discs.thick: other numbers in its table"]


def test_a_plan_says_nothing_of_the_damping_that_a_ratio_replaces(tmp_path: Path) -> None:
    """D_star was "not given" before."""
    same = cycles(base=PLATE | {"damping_ratio": 0.01})
    assert changes_between(same, same, tmp_path) == []


def test_a_plan_says_nothing_of_the_order_of_an_option(tmp_path: Path) -> None:
    """A distribution had changed, as results keep its parts in another order."""
    drawn = {"distribution": "uniform", "low": "45 N/mm", "high": 55000}
    options = {"samples": 2, "distributions": {"k": drawn}}
    before = {
        "quantity": "sensitivity",
        "base": PLATE | {"Omega": 40},
        "axes": {"m": [1.0, 1.1]},
        "options": options,
    }
    wider = options | {"distributions": {"k": drawn | {"high": 56000}}}
    found = changes_between(before, before | {"options": wider}, tmp_path)
    assert found == ["options.distributions.k.high: 55000 -> 56000"]
