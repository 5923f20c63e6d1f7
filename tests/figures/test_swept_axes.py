"""Axes of pictures of sweeps: their numbers, their limits, and what a map or several parts need."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.data.variables import attributes
from tests.figures.reading import small_axes
from tests.refusals import refusal


def grid(name: str = "height", **axes: Any) -> xr.Dataset:
    """A sweep whose value at each point is its place in the grid."""
    sizes = {dim: len(values) for dim, values in axes.items()}
    values = np.arange(float(np.prod([*sizes.values()]))).reshape([*sizes.values()])
    data = {"status": ((*sizes,), np.full(values.shape, "ok")), name: ((*sizes,), values)}
    coords = {dim: (dim, values, attributes(dim)) for dim, values in axes.items()}
    return xr.Dataset(data, coords)


# ---- Ticks


@pytest.mark.parametrize("axis", ["x", "y"])
def test_a_map_over_mode_counts_has_whole_numbers(axis: str) -> None:
    """They had halves, as sweeps have whole numbers as real ones."""
    study = grid(n_diameters=[1.0, 2, 4], n_circles=[0.0, 1, 2])
    ax = dm.plot_sweep(study, "height", lines=False, ax=small_axes())
    ticks = getattr(ax, f"get_{axis}ticks")()
    assert (ticks == np.round(ticks)).all()


# ---- Maps and parts


def test_what_is_no_map_is_not_drawn_as_lines_where_a_map_is_asked_for() -> None:
    """A line came in its place."""
    with refusal("lines=False: must be left out: a map needs two dimensions of numbers"):
        dm.plot_sweep(grid(Omega=[10.0, 12]), "height", lines=False)


def test_more_dimensions_are_refused() -> None:
    study = grid(Omega=[10.0, 12], mu_k=[0.2, 0.22], N=[300.0, 400])
    with refusal("study='Omega, mu_k, N': must vary along at most two"):
        dm.plot_sweep(study, "height")


def test_a_variable_beside_the_grid_is_refused() -> None:
    """It was an error of xarray."""
    study = grid(Omega=[10.0, 12]).assign(crossing_frequency=("crossing", [1.0, 2.0]))
    study = study.assign_coords(crossing=[1, 2])
    with refusal("variable='crossing_frequency': must be one over the grid"):
        dm.plot_sweep(study, "crossing_frequency")


# ---- Words


def words_up(ax: Axes) -> list[str]:
    """The words along the vertical axis, from below."""
    return [label.get_text() for label in ax.get_yticklabels()]


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (["low", "hi", "low"], ["low", "hi"]),
        (["separation", "growing", "quiet"], ["quiet", "growing, in contact", "separation"]),
        (["yes", "no", "yes"], ["no", "yes"]),
        (["own", "separation", "another"], ["separation", "own", "another"]),
    ],
)
def test_words_stand_in_their_order(given: list[str], expected: list[str]) -> None:
    """They stood in that of the alphabet."""
    study = grid(Omega=[10.0, 12, 14]).assign(level=("Omega", given))
    ax = dm.plot_sweep(study, "level", ax=small_axes())
    assert words_up(ax) == expected
