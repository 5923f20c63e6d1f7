"""Points that xarray's where masks are left out of pictures of sweeps."""

import functools
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch

import disc_model as dm
from disc_model.figures.classes import LOOKS
from tests.figures.reading import as_map
from tests.figures.test_wishes import legend_texts

CASE = dm.Parameters(N=385, Omega=15, n_diameters=2)
SPEEDS = [11, 12, 13, 14]  # rad/s
LEFT_OUT = 1  # the place of 12 rad/s
LOADS = [350, 360, 370]  # N


@functools.cache
def masked() -> xr.Dataset:
    """Cycles at four speeds, but one, and three loads."""
    study = dm.sweep(dm.floquet, CASE, Omega=SPEEDS, N=LOADS)
    outcomes = np.full((4, 3), "separation")
    study["outcome"] = (("Omega", "N"), outcomes, {"long_name": "outcome"})
    return study.where(study["Omega"] != 12)


# ---- Maps


def has_colour(ax: Axes) -> np.ndarray:
    """Whether each cell of a map has a colour, over loads and speeds."""
    cells = ax.collections[0]
    colours = cells.to_rgba(cells.get_array())
    is_white = (colours[..., :3] == 1).all(axis=-1)
    is_seen = colours[..., 3] > 0
    return is_seen & ~is_white


@pytest.mark.parametrize("variable", ["growth_rate", "period", "stable", "status", "outcome"])
def test_masked_points_of_a_map_are_left_out(variable: str) -> None:
    """They were a class of the name "nan", or had failed, and a masked column was unresolved."""
    ax = as_map(masked(), variable)
    said = {*legend_texts(ax)}
    assert "left out" in said
    assert said.isdisjoint({"nan", "failed", "unresolved"})


@pytest.mark.parametrize("variable", ["growth_rate", "period", "stable", "status", "outcome"])
def test_masked_points_of_a_map_have_no_colour(variable: str) -> None:
    ax = as_map(masked(), variable)
    coloured = has_colour(ax)
    assert coloured[:, 0].all()
    assert not coloured[:, LEFT_OUT].any()


@pytest.mark.parametrize("variable", ["growth_rate", "period", "stable", "status"])
def test_masked_points_of_a_map_have_their_own_pattern_alone(variable: str) -> None:
    ax = as_map(masked(), variable)
    areas = [patch for patch in ax.patches if isinstance(patch, PathPatch)]
    assert areas, "cells without a cycle are hatched"
    patterns = [area.get_hatch() for area in areas if area.get_path().contains_point((12, 360))]
    assert patterns == [LOOKS["excluded"].hatch]


# ---- Lines


@pytest.mark.parametrize("variable", ["growth_rate", "period", "stable", "status"])
def test_masked_points_of_lines_are_left_out(variable: str) -> None:
    ax: Any = dm.plot_sweep(masked(), variable, lines="N")
    of_loads = ax.lines[: len(LOADS)]
    for line in of_loads:
        heights = np.asarray(line.get_ydata(), dtype=float)
        assert np.isfinite(heights[0])
        assert np.isnan(heights[LEFT_OUT])
