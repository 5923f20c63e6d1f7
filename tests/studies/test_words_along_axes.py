"""Axes with a word among numbers, such as friction in the middle plane and on the surface."""

import json
from typing import Any

import matplotlib.figure
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.kinds import render
from disc_model.studies.grid import GridStudy
from disc_model.studies.merge import merge_batches
from disc_model.studies.run import run_batch
from tests.studies.refused import faults_of, parse_grid

DISC = {
    "diameters": [1, 2],
    "omega": [3461.0, 7614.0],
    "amplitude": [0.556, 0.543],
    "tangential": [-0.268, -0.129],
    "damping_ratio": [1e-3, 1e-3],
}
PAD = {"disc": DISC, "r_0": 0.1, "k": 1e6, "k_p": 1e6, "m": 0.5, "mu_s": 0.45, "mu_k": 0.35}
HEIGHTS = [0, "6 mm", "surface"]
MAP = {"kind": "heat_map", "variable": "growth_rate", "x": "Omega", "y": "N"}
FIGURES = {"panels": {**MAP, "by": "friction_offset"}, "one": {**MAP, "at": {"friction_offset": 0}}}


def grid_of(**changes: Any) -> GridStudy:
    """A study of cycles over the place of friction, load and speed."""
    axes = {"friction_offset": HEIGHTS, "N": [5000, 8000], "Omega": [60, 80]}
    raw = {"study": "s", "quantity": "floquet", "base": PAD, "axes": axes, "figures": FIGURES}
    return parse_grid(raw | changes)


def computed(grid: GridStudy) -> xr.Dataset:
    """The dataset of a study."""
    batches = [run_batch(text) for text in grid.batches.values()]
    return merge_batches(batches, grid.grid, grid.attrs)


@pytest.fixture(scope="module")
def study() -> xr.Dataset:
    return computed(grid_of())


def drawn(study: xr.Dataset, name: str) -> matplotlib.figure.Figure:
    """A figure of the study."""
    figure = render(grid_of().plots[name], {"study": xr.DataTree(study)})
    pyplot.close("all")
    return figure


def test_a_word_and_numbers_are_values_of_one_axis(study: xr.Dataset) -> None:
    """They were refused: "must be a number along an axis"."""
    assert study.friction_offset.values.tolist() == ["0.0", "0.006", "surface"]
    case = dm.Parameters(N=8000, Omega=80, friction_offset="surface", **PAD)
    at_point = study.sel(friction_offset="surface", N=8000, Omega=80)
    assert float(at_point.growth_rate) == pytest.approx(dm.floquet(case).growth_rate, rel=1e-6)


def test_a_map_has_a_panel_for_each_place_of_friction(study: xr.Dataset) -> None:
    figure = drawn(study, "panels")
    titles = [" ".join(ax.get_title(loc="left").split()) for ax in figure.axes[:3]]
    assert titles == [
        "(a) Friction above the middle plane by z = 0 mm",
        "(b) Friction above the middle plane by z = 6 mm",
        "(c) Friction above the middle plane by z = surface",
    ]


def test_one_value_is_chosen_by_its_number(study: xr.Dataset) -> None:
    mesh = drawn(study, "one").axes[0].collections[0]
    shown = mesh.get_array()
    assert shown is not None
    expected = study.growth_rate.sel(friction_offset="0.0").values.ravel()
    assert shown.filled(float("nan")).ravel() == pytest.approx(expected, nan_ok=True)


def test_a_word_that_is_none_is_refused() -> None:
    axes = {"friction_offset": [0, "top"], "N": [1], "Omega": [1]}
    [fault] = faults_of(grid_of, axes=axes, figures={})
    assert "friction_offset='top'" in str(fault) or "friction_offset=top" in str(fault)


def test_a_study_of_a_table_states_nothing_of_a_plate(study: xr.Dataset) -> None:
    """Its base had E, h, rho, and the normalization of the paper's plate."""
    base = json.loads(study.attrs["base"])
    assert base.keys().isdisjoint(["E", "h", "rho", "a", "D_star", "normalization"])
    assert {"disc", "k", "mu_s", "r_0"} <= base.keys()
