"""Figures of a grid of one point: a map of one cell, a curve of one point."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

import disc_model as dm
from disc_model.figures.render import render
from disc_model.studies.merge import merge_batches
from disc_model.studies.run import run_batch
from tests.studies.refused import parse_grid

FIGURES = {
    "map": {"kind": "heat_map", "variable": "growth_rate", "x": "Omega", "y": "N"},
    "curve": {"kind": "curve", "variable": "growth_rate", "x": "Omega"},
}
GRID = {
    "study": "s",
    "quantity": "floquet",
    "axes": {"N": ["0.3 kN"], "Omega": [10]},
    "figures": FIGURES,
}


@pytest.fixture(scope="module")
def study() -> xr.Dataset:
    grid = parse_grid(GRID)
    batches = [run_batch(text) for text in grid.batches.values()]
    return merge_batches(batches, grid.grid, grid.attrs)


@pytest.fixture(scope="module")
def sweep() -> xr.Dataset:
    return dm.sweep(dm.floquet, dm.Parameters(N=300, Omega=10), N=[300.0], Omega=[10.0])


def panel_of(study: xr.Dataset, name: str) -> Any:
    """The panel of a figure of the study."""
    plot = parse_grid(GRID).plots[name]
    figure = render(plot, {"study": xr.DataTree(study)})
    return figure.axes[0]


def is_a_cell(ax: Any) -> bool:
    """Whether a panel has one cell around its only ticks."""
    [mesh] = ax.collections[:1]
    x, y = ax.get_xticks(), ax.get_yticks()
    return bool(mesh.get_array().size == 1 and len(x) == len(y) == 1)


def has_a_point(ax: Any, value: float) -> bool:
    """Whether a line of a panel is one point at a value across."""
    ends = [line.get_xdata() for line in ax.lines if line.get_marker() not in ("", "None")]
    return any(np.array_equal(np.asarray(x, float), [value]) for x in ends)


def test_a_study_of_one_point_is_drawn(study: xr.Dataset) -> None:
    """Its file was refused with a fault for each axis: "must have two values or more"."""
    ax = panel_of(study, "map")
    assert is_a_cell(ax)
    assert ax.get_xticks().tolist() == [10]
    assert has_a_point(panel_of(study, "curve"), 10)


def test_a_sweep_of_one_point_is_drawn(sweep: xr.Dataset) -> None:
    """It was refused: "study='a single point'"."""
    assert has_a_point(dm.plot_sweep(sweep, "growth_rate", x="Omega"), 10)
    assert has_a_point(dm.plot_sweep(sweep.isel(N=0), "growth_rate"), 10)
    assert is_a_cell(dm.plot_sweep(sweep, "growth_rate", lines=False))
