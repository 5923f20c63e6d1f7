"""Grid studies: what files may say, how grids become batches, and what of a grid is left out."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model import floquet
from disc_model.data.variables import flag_names
from disc_model.figures.kinds import render
from disc_model.parameters import Parameters
from disc_model.simulation.case import Start
from disc_model.studies import grid as parts_of
from disc_model.studies import run
from disc_model.studies.grid import GridStudy
from disc_model.studies.merge import merge_batches
from disc_model.studies.point_lists import failures
from disc_model.studies.quantity import Point
from disc_model.studies.run import run_batch
from disc_model.studies.study import load_study, parse_study
from tests.studies.conftest import computed, study
from tests.studies.refused import faults_of, parse_grid


def points(grid: GridStudy) -> list[list[list[Any]]]:
    return [json.loads(text)["points"] for text in grid.batches.values()]


def test_batches_are_fixed_axes_times_chunks_of_blocks() -> None:
    grid = parse_grid(study())
    assert points(grid) == [
        [[100.0, 10.0], [100.0, 15.0]], [[100.0, 20.0]],
        [[200.0, 10.0], [200.0, 15.0]], [[200.0, 20.0]],
        [[300.0, 10.0], [300.0, 15.0]], [[300.0, 20.0]],
    ]  # fmt: skip
    assert grid.n_points == 9
    for name in grid.batches:
        assert len(name) == 12


def test_changes_change_only_the_batches_they_touch() -> None:
    before = set(parse_grid(study()).batches)
    axes = study()["axes"]
    assert (
        len(set(parse_grid(study(axes={**axes, "N": [100, 150, 200, 300]})).batches) - before) == 2
    )
    assert set(parse_grid(study(axes={**axes, "N": [100, 300]})).batches) < before
    assert not before & set(parse_grid(study(base={"mu_k": 0.23})).batches)
    assert not before & set(parse_grid(study(options={"horizon": 3})).batches)
    longer = {"blocks": [axes["Omega"], [12.5]]}
    assert len(set(parse_grid(study(axes={**axes, "Omega": longer})).batches) - before) == 3


def test_an_axis_may_end_at_infinity() -> None:
    """JSON has no infinity: the batches had a word in its place, and could not be merged."""
    axes = {"friction_decay": [0.5, "inf", 2], "c_p": [0.0, 0.1]}
    base = {"N": 300, "Omega": 14, "n_diameters": 1}
    done = computed(quantity="floquet", base=base, axes=axes)
    assert done["friction_decay"].values.tolist() == [0.5, 2, np.inf]
    for decay in done["friction_decay"].values:
        for c_p in done["c_p"].values:
            own = floquet(Parameters(**base, friction_decay=decay, c_p=c_p))
            found = done["growth_rate"].sel(friction_decay=decay, c_p=c_p)
            np.testing.assert_equal(found.item(), own.growth_rate)
    plane = computed(
        quantity="regions", options={"horizon": 1}, base=base | {"c_p": 0.1}, axes={
            "friction_decay": [0.5, math.inf], "mu_s": [0.3, 0.4],
        }
    )  # fmt: skip
    assert plane["friction_decay"].values.tolist() == [0.5, np.inf]


def test_a_perturbation_along_an_axis_is_added_to_that_of_the_start() -> None:
    p = Parameters(N=200, Omega=20)
    start = Start(perturbation={"u": 2e-3, "f": 1.0})
    varied = {"perturbation_u": 1e-3, "N": 200}
    point = run._point(p, varied, start)
    assert isinstance(point, Point)
    assert point.start.perturbation == pytest.approx({"u": 3e-3, "f": 1.0})
    assert run._point(p, {"sample": 7}, Start()) == Point(p, Start(), 7)


def test_extra_values_leave_the_batches_that_there_are() -> None:
    """So does a further block; a value that is there already is not computed twice."""
    axis = {"start": 0, "stop": 4, "count": 3}
    base = {"N": 1, "Omega": 1}
    for finer in (axis | {"extra": [2, 3.3]}, {"blocks": [axis, [2, 3.3]]}):
        before, after = (
            parse_grid({"study": "x", "quantity": "floquet", "base": base, "axes": {"c": given}})
            for given in (axis, finer)
        )
        assert {(3.3,)} == set(after.values["c"]) - set(before.values["c"])
        assert set(before.batches) < set(after.batches)
        (new,) = set(after.batches) - set(before.batches)
        assert json.loads(after.batches[new])["points"] == [[3.3]]


def test_excluded_points_are_there_without_values_and_drawn_as_empty(tmp_path: Path) -> None:
    figure = {"kind": "heat_map", "variable": "period", "x": "mu_s", "y": "mu_k"}
    raw = {"study": "s", "quantity": "floquet", "base": {"N": 200, "Omega": 20, "n_diameters": 1}}
    raw |= {"axes": {name: [0.1, 0.2, 0.3] for name in ("mu_s", "mu_k")}, "where": "mu_k <= mu_s"}
    grid = parse_grid(raw | {"figures": {"f": figure, "g": figure | {"variable": "growth_rate"}}})
    batches = [run_batch(text) for text in grid.batches.values()]
    study = merge_batches(batches, grid.grid, grid.attrs)
    left_out = study["mu_k"] > study["mu_s"]
    status = flag_names(study["status"])
    assert ((status == "excluded") == left_out.transpose(*study["status"].dims)).all()
    assert np.isfinite(study["period"]).equals(~left_out.transpose(*study["period"].dims))
    assert not list(failures(study))
    for name, plot in grid.plots.items():
        render(plot, {"study": xr.DataTree(study)}).savefig(tmp_path / f"{name}.png")


# ---- parts of a grid


def test_a_plane_is_cut_into_stretches_that_share_their_ends() -> None:
    values = [(float(i),) for i in range(18)]
    cuts = parts_of._cuts(values, 8)
    assert [cut.along for cut in cuts] == [tuple(range(9)), tuple(range(8, 18))]
    # the last value of a stretch belongs to the next one
    assert [len(cut.within) for cut in cuts] == [8, 10]
    [whole] = parts_of._cuts(values[:5], 8)
    assert len(whole.within) == 5


@pytest.mark.parametrize(
    ("count", "sizes"), [(4, [4]), (5, [3, 2]), (9, [3, 3, 3]), (13, [4, 4, 4, 1])]
)
def test_up_to_three_parts_of_a_block_are_equal(count: int, sizes: list[int]) -> None:
    block = [(float(i),) for i in range(count)]
    parts = [*parts_of._parts([block], 4)]
    assert [len(part) for part in parts] == sizes
    assert [value for part in parts for (value,) in part] == block


def test_a_value_belongs_to_the_first_block_that_has_it() -> None:
    made = parts_of.Dimension(["c"], [[(2.0,), (0.0,)], [(2.0,), (3.0,)], [(0.0,)]])
    assert made.blocks == [[(0.0,), (2.0,)], [(3.0,)]]
    assert made.values == ((0.0,), (2.0,), (3.0,))


@pytest.mark.parametrize(("value", "place"), [(0.3, 1), (0.1 + 0.2, 1), (0.301, None), (5.0, 2)])
def test_a_mark_has_the_place_of_its_value_to_rounding(value: float, place: int | None) -> None:
    assert parts_of._index_of(value, (0.1, 0.3, 5.0)) == place


CROSSED = {
    "study": "s",
    "quantity": "campbell",
    "base": {"n_diameters": 1},
    "axes": {"N": [200, 300], "Omega": [10, 11, 12]},
}


@pytest.mark.parametrize(
    ("figure", "fault"),
    [
        ({"variable": "n_crossings", "x": "N"}, ""),  # one number over all speeds
        ({"variable": "n_crossings", "x": "Omega"}, "figures.f.x='Omega'"),
        ({"variable": "crossing_frequency", "x": "crossing", "by": "N"}, ""),
        ({"variable": "growth_rate", "x": "Omega", "by": "N"}, ""),
        ({"variable": "growth_rate", "x": "crossing", "by": "N"}, "figures.f.x='crossing'"),
        ({"variable": "cycle_frequency", "x": "mode", "at": {"N": 200, "Omega": 11}}, ""),
    ],
)
def test_figures_of_a_summary_have_its_dimensions(figure: dict[str, Any], fault: str) -> None:
    raw = CROSSED | {"figures": {"f": {"kind": "curve", **figure}}}
    if not fault:
        assert [*parse_grid(raw).plots] == ["f"]
        return
    found = faults_of(parse_study, raw)
    assert any(each.startswith(fault) for each in found), found


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"options": {"parameter": "mu_s"}, "where": "mu_s < 1"}, "mu_s is varied by the quantity"),
        (
            {"options": {"parameter": "mu_k_over_mu_s"}, "where": "mu_k < 1"},
            "mu_k is varied by the quantity",
        ),
        (
            {
                "options": {"parameter": "mu_s"},
                "base": {"mu_k_over_mu_s": 0.5},
                "where": "mu_k < 1",
            },
            "mu_k is varied by the quantity",
        ),
        ({"options": {"parameter": "k"}, "where": "mu_z < 1"}, "mu_z is no value of a point"),
    ],
)
def test_a_rule_may_compare_nothing_that_the_quantity_varies(
    changes: dict[str, Any], words: str
) -> None:
    scan = {"start": 0.3, "stop": 0.5, "count": 2}
    raw = {"study": "s", "quantity": "sliding", "axes": {"c": [0.0, 1.0]}, **changes}
    raw["options"] = {"scan": scan, **changes["options"]}
    raw["base"] = {"N": 200, "Omega": 20, **changes.get("base", {})}
    found = faults_of(parse_study, raw)
    assert any(words in each for each in found), found


def test_a_grid_may_have_the_greatest_number_of_points(monkeypatch: pytest.MonkeyPatch) -> None:
    axes = {"mu_s": [0.3, 0.4], "mu_k": [0.1, 0.2, 0.3]}
    raw = {"study": "s", "quantity": "floquet", "base": {"N": 200, "Omega": 20}, "axes": axes}
    monkeypatch.setattr(parts_of, "MOST_POINTS", 6)
    assert parse_grid(raw).n_points == 6
    monkeypatch.setattr(parts_of, "MOST_POINTS", 5)
    told = faults_of(parse_study, raw)
    assert told == ["axes: must make at most 5 points, and not 6"]


def sizes(**changes: Any) -> list[int]:
    """Numbers of points of the batches of a study."""
    return sorted(map(len, points(parse_grid(study(**changes)))))


def test_a_batch_has_the_points_of_its_quantity_or_of_its_file() -> None:
    axes = {"N": [200], "Omega": {"start": 10, "stop": 20, "count": 161}}
    assert sizes(axes=axes, batch={}) == [53, 54, 54]  # of at most 80 of `outcome`, made equal
    assert sizes(axes=axes, batch={"size": 100}) == [80, 81]
    axes["Omega"] = {"start": 10, "stop": 20, "count": 401}
    assert sizes(axes=axes, batch={"size": 80}) == [1, 80, 80, 80, 80, 80]


SIDES = {
    "N": {"start": 100, "stop": 140, "step": 1},
    "Omega": {"start": 10, "stop": 50, "step": 1},
    "c_p": [0.0, 0.1],
}


@pytest.mark.parametrize(
    ("batch", "count"),
    [
        ({"over": ["N", "Omega"]}, 2),  # of 40 intervals a side, of at most 28
        ({"over": ["N", "Omega"], "size": 400}, 8),
        ({"over": ["N", "Omega", "c_p"], "size": 400}, 9),
    ],
)
def test_a_plane_is_cut_into_tiles_of_about_so_many_points(
    batch: dict[str, Any], count: int
) -> None:
    """Stretches of twenty intervals, two a side, and of thirteen or fourteen, three a side."""
    made = parse_grid(study(quantity="regions", options={"horizon": 1}, axes=SIDES, batch=batch))
    assert len(made.batches) == count
    every = [tuple(point) for batch in points(made) for point in batch]
    assert len(every) == len({*every}) == made.n_points


@pytest.mark.parametrize("name", ["map_N", "map_m", "map_D_star", "map_k"])
def test_tiles_of_the_maps_on_which_inferred_outcomes_depend(name: str) -> None:
    """Cells are refined within a tile, so that other tiles may infer other outcomes."""
    grid = load_study(Path(f"config/studies/{name}.yaml")).grid
    assert grid is not None
    tiles = [json.loads(text)["tile"]["along"] for text in grid.batches.values()]
    expected = {
        "map_N": [(24, 24)] * 8,
        "map_m": [(19, 25)] * 4,
        "map_D_star": [(37, 25)] * 2,
        "map_k": [(37, 34)] * 2,
    }
    assert [tuple(map(len, along)) for along in tiles] == expected[name]
