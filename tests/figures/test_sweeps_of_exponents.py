"""Sweeps of Lyapunov exponents show how well these are known."""

from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

import disc_model as dm
from disc_model import plot_sweep
from tests.figures.reading import as_map, labels

CASE = dm.Parameters(N=385, Omega=14)
SPEEDS = [12.0, 14.0, 15.0]  # rad/s
LARGEST = [-0.03, 0.01, 0.2]  # 1/s
SECOND = [-0.07, -0.1, -0.1]  # 1/s
ERRORS_OF_LARGEST = [0.2, 0.02, 0.01]  # 1/s
ERRORS_OF_SECOND = [0.1, 0.03, 0.04]  # 1/s

EXPONENTS = np.column_stack([LARGEST, SECOND])
ERRORS = np.column_stack([ERRORS_OF_LARGEST, ERRORS_OF_SECOND])
CONVERGED = np.array(
    [
        [False, False],  # at 12 rad/s
        [True, False],
        [True, True],
    ]
)
OF_EXPONENTS = {"units": "s-1", "long_name": "Lyapunov exponent"}


def swept() -> xr.Dataset:
    """What a sweep of `lyapunov_exponents` returns."""
    return xr.Dataset(
        {
            "status": ("Omega", ["ok"] * 3),
            "exponents": (("Omega", "exponents_index"), EXPONENTS, OF_EXPONENTS),
            "errors": (("Omega", "errors_index"), ERRORS),
            "converged": (("Omega", "converged_index"), CONVERGED),
        },
        {"Omega": SPEEDS},
        {"function": "lyapunov_exponents", "base": CASE.canonical_json},
    )


def studied() -> xr.Dataset:
    """What a study of `lyapunov` returns."""
    axes = ("Omega", "exponent_number")
    of_numbers = {"long_name": "number of the exponent, largest first"}
    codes = np.array([0, 1, 2], dtype=np.int8)
    flags = {"flag_values": codes, "flag_meanings": "none no yes"}
    no_or_yes = 1 + CONVERGED.astype(np.int8)
    return xr.Dataset(
        {
            "status": ("Omega", ["ok"] * 3),
            "exponent": (axes, EXPONENTS, OF_EXPONENTS),
            "exponent_error": (axes, ERRORS),
            "converged": (axes, no_or_yes, flags),
        },
        {"Omega": SPEEDS, "exponent_number": ("exponent_number", [0, 1], of_numbers)},
        {"quantity": "lyapunov", "base": CASE.canonical_json},
    )


def bars_on(ax: Axes) -> list[tuple[float, float]]:
    """The lower and upper end of each bar of an error."""
    ends = []
    for drawn in ax.collections:
        for path in drawn.get_segments():
            heights = path[:, 1]
            ends.append((heights[0], heights[1]))
    return ends


def filled_on(ax: Axes) -> list[float]:
    """The places of filled marks."""
    places: list[float] = []
    for line in ax.lines:
        is_filled = line.get_markerfacecolor() != "none"
        if is_filled and line.get_marker() == "o":
            places += line.get_xdata().tolist()
    return places


@pytest.mark.parametrize("made", [swept, studied])
def test_largest_exponents_have_their_errors_and_marks_of_those_not_converged(
    made: Callable[[], xr.Dataset],
) -> None:
    """They were a line as if all were known, or the status of each point."""
    ax = plot_sweep(made())
    low, high = np.transpose(bars_on(ax))
    np.testing.assert_allclose(low, np.subtract(LARGEST, ERRORS_OF_LARGEST))
    np.testing.assert_allclose(high, np.add(LARGEST, ERRORS_OF_LARGEST))
    assert ax.get_ylabel() == "Largest Lyapunov exponent (1/s)"
    assert filled_on(ax) == [12.0]
    assert labels(ax.figure) == ["± standard error", "filled: not converged"]


def test_an_exponent_that_is_selected_is_drawn() -> None:
    """It was the status of each point."""
    second = studied().isel(exponent_number=1)
    ax = plot_sweep(second)
    assert ax.get_ylabel() == "Lyapunov exponent (1/s)"
    assert filled_on(ax) == [12.0, 14.0]


@pytest.mark.parametrize(("made", "name"), [(swept, "exponents"), (studied, "exponent")])
def test_all_exponents_have_their_errors_too(made: Callable[[], xr.Dataset], name: str) -> None:
    ax = plot_sweep(made(), name)
    dots, rings = (line for line in ax.lines if line.get_marker() in (".", "o"))
    bars = bars_on(ax)
    assert len(bars) == EXPONENTS.size
    assert dots.get_xdata().tolist() == [14, 15, 15]
    assert rings.get_xdata().tolist() == [12, 12, 14]


def test_a_map_hatches_exponents_that_have_not_converged() -> None:
    at_one_load = swept()
    loads = xr.DataArray([300.0, 400.0, 500.0, 600.0], dims="N", name="N")
    plane = xr.concat([at_one_load] * 4, loads)
    ax = as_map(plane)
    assert labels(ax.figure) == ["not converged"]
