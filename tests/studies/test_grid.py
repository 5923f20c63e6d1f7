"""Grid studies: what files may say, how grids become batches, and merging them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model.figures.maps import draw as draw_map
from disc_model.studies.faults import StudyError
from disc_model.studies.grid import GridStudy, load_grid, load_grids, parse_grid
from disc_model.studies.grid_batch import run_batch
from disc_model.studies.grid_merge import MergeError, failures, merge_batches

STUDIES = sorted((Path(__file__).parents[2] / "config" / "studies").glob("*.yaml"))


def study(**changes: Any) -> dict[str, Any]:
    """A small study, with some keys changed."""
    raw = {
        "study": "small",
        "quantity": "outcome",
        "options": {"horizon": 2, "late": 0.2, "after_separation": 0.2},
        "axes": {"N": [100, 200, 300], "Omega": {"start": 10, "stop": 20, "count": 3}},
        "batch": {"over": ["Omega"], "size": 2},
    }
    return {**raw, **changes}


def points(grid: GridStudy) -> list[list[list[Any]]]:
    return [json.loads(text)["points"] for text in grid.batches.values()]


def faults(raw: Any) -> list[str]:
    with pytest.raises(StudyError) as error:
        parse_grid(raw)
    return list(error.value.faults)


# ---- expansion


def test_batches_are_fixed_axes_times_chunks_of_blocks() -> None:
    grid = parse_grid(study())
    assert points(grid) == [
        [[100.0, 10.0], [100.0, 15.0]], [[100.0, 20.0]],
        [[200.0, 10.0], [200.0, 15.0]], [[200.0, 20.0]],
        [[300.0, 10.0], [300.0, 15.0]], [[300.0, 20.0]],
    ]  # fmt: skip
    assert grid.n_points == 9
    assert all(len(name) == 12 for name in grid.batches)


@pytest.mark.parametrize(
    ("given", "values"),
    [
        ([0.3, "1e-1", 0.2, 0.20], [0.1, 0.2, 0.3]),
        ({"start": 0, "stop": 0.3, "step": 0.1}, [0.0, 0.1, 0.2, 0.3]),
        ({"start": 0.1, "stop": 10, "count": 3, "scale": "log"}, [0.1, 1.0, 10.0]),
        ({"blocks": [[1, 2], {"start": 1, "stop": 3, "count": 5}]}, [1.0, 1.5, 2.0, 2.5, 3.0]),
    ],
)
def test_values_of_an_axis(given: Any, values: list[float]) -> None:
    grid = parse_grid(study(axes={"N": [100], "Omega": [10], "c": given}))
    assert [value for (value,) in grid.dims[-1].values] == values


def test_zipped_pairs_are_one_dimension() -> None:
    grid = parse_grid(study(axes={"D_star": [0, 1e-5]}, zip={"Omega": [20, 10, 20], "N": [200, 385, 200]}, batch={}))
    assert [dim.name for dim in grid.dims] == ["N_Omega", "D_star"]
    assert grid.dims[0].values == ((200.0, 20.0), (385.0, 10.0))
    assert points(grid) == [[[200.0, 20.0, 0.0], [200.0, 20.0, 1e-5]], [[385.0, 10.0, 0.0], [385.0, 10.0, 1e-5]]]


def test_all_kinds_of_parameters_can_vary() -> None:
    grid = parse_grid(
        study(axes={"N": [1], "Omega": [1], "n_diameters": ["4", 3.0], "contact": ["bonded"]}, batch={"over": ["N"]})
    )
    assert points(grid) == [[[1.0, 1.0, 3, "bonded"]], [[1.0, 1.0, 4, "bonded"]]]


def test_spelling_and_order_do_not_matter() -> None:
    axes = {"Omega": ["20.0", 1.5e1, 10], "N": [300, 100, 200.0, 100]}
    other = parse_grid(study(axes=axes, title="called otherwise"))
    assert other.batches == parse_grid(study()).batches
    assert other.key == parse_grid(study()).key


def test_minus_zero_is_zero() -> None:
    one, other = (parse_grid(study(axes={"N": [1], "Omega": [zero]})) for zero in (0.0, -0.0))
    assert one.batches == other.batches


def test_changes_change_only_the_batches_they_touch() -> None:
    before = set(parse_grid(study()).batches)
    axes = study()["axes"]
    assert len(set(parse_grid(study(axes={**axes, "N": [100, 150, 200, 300]})).batches) - before) == 2
    assert set(parse_grid(study(axes={**axes, "N": [100, 300]})).batches) < before
    assert not before & set(parse_grid(study(base={"mu_k": 0.23})).batches)
    assert not before & set(parse_grid(study(options={"horizon": 3})).batches)
    longer = {"blocks": [axes["Omega"], [12.5]]}
    assert len(set(parse_grid(study(axes={**axes, "Omega": longer})).batches) - before) == 3


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_finer_resolution_keeps_all_batches(scale: str) -> None:
    axes = {"N": [100], "Omega": {"start": 10, "stop": 20, "count": 4, "scale": scale}}
    coarse, fine, finest = (parse_grid(study(axes=axes), resolution) for resolution in (1, 2, "4"))
    assert [grid.n_points for grid in (coarse, fine, finest)] == [4, 7, 13]
    assert coarse.batches.keys() < fine.batches.keys() < finest.batches.keys()


def test_the_key_tells_grids_apart_and_covers_the_sources() -> None:
    keys = {parse_grid(study(axes={"N": [n], "Omega": [10]})).key for n in (100, 200)}
    assert len(keys) == 2
    assert all("sources" in json.loads(text) for text in parse_grid(study()).batches.values())


# ---- faults


def test_every_fault_is_reported_with_its_path() -> None:
    raw = study(
        options={"horizon": 0, "late": 0.2, "speed": 1},
        base={"m": -1, "Omega": "fast", "mu": 0.3},
        axes={
            "N": [-5, 10],
            "E": {"start": 2, "stop": 1, "count": 5},
            "rho": [1],
            "k": [],
            "c": {"start": 0, "stop": 1},
        },
        zip={"D_star": [0, 1e-5], "c_p": [0]},
        batch={"size": 0},
        figures={"map": {"kind": "chart"}},
        colour="red",
    )
    found = "\n".join(faults(raw))
    for fault in (
        "colour = 'red': unknown key",
        "batch.size = 0: must be >= 1",
        "options.horizon = 0: must be > 0",
        "options.speed = 1: unknown key",
        "base.m = -1.0: must be > 0",
        "base.Omega = 'fast': must be a number",
        "base.mu = 0.3: unknown parameter",
        "axes.N = -5.0: must be >= 0",
        "axes.E: start=2 must be < stop=1",
        "axes.rho: cannot be an axis",
        "axes.k = []: must be a list of values, or a range",
        "axes.c: must give either count or step",
        "zip: must have columns of equal length, not D_star: 2, c_p: 1",
        "figures.map.kind = 'chart': unknown kind of figure",
    ):
        assert fault in found


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        (
            {"quantity": "noise"},
            "quantity = 'noise': unknown quantity (known: outcome, critical_speed, floquet, hysteresis, ",
        ),
        ({"axes": {"N": [1]}}, "axes.Omega: is required, here, in a zip or in base"),
        ({"axes": {"N": [1], "Omega": [1]}, "zip": {"N": [2], "c": [0]}}, "axes.N: varies along two dimensions"),
        ({"batch": {"over": ["c"]}}, "batch.over = 'c': must name dimensions (known: N, Omega)"),
        ({"quantity": "critical_speed"}, "axes.Omega: is varied by the quantity critical_speed"),
        (
            {"figures": {"f": {"kind": "stability_map", "x": "N", "y": "E"}}},
            "figures.f = 'E': is no dimension of this study",
        ),
        (
            {"axes": {"N": [1], "Omega": {"start": 0, "stop": 1, "step": 0.3}}},
            "axes.Omega: stop - start must be a multiple",
        ),
    ],
)
def test_rules_between_parts(changes: dict[str, Any], fault: str) -> None:
    assert fault in "\n".join(faults(study(**changes)))


def test_a_bad_axis_is_the_only_fault_of_a_figure_over_it() -> None:
    figure = {"f": {"kind": "stability_map", "x": "N", "y": "Omega"}}
    assert faults(study(axes={"N": [-1], "Omega": [1]}, figures=figure)) == ["axes.N = -1.0: must be >= 0"]
    uneven = study(axes={"Omega": [1]}, zip={"N": [1, 2], "c": [0]}, batch={}, figures=figure)
    assert faults(uneven) == ["zip: must have columns of equal length, not N: 2, c: 1"]


@pytest.mark.parametrize("raw", [None, [], "text", {"study": "x"}, {"axes": 3, "quantity": []}])
def test_nonsense_is_refused_without_another_error(raw: Any) -> None:
    assert faults(raw)


def test_faults_of_several_studies_are_reported_together(tmp_path: Path) -> None:
    (tmp_path / "one.yaml").write_text("study: one\nquantity: outcome\n")
    (tmp_path / "two.yaml").write_text("study: other\nquantity: floquet\naxes: {N: [1], Omega: [1], N: [2]}\n")
    with pytest.raises(StudyError) as error:
        load_grids([tmp_path / "one.yaml", tmp_path / "two.yaml"], {"three": {}})
    found = str(error.value)
    assert "one.yaml: axes.Omega: is required" in found
    assert "two.yaml: N: given twice, in lines 3 and 3" in found
    assert "overrides.three: no such study (known: one, two)" in found


def test_overrides_are_laid_over_the_file(tmp_path: Path) -> None:
    file = tmp_path / "small.yaml"
    file.write_text(json.dumps(study()))
    grid = load_grid(file, {"axes": {"N": [50]}, "options": {"horizon": 7}})
    assert grid.n_points == 3
    assert grid.options.horizon == 7  # type: ignore[attr-defined]


def test_the_studies_of_the_repository_are_right() -> None:
    every = load_grids(STUDIES)
    after = ("bifurcation", "lyapunov")
    grids = {name: grid for name, grid in every.items() if grid.quantity not in after}
    pairs = {frozenset(dim.name for dim in grid.dims) - {"normalization"} for grid in grids.values() if grid.plots}
    wanted = ["N", "D_star", "c", "k", "k_p", "E", "m"]
    assert {frozenset(("Omega", name)) for name in wanted} | {frozenset(("N", "c_p")), frozenset(("N",))} == pairs
    for grid in grids.values():
        assert any("normalization" in dim.names for dim in grid.dims)


# ---- batches and merging


@pytest.fixture(scope="module")
def batches() -> list[xr.Dataset]:
    return [run_batch(text) for text in parse_grid(study()).batches.values()]


def test_merged_study_has_every_point_with_units(batches: list[xr.Dataset], tmp_path: Path) -> None:
    grid = parse_grid(study())
    merged = merge_batches(batches[::-1], grid.grid, {"title": "small"})
    merged.to_netcdf(tmp_path / "small.nc")
    with xr.open_dataset(tmp_path / "small.nc") as read:
        assert dict(read["status"].sizes) == {"N": 3, "Omega": 3}
        assert (read["status"] == 0).all()
        assert read["Omega"].attrs["units"] == "rad s-1"
        assert read["P_max"].attrs["units"] == "N"
        assert (read["P_max"].diff("N") > 0).all()
        assert json.loads(read.attrs["base"])["normalization"] == "as_published"
    assert list(failures(merged)) == []


def test_zips_and_two_normalizations_keep_their_order() -> None:
    axes = {"normalization": ["orthonormal", "as_published"]}
    zipped = {"N": [300, 100], "Omega": [20, 10]}
    grid = parse_grid(study(quantity="floquet", options={}, axes=axes, zip=zipped, batch={}))
    merged = merge_batches([run_batch(text) for text in grid.batches.values()], grid.grid, {})
    assert dict(merged["growth_rate"].sizes) == {"N_Omega": 2, "normalization": 2}
    assert merged["N"].dims == ("N_Omega",)
    alone = parse_grid(
        study(quantity="floquet", options={}, base={"normalization": "orthonormal"}, axes={"N": [300], "Omega": [20]})
    )
    single = run_batch(next(iter(alone.batches.values())))
    assert merged["growth_rate"].sel(normalization="orthonormal").values[1] == single["growth_rate"].values[0]


def test_merge_refuses_what_is_not_the_grid(batches: list[xr.Dataset]) -> None:
    grid = parse_grid(study())
    with pytest.raises(MergeError, match="missing"):
        merge_batches(batches[1:], grid.grid, {})
    with pytest.raises(MergeError, match="there twice"):
        merge_batches([*batches, batches[0]], grid.grid, {})
    fewer = parse_grid(study(axes={"N": [100, 200], "Omega": {"start": 10, "stop": 20, "count": 3}}))
    with pytest.raises(MergeError, match="do not belong"):
        merge_batches(batches, fewer.grid, {})


def test_a_point_that_fails_has_a_status_and_a_line() -> None:
    # in the last case rigid friction on the sloping disc has no solution
    raw = study(
        axes={"N": [300, 1e6], "Omega": [20]},
        base={"k_p": 2e6, "mu_s": 3.0, "mu_k": 2.9, "E": 1e9},
        batch={"over": ["N"]},
    )
    grid = parse_grid(raw)
    merged = merge_batches([run_batch(text) for text in grid.batches.values()], grid.grid, {})
    lines = list(failures(merged))
    bad = merged["status"].values != 0
    assert bad.any()
    assert len(lines) == bad.sum()
    assert lines[-1].startswith("N = 1000000.0, Omega = 20.0: ")
    assert np.isnan(merged["P_max"].values[bad]).all()


def test_maps_draw_failed_points_and_need_no_growth_rates(batches: list[xr.Dataset]) -> None:
    figures = {"m": {"kind": "stability_map", "x": "Omega", "y": "N"}}
    grid = parse_grid(study(figures=figures))
    merged = merge_batches(batches, grid.grid, {}).assign_coords(normalization="as_published")
    merged["outcome"].values[0, 0] = 0
    figure = draw_map(merged, {}, grid.plots["m"])
    assert figure.axes[0].get_xlabel() == "Speed Ω (rad/s)"
    assert figure.axes[0].get_ylabel() == "Preload N (N)"
