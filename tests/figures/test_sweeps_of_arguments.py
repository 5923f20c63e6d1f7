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


@pytest.mark.parametrize(("step", "speeds"), [(0, [9, 9.5, 10, 10.5, 11]), (1, [9, 10, 11])])
def test_one_of_several_sweeps_is_drawn_over_its_speeds(
    steps: xr.Dataset, step: int, speeds: list[float]
) -> None:
    """It was refused as a single point."""
    alone = steps.isel(step=step, N=0)
    ax = plot_sweep(alone, "range")
    upward = ax.lines[0]
    assert upward.get_xdata().tolist() == speeds


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


def test_turns_at_the_same_times_are_points_over_what_varies_on_request(angles: xr.Dataset) -> None:
    """They were lines over the time that went to and fro."""
    ax = plot_sweep(angles, "psi", points=True)
    [dots] = ax.lines
    places = dots.get_xdata()
    assert ax.get_xlabel().startswith("Kinetic friction")
    assert dots.get_linestyle() == "None"
    assert len(places) == angles["psi"].size


def test_turns_of_a_single_point_are_joined_by_no_line_on_request(angles: xr.Dataset) -> None:
    alone = angles.isel(mu_k=0)
    ax = plot_sweep(alone, "psi", points=True)
    [dots] = ax.lines
    assert dots.get_linestyle() == "None"


@pytest.mark.parametrize("wish", [{"lines": "mu_k"}, {"lines": False}, {"cmap": "viridis"}])
def test_points_have_no_lines_and_no_colours(angles: xr.Dataset, wish: dict[str, Any]) -> None:
    with refusal("points=True: must be left out beside lines"):
        plot_sweep(angles, "psi", points=True, **wish)


def numbered_turns(count: int) -> tuple[str, range, dict[str, str]]:
    """The coordinate of samples that are taken once a turn."""
    return "sample", range(count), {"long_name": "number of the turn"}


def test_samples_of_one_motion_are_joined_by_no_line() -> None:
    psi = ("sample", np.arange(9.0))
    study = xr.Dataset({"psi": psi}, {"sample": numbered_turns(9)})
    [dots] = plot_sweep(study, "psi").lines
    assert dots.get_linestyle() == "None"


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


def test_equal_mappings_are_refused() -> None:
    start = {"u": 1}
    with refusal("must not be given twice"):
        sweep(pushed, CASE, over={"start": [start, start]})


def test_scans_of_several_bounds_have_their_critical_speeds() -> None:
    """They were drawn over the number of the crossing."""
    bounds = [(10, 11), (10, 12)]
    study = sweep(dm.critical_speed, CASE, over={"bounds": bounds}, horizon=2)
    ax = plot_sweep(study)
    assert ticks_along(ax) == ["10, 11", "10, 12"]


def power(case: dm.Parameters) -> float:
    """A number that grows with load and speed."""
    return case.N * case.Omega


def test_names_of_samples_are_an_axis_beside_another() -> None:
    """It was refused, with the advice to take the other."""
    samples = {"N": [300, 350], "mu_k": [0.2, 0.22], "sample": ["A", "B"]}
    study = sweep(power, CASE, zip=samples, Omega=[10, 12])
    ax = plot_sweep(study, x="sample")
    assert ticks_along(ax) == ["A", "B"]
    assert labels(ax.figure) == ["Speed Ω = 10 rad/s", "12 rad/s"]


def test_stacked_dimensions_are_those_of_paired_samples() -> None:
    """It was a TypeError."""
    study = sweep(power, CASE, N=[300, 350], Omega=[10, 12])
    stacked = study.stack(point=("Omega", "N"))
    ax = plot_sweep(stacked, "value")
    places = ax.lines[0].get_xdata()
    assert ax.get_xlabel() == "Speed Ω (rad/s)"
    assert len(places) == 4


# ---- Several variables of one kind


def variables(**columns: tuple[list[float], str, str]) -> xr.Dataset:
    """Variables with units and long names over the speed."""
    named = {}
    for name, (values, unit, words) in columns.items():
        attributes = {"units": unit, "long_name": words}
        named[name] = ("Omega", values, attributes)
    return xr.Dataset(named, {"Omega": [10.0, 12.0]})


def test_times_in_seconds_and_in_thousandths_have_one_axis() -> None:
    """They were refused as of other units, though all are in seconds."""
    study = variables(
        stick_time=([0.006, 0.005], "s", "duration of stick"),
        period=([0.016, 0.015], "s", "period of the stick-slip cycle"),
    )
    ax = plot_sweep(study, ["stick_time", "period"])
    sticks, periods = heights_on(ax)
    assert ax.get_ylabel() == "Time (ms)"
    assert sticks == pytest.approx([6, 5])
    assert periods == pytest.approx([16, 15])


@pytest.fixture
def shares_and_verdicts() -> xr.Dataset:
    """Two shares and two verdicts over the speed."""
    return variables(
        low=([0.1, 0.2], "1", "share of the starts, lower end"),
        high=([0.3, 0.4], "1", "share of the starts, upper end"),
        stable=([True, False], "1", "whether the cycle is stable"),
        near=([True, True], "1", "whether the motion is near"),
    )


def test_shares_have_one_axis(shares_and_verdicts: xr.Dataset) -> None:
    """They were refused as of other quantities."""
    ax = plot_sweep(shares_and_verdicts, ["low", "high"])
    assert ax.get_ylabel() == "Share"


def test_verdicts_have_one_axis(shares_and_verdicts: xr.Dataset) -> None:
    """They were refused as of other quantities."""
    ax = plot_sweep(shares_and_verdicts, ["near", "stable"])
    near, stable = heights_on(ax)
    assert ax.get_ylabel() == "Yes or no"
    assert near == [1, 1]
    assert stable == [1, 0]


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


def test_a_point_without_any_sample_has_none_and_no_further_one() -> None:
    angles = [
        [0.1, 0.2],  # at 10 rad/s
        [np.nan, np.nan],
    ]
    study = xr.Dataset(
        {"psi": (("Omega", "sample"), angles)},
        {"Omega": [10.0, 12.0], "sample": numbered_turns(2)},
        {"quantity": "bifurcation"},
    )
    ax = plot_sweep(study, "psi")
    assert notes_on(ax) == ["no event while sampled"]


# ---- Bars and maps


def bars_over(horizons: list[float]) -> Axes:
    """Bars of equal shares of two classes at some horizons."""
    shares = np.full((len(horizons), 2), 0.5)
    study = xr.Dataset(
        {"basin_fraction": (("horizon", "attractor_class"), shares)},
        {"horizon": np.array(horizons, dtype=float), "attractor_class": ["quiet", "separating"]},
    )
    return plot_sweep(study)


@pytest.mark.parametrize("horizons", [[20, 40], [1, 20, 400]])
def test_bars_over_horizons_are_no_hairlines(horizons: list[float]) -> None:
    """They were at most 0.9 s wide."""
    ax = bars_over(horizons)
    left, right = ax.get_xlim()
    narrowest = min(bar.get_width() for bar in ax.patches)
    share_of_axis = narrowest / (right - left)
    assert share_of_axis > 0.2


def test_bars_over_uneven_horizons_stand_at_equal_distances() -> None:
    ax = bars_over([1, 20, 400])
    assert ticks_along(ax) == ["1", "20", "400"]


def said(case: dm.Parameters) -> dict[str, str]:
    """Words that no two cases have in common."""
    return {"said": f"at {case.N} N and {case.Omega} rad/s"}


def test_a_map_of_many_words_is_refused() -> None:
    """Its legend had an entry for each."""
    loads = [100, 200, 300, 400, 500]
    speeds = [10, 11, 12, 13, 14]
    study = sweep(said, CASE, N=loads, Omega=speeds)
    with refusal("has 25 different words, and a map tells 20 apart"):
        plot_sweep(study, "said", lines=False)
