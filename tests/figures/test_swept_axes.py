"""Axes of pictures of sweeps: their numbers, their limits, and what a map or several parts need."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.data.variables import attributes
from disc_model.figures.drawing import PlainDecades
from tests.figures.reading import labels, small_axes
from tests.refusals import refusal

CASE = dm.Parameters(N=385, Omega=14)


def grid(name: str = "height", **axes: Any) -> xr.Dataset:
    """A sweep whose value at each point is its place in the grid."""
    sizes = {dim: len(values) for dim, values in axes.items()}
    values = np.arange(float(np.prod([*sizes.values()]))).reshape([*sizes.values()])
    data = {"status": ((*sizes,), np.full(values.shape, "ok")), name: ((*sizes,), values)}
    coords = {dim: (dim, values, attributes(dim)) for dim, values in axes.items()}
    return xr.Dataset(data, coords)


# ---- Ticks


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        (13.6, 39.6, [15, 20, 25, 30, 35]),
        (30, 190, [50, 100, 150]),
        (10, 40, [10, 20, 30, 40]),
        (8, 110, [10, 20, 50, 100]),
    ],
)
def test_a_logarithmic_axis_of_less_than_a_decade_has_three_numbers(
    low: float, high: float, expected: list[float]
) -> None:
    """It had one."""
    assert PlainDecades().tick_values(low, high).tolist() == expected


def test_a_logarithmic_axis_of_counts_has_whole_numbers() -> None:
    assert PlainDecades(least=1).tick_values(0.4, 1.9).tolist() == [1]


@pytest.mark.parametrize("axis", ["x", "y"])
def test_a_map_over_mode_counts_has_whole_numbers(axis: str) -> None:
    """They had halves, as sweeps have whole numbers as real ones."""
    study = grid(n_diameters=[1.0, 2, 4], n_circles=[0.0, 1, 2])
    ax = dm.plot_sweep(study, "height", lines=False, ax=small_axes())
    ticks = getattr(ax, f"get_{axis}ticks")()
    assert (ticks == np.round(ticks)).all()


def test_lines_over_mode_counts_have_whole_numbers() -> None:
    ax = dm.plot_sweep(grid(n_circles=[0.0, 1, 2]), "height", ax=small_axes())
    ticks = ax.get_xticks()
    assert (ticks == np.round(ticks)).all()


# ---- Limits


OUTSIDE = "outside the limits:\n"


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        ((-1, 2.5), ["Preload N = 300 N", f"{OUTSIDE}400 N"]),
        ((10, 20), [f"{OUTSIDE}Preload N = 300 N,\n400 N"]),
        ((-1, 9), ["Preload N = 300 N", "400 N"]),
    ],
)
def test_a_legend_says_which_lines_are_outside_the_limits(
    limits: tuple[float, float], said: list[str]
) -> None:
    """It named lines that were not there, and an empty panel said nothing."""
    study = grid(N=[300.0, 400], Omega=[10.0, 12, 14])
    ax = dm.plot_sweep(study, "height", x="Omega", limits=limits, ax=small_axes())
    assert labels(ax) == said


def test_a_new_figure_says_that_all_values_are_outside() -> None:
    """Its panel was empty."""
    ax = dm.plot_sweep(grid(Omega=[10.0, 12]), "height", limits=(5, 6))
    assert labels(ax.figure) == [f"{OUTSIDE}all values"]


def test_several_sweeps_are_said_to_be_outside_once() -> None:
    """What was said of the first stays true of both."""
    ax = small_axes()
    for load in (300.0, 400.0):
        study = grid(Omega=[10.0, 12]).assign_coords(N=load)
        dm.plot_sweep(study, "height", limits=(5, 6), ax=ax)
    assert labels(ax) == [f"{OUTSIDE}N = 300 N, N = 400 N"]


# ---- Maps and parts


def test_what_is_no_map_is_not_drawn_as_lines_where_a_map_is_asked_for() -> None:
    """A line came in its place."""
    with refusal("lines=False: must be left out: a map needs two dimensions of numbers"):
        dm.plot_sweep(grid(Omega=[10.0, 12]), "height", lines=False)


def section() -> xr.Dataset:
    """Samples of a section over two parameters."""
    study = grid(Omega=[10.0, 12], mu_k=[0.2, 0.22, 0.24])
    angles = 0.04 + 0.001 * np.arange(18.0).reshape(2, 3, 3)
    return study.assign(psi=(("Omega", "mu_k", "sample"), angles, attributes("psi")))


@pytest.mark.parametrize("lines", ["", "Omega"])
def test_samples_over_two_parameters_are_parts_beside_each_other(lines: str) -> None:
    """They were refused, though two pictures on the same axes showed them."""
    ax = dm.plot_sweep(section(), "psi", x="mu_k", lines=lines, ax=small_axes())
    assert labels(ax) == ["Ω = 10 rad/s", "Ω = 12 rad/s"]


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


def test_words_of_a_further_sweep_stand_above_those_before() -> None:
    ax = small_axes()
    for words in (["low", "hi"], ["hi", "at the top"]):
        study = grid(Omega=[10.0, 12]).assign(level=("Omega", words))
        dm.plot_sweep(study, "level", ax=ax)
    assert words_up(ax) == ["low", "hi", "at the top"]
