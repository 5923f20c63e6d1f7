"""Stability in the workflow: neutral curves and folds, bifurcation diagrams and Lyapunov exponents as quantities."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.grids import bifurcation as attractors
from disc_model.figures.grids import thresholds
from disc_model.figures.grids.kinds import Bifurcation, GrowthMap, Thresholds
from disc_model.figures.style import save
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.studies.faults import StudyError
from disc_model.studies.grids.merge import merge_batches
from disc_model.studies.grids.quantities.schema import BifurcationOptions
from disc_model.studies.grids.run import run_batch
from disc_model.studies.grids.schema import GridStudy, parse_grid

CURVES = {
    "study": "curves",
    "quantity": "stability_curves",
    "options": {"x_range": [12, 18], "y_lines": {"start": 385, "stop": 400, "count": 2}, "points": 7, "max_points": 12},
    "axes": {"normalization": ["as_published"]},
}


def computed(raw: dict) -> xr.Dataset:
    study: GridStudy = parse_grid(raw)
    return merge_batches([run_batch(text) for text in study.batches.values()], study.grid, {})


@pytest.fixture(scope="module")
def curves() -> xr.Dataset:
    return computed(CURVES)


def test_the_fold_of_the_paper_is_found_once_and_named(curves: xr.Dataset) -> None:
    one = curves.isel(normalization=0)
    assert flag_names(one["status"]) == "ok"
    folds = np.flatnonzero(flag_names(one["kind"]) == "fold")
    at = [
        np.interp(385.0, *np.sort(one[["y", "x"]].isel(curve=i).dropna("curve_point").to_array().values)) for i in folds
    ]
    near = [i for i, speed in zip(folds, at, strict=True) if abs(speed - 15.0949) < 5e-3]
    assert len(near) == 1
    drawn = [curve for curve in thresholds.curves_of(one) if curve.kind == "fold"]
    assert "2 f_s = 135.42 Hz" in [curve.label for curve in drawn]


def test_other_parameters_may_span_the_plane() -> None:
    options = {"x": "N", "y": "c_p", "x_range": [50, 120], "y_lines": {"start": 0.01, "stop": 0.02, "count": 2}}
    raw = CURVES | {"options": options | {"points": 4, "max_points": 4}, "base": {"Omega": 20}}
    one = computed(raw).isel(normalization=0)
    assert int(one["n_curves"]) >= 1
    assert np.nanmin(one["x"]) > 40


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"base": {"Omega": 15}}, "Omega: is varied by the quantity stability_curves"),
        ({"options": CURVES["options"] | {"y": "Omega"}}, "x and y must differ"),
        ({"options": CURVES["options"] | {"y": "k"}}, "N.*is required"),
    ],
    ids=["base", "twice", "missing"],
)
def test_bad_planes_are_refused(change: dict, fault: str) -> None:
    with pytest.raises(StudyError, match=fault):
        parse_grid(CURVES | change)


AFTER = {"prepare": {"parameters": {"N": 385, "Omega": 15.1}, "time": 56}, "transient": 1}


def test_motions_may_start_after_a_separation() -> None:
    raw = {"study": "b", "quantity": "bifurcation", "base": {"N": 385}, "axes": {"Omega": [5, 15]}}
    before = computed(raw | {"options": {"transient": 1, "samples": 3}})
    after = computed(raw | {"options": AFTER | {"samples": 3}})
    assert before["separations"].values.tolist() == [0, 0]
    assert after["separations"].sel(Omega=15) > 50
    assert flag_names(before["phase"]).tolist() != [["none"] * 3] * 2
    start = simulate(Parameters(N=385, Omega=15.1), 56).final_state.replace(time=0.0, time_low=0.0)
    run = simulate(Parameters(N=385, Omega=15), 1.0, initial_state=start)
    assert after["first_separation"].sel(Omega=15) == run.first_separation


def test_exponents_are_stored_with_their_errors() -> None:
    raw = {"study": "l", "quantity": "lyapunov", "base": {"N": 385}, "axes": {"Omega": [15]}}
    found = computed(raw | {"options": AFTER | {"duration": 2, "exponents": 3}}).isel(Omega=0)
    assert found["exponent"].shape == (3,)
    assert np.all(np.isfinite(found["exponent"]))
    assert np.all(found["exponent_error"] > 0)
    assert float(found["covered"]) == pytest.approx(2)
    assert json.loads(found.attrs["options"])["prepare"]["time"] == 56


@pytest.mark.parametrize(
    ("parameters", "fault"),
    [
        ({"Omgea": 15}, "Omgea=15: unknown parameter, did you mean Omega?"),
        ({"m": -1, "contact": "open"}, "m=-1.0: must be > 0; contact='open': must be 'separable' or 'bonded'"),
        ({"mu_s": 0.2, "mu_k": 0.3}, "mu_k=0.3: must be <= mu_s=0.2"),
        ({"n_diameters": "auto"}, "n_diameters='auto': must be a whole number, that of the points"),
    ],
)
@pytest.mark.parametrize(("quantity", "more"), [("bifurcation", {}), ("lyapunov", {"duration": 1})])
def test_a_preparation_is_checked_before_anything_runs(quantity: str, more: dict, parameters: dict, fault: str) -> None:
    given = {"prepare": {"parameters": parameters, "time": 1}, "transient": 1} | more
    raw = {"study": "b", "quantity": quantity, "axes": {"N": [1], "Omega": [15]}}
    with pytest.raises(StudyError) as error:
        parse_grid(raw | {"options": given})
    assert error.value.faults == (f"options.prepare.parameters: {fault}",)


def test_any_parameter_may_be_prepared_however_it_is_spelled() -> None:
    def read(**parameters: object) -> dict:
        raw = {"prepare": {"parameters": parameters, "time": 1}, "transient": 1}
        return BifurcationOptions.model_validate(raw).model_dump()["prepare"]["parameters"]

    assert read() == {}
    found = read(normalization="orthonormal", N="3e2", n_diameters=4.0, mu_k=0.5, contact="bonded")
    # mu_k may be right: the point has its own mu_s
    assert found == {"normalization": "orthonormal", "N": 300.0, "n_diameters": 4, "mu_k": 0.5, "contact": "bonded"}
    assert isinstance(found["n_diameters"], int)


def test_a_preparation_that_fails_is_reported() -> None:
    options = {"prepare": {"parameters": {"mu_k": 0.9}, "time": 1}, "transient": 1}
    raw = {"study": "b", "quantity": "bifurcation", "base": {"N": 385}, "axes": {"Omega": [15]}, "options": options}
    found = computed(raw).isel(Omega=0)
    assert flag_names(found["status"]) == "failed"
    assert "ParameterError" in str(found["message"].item())


def test_figures_show_them(curves: xr.Dataset, tmp_path) -> None:
    norm = {"normalization": ["as_published"]}
    axes = {"N": [380.0, 390.0, 400.0], "Omega": np.linspace(12, 18, 7)}
    growth = xr.Dataset({"growth_rate": (("N", "Omega", "normalization"), np.ones((3, 7, 1)))}, axes | norm)
    speeds = xr.DataArray(np.full((3, 1, 1), 15.2), dims=("N", "normalization", "horizon"))
    status = xr.DataArray(np.zeros((3, 1), np.int8), dims=("N", "normalization"), attrs={"flag_meanings": "ok failed"})
    study = xr.Dataset(
        {"critical_speed": speeds, "status": status},
        {"N": axes["N"], "horizon": [500.0], "scan_Omega": [12.0, 16.0], **norm},
    )
    save(thresholds.draw(growth, {"curves": curves}, GrowthMap()), tmp_path / "growth.png")
    chart = thresholds.draw(study, {"curves": curves, "cycle": growth}, Thresholds(claim={"a": (385, 15.1)}))
    save(chart, tmp_path / "chart.png")
    raw = {"study": "b", "base": {"N": 385}, "axes": {"Omega": [14, 15]}}
    samples = computed(raw | {"quantity": "bifurcation", "options": {"transient": 0.5, "samples": 3}})
    exponents = computed(raw | {"quantity": "lyapunov", "options": {"transient": 0.1, "duration": 0.2}})
    save(attractors.draw(samples, {"lyapunov": exponents}, Bifurcation(x="Omega")), tmp_path / "diagram.png")
    assert all((tmp_path / f"{name}.png").stat().st_size > 5000 for name in ("growth", "chart", "diagram"))
