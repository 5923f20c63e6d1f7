"""Sweeps over arguments of functions, and of functions of one's own, have pictures of their meaning."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

import disc_model as dm
from disc_model import plot_sweep, sweep
from disc_model.figures.labels import words_of
from tests.figures.reading import labels
from tests.refusals import refusal

CASE = dm.Parameters(N=385, Omega=14)


def ticks_along(ax: Axes) -> list[str]:
    """The words along the horizontal axis."""
    return [words_of(label) for label in ax.get_xticklabels()]


def notes_on(ax: Axes) -> list[str]:
    """The words that stand inside or above axes."""
    return [words_of(text) for text in ax.texts]


def heights_on(ax: Axes) -> list[list[float]]:
    """The heights of the points of each line."""
    return [line.get_ydata().tolist() for line in ax.lines]


# ---- Sweeps of the speed in several steps


@pytest.fixture(scope="module")
def steps() -> xr.Dataset:
    """Sweeps of the speed in two steps, at two loads."""
    return sweep(
        dm.hysteresis,
        CASE,
        over={"step": [0.5, 1]},
        N=[300, 385],
        bounds=(9, 11),
        dwell=1,
        max_dwell=2,
        evaluation_time=1,
    )


def test_sweeps_in_several_steps_have_their_speeds_of_separation(steps: xr.Dataset) -> None:
    """It was an error of xarray, that there was no such dimension."""
    at_one_load = steps.isel(N=0)
    ax = plot_sweep(at_one_load)
    assert ax.get_xlabel() == "Step of the speeds (rad/s)"


@pytest.mark.parametrize("step", [0, 1])
def test_sweeps_at_several_loads_are_lines_over_their_speeds(steps: xr.Dataset, step: int) -> None:
    """They were drawn over the load."""
    upward = steps.isel(step=step, direction=0)
    ax = plot_sweep(upward, "range")
    named = labels(ax.figure)
    assert ax.get_xlabel() == "Speed Ω (rad/s)"
    assert named[:2] == ["Preload N = 300 N", "385 N"]


# ---- Points


def turns(case: dm.Parameters) -> xr.Dataset:
    """Angles at turns, whose times are the same at all points."""
    time = np.arange(1.0, 30.0)
    angles = case.mu_k * np.sin(time)
    return xr.Dataset({"psi": ("time", angles)}, {"time": time})


@pytest.fixture
def angles() -> xr.Dataset:
    """Angles at turns, at three coefficients of friction."""
    return sweep(turns, CASE, mu_k=[0.2, 0.22, 0.24])


# ---- Words, truth, and lists along an axis


def flagged(case: dm.Parameters, flag: bool) -> dict[str, float]:
    """A number that depends on something true or false."""
    return {"size": case.Omega + flag}


def test_true_and_false_along_an_axis_are_words() -> None:
    """They were numbers from 0.0 to 1.0, and lines of 0 and 1."""
    study = sweep(flagged, CASE, Omega=[8, 10], over={"flag": [False, True]})
    over_speeds = plot_sweep(study)
    over_flags = plot_sweep(study, x="flag")
    assert labels(over_speeds.figure) == ["Flag = no", "yes"]
    assert ticks_along(over_flags) == ["no", "yes"]


def pushed(case: dm.Parameters, start: Any) -> dict[str, float]:
    """A number of a start that is a mapping or a list."""
    numbers = [*start.values()] if isinstance(start, dict) else start
    return {"size": sum(numbers)}


STARTS: dict[str, tuple[Any, list[str]]] = {
    "mappings": ([{"u": 1e-3}, {"u": 2e-3, "f": 1}], ["u = 0.001", "u = 0.002, f = 1"]),
    "tuples": ([(9, 12), (9, 14)], ["9, 12", "9, 14"]),
    "rows of an array": (np.array([[9, 12], [9, 14]]), ["9, 12", "9, 14"]),
}
"""Starts, and the words by which they are told apart."""


@pytest.mark.parametrize("kind", STARTS)
def test_mappings_and_lists_vary_along_an_axis(kind: str) -> None:
    """They were refused, as no numbers or words."""
    starts, words = STARTS[kind]
    study = sweep(pushed, CASE, over={"start": starts})
    ax = plot_sweep(study)
    assert study["start"].values.tolist() == words
    assert ticks_along(ax) == words


def test_scans_of_several_bounds_have_their_critical_speeds() -> None:
    """They were drawn over the number of the crossing."""
    bounds = [(10, 11), (10, 12)]
    study = sweep(dm.critical_speed, CASE, over={"bounds": bounds}, horizon=2)
    ax = plot_sweep(study)
    assert ticks_along(ax) == ["10, 11", "10, 12"]


# ---- Several variables of one kind


def variables(**columns: tuple[list[float], str, str]) -> xr.Dataset:
    """Variables with units and long names over the speed."""
    named = {}
    for name, (values, unit, words) in columns.items():
        attributes = {"units": unit, "long_name": words}
        named[name] = ("Omega", values, attributes)
    return xr.Dataset(named, {"Omega": [10.0, 12.0]})


@pytest.fixture
def shares_and_verdicts() -> xr.Dataset:
    """Two shares and two verdicts over the speed."""
    return variables(
        low=([0.1, 0.2], "1", "share of the starts, lower end"),
        high=([0.3, 0.4], "1", "share of the starts, upper end"),
        stable=([True, False], "1", "whether the cycle is stable"),
        near=([True, True], "1", "whether the motion is near"),
    )


def test_shares_and_verdicts_have_no_axis_in_common(shares_and_verdicts: xr.Dataset) -> None:
    with refusal("is something else"):
        plot_sweep(shares_and_verdicts, ["low", "stable"])


def test_critical_values_of_several_parameters_are_refused_together() -> None:
    """Numbers of rad/s and N stood along one axis, called "Value"."""
    study = xr.Dataset(
        {"value": ("name", [15.0, 300.0]), "status": ("name", ["ok", "ok"])},
        {"name": ["Omega", "N"]},
        {"function": "critical"},
    )
    with refusal(r"has another unit for each name: select one, as by study.isel\(name=0\)"):
        plot_sweep(study)


# ---- What has no value


def test_periods_that_are_not_shown_are_no_zeros() -> None:
    """A line went down to 0, which is the number of no events."""
    words = "number of events after which the motion repeats, 0 if that is not shown"
    attributes = {"units": "1", "long_name": words}
    study = xr.Dataset(
        {"period_events": ("Omega", [1, 2, 0], attributes)},
        {"Omega": [10.0, 12.0, 14.0]},
        {"quantity": "bifurcation"},
    )
    ax = plot_sweep(study, "period_events")
    along = words_of(ax.yaxis.label)
    [*shown, hidden] = heights_on(ax)[0]
    assert along == "Number of events after which the motion repeats"
    assert shown == [1, 2]
    assert np.isnan(hidden)
    assert "not shown to repeat" in notes_on(ax)
