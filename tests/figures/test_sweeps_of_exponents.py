"""Sweeps of Lyapunov exponents show how well these are known."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes

import disc_model as dm
from tests.figures.reading import labels

CASE = dm.Parameters(N=385, Omega=14)
SPEEDS = [12.0, 14.0, 15.0]  # rad/s
EXPONENTS = np.array([[-0.03, -0.07], [0.01, -0.1], [0.2, -0.1]])  # 1/s
ERRORS = np.array([[0.2, 0.1], [0.02, 0.03], [0.01, 0.04]])  # 1/s
CONVERGED = np.array([[False, False], [True, False], [True, True]])
LARGEST = "Largest Lyapunov exponent (1/s)"


@pytest.fixture(autouse=True)
def _closed() -> object:
    yield
    pyplot.close("all")


def swept() -> xr.Dataset:
    """What a sweep of `lyapunov_exponents` returns."""
    rate = {"units": "s-1", "long_name": "Lyapunov exponent"}
    return xr.Dataset(
        {
            "status": ("Omega", ["ok"] * 3),
            "exponents": (("Omega", "exponents_index"), EXPONENTS, rate),
            "errors": (("Omega", "errors_index"), ERRORS),
            "converged": (("Omega", "converged_index"), CONVERGED),
        },
        {"Omega": SPEEDS},
        {"function": "lyapunov_exponents", "base": CASE.canonical_json},
    )


def studied() -> xr.Dataset:
    """What a study of `lyapunov` returns."""
    flags = {"flag_values": np.array([0, 1, 2], dtype=np.int8), "flag_meanings": "none no yes"}
    names = ("Omega", "exponent_number")
    number = {"long_name": "number of the exponent, largest first"}
    return xr.Dataset(
        {
            "status": ("Omega", ["ok"] * 3),
            "exponent": (names, EXPONENTS, {"units": "s-1", "long_name": "Lyapunov exponent"}),
            "exponent_error": (names, ERRORS),
            "converged": (names, (1 + CONVERGED).astype(np.int8), flags),
        },
        {"Omega": SPEEDS, "exponent_number": ("exponent_number", [0, 1], number)},
        {"quantity": "lyapunov", "base": CASE.canonical_json},
    )


def bars_on(ax: Axes) -> list[tuple[float, float]]:
    """The lower and upper end of each bar of an error."""
    uprights = [path for drawn in ax.collections for path in drawn.get_segments()]
    return [(path[0, 1], path[1, 1]) for path in uprights]


def filled_on(ax: Axes) -> list[float]:
    """The places of filled marks."""
    filled = [line for line in ax.lines if line.get_markerfacecolor() != "none"]
    return [float(x) for line in filled if line.get_marker() == "o" for x in line.get_xdata()]


@pytest.mark.parametrize("study", [swept(), studied()])
def test_largest_exponents_have_their_errors_and_marks_of_those_not_converged(
    study: xr.Dataset,
) -> None:
    """They were a line as if all were known, or the status of each point."""
    ax = dm.plot_sweep(study)
    assert ax.get_ylabel() == LARGEST
    largest = EXPONENTS[:, 0]
    ends = np.transpose([largest - ERRORS[:, 0], largest + ERRORS[:, 0]])
    np.testing.assert_allclose(bars_on(ax), ends)
    assert filled_on(ax) == [12.0]
    assert labels(ax.figure) == ["± standard error", "not converged"]


def test_an_exponent_that_is_selected_is_drawn() -> None:
    """It was the status of each point."""
    ax = dm.plot_sweep(studied().isel(exponent_number=1))
    assert ax.get_ylabel() == "Lyapunov exponent (1/s)"
    assert filled_on(ax) == [12.0, 14.0]


@pytest.mark.parametrize(("study", "name"), [(swept(), "exponents"), (studied(), "exponent")])
def test_all_exponents_have_their_errors_too(study: xr.Dataset, name: str) -> None:
    ax = dm.plot_sweep(study, name)
    assert len(bars_on(ax)) == EXPONENTS.size
    dots, rings = (line for line in ax.lines if line.get_marker() in (".", "o"))
    assert dots.get_xdata().tolist() == [14, 15, 15]
    assert rings.get_xdata().tolist() == [12, 12, 14]


def test_a_map_hatches_exponents_that_have_not_converged() -> None:
    over = xr.concat([swept(), swept()], xr.DataArray([300.0, 400.0], dims="N", name="N"))
    over = xr.concat([over, over.assign_coords(N=[500.0, 600.0])], "N")
    ax = dm.plot_sweep(over.assign_attrs(swept().attrs), lines=False)
    assert labels(ax.figure) == ["not converged"]


def own(case: dm.Parameters) -> dict[str, Any]:
    return {"psi": case.Omega * np.arange(3.0)}


def test_an_array_of_a_function_is_drawn_unasked() -> None:
    """It was the status of each point."""
    assert dm.plot_sweep(dm.sweep(own, CASE, Omega=SPEEDS)).get_ylabel() == "Psi"


def test_what_is_true_is_drawn_unasked() -> None:
    """It was the status of each point."""
    ax = dm.plot_sweep(dm.sweep(lambda case: {"fast": case.Omega > 13}, CASE, Omega=SPEEDS))
    assert [text.get_text() for text in ax.get_yticklabels()] == ["no", "yes"]
