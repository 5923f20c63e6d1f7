"""Sweeps over arguments of functions, and of functions of one's own, have pictures of their meaning."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.figures.labels import words_of
from tests.figures.reading import labels
from tests.refusals import refusal

CASE = dm.Parameters(N=385, Omega=14)


@pytest.fixture(autouse=True)
def _closed() -> object:
    yield
    pyplot.close("all")


def ticks_along(ax: Axes) -> list[str]:
    """The words along the horizontal axis."""
    return [words_of(label) for label in ax.get_xticklabels()]


# ---- Sweeps of the speed in several steps


@pytest.fixture(scope="module")
def steps() -> xr.Dataset:
    """Sweeps of the speed in two steps, at two loads."""
    over = {"step": [0.5, 1]}
    stays = {"dwell": 1, "max_dwell": 2, "evaluation_time": 1}
    return dm.sweep(dm.hysteresis, CASE, over=over, N=[300, 385], bounds=(9, 11), **stays)


def test_sweeps_in_several_steps_have_their_speeds_of_separation(steps: xr.Dataset) -> None:
    """It was an error of xarray, that there was no such dimension."""
    ax = dm.plot_sweep(steps.isel(N=0))
    assert ax.get_xlabel() == "Step of the speeds (rad/s)"


@pytest.mark.parametrize(("step", "speeds"), [(0, [9, 9.5, 10, 10.5, 11]), (1, [9, 10, 11])])
def test_one_of_several_sweeps_is_drawn_over_its_speeds(
    steps: xr.Dataset, step: int, speeds: list[float]
) -> None:
    """It was refused as a single point, or drawn over the load."""
    alone = dm.plot_sweep(steps.isel(step=step, N=0), "range")
    assert alone.lines[0].get_xdata().tolist() == speeds
    beside = dm.plot_sweep(steps.isel(step=step, direction=0), "range")
    assert beside.get_xlabel() == "Speed Ω (rad/s)"
    assert labels(beside.figure)[:2] == ["Preload N = 300 N", "385 N"]


# ---- Points


def turns(case: dm.Parameters) -> xr.Dataset:
    """Angles at turns, whose times are the same at all points."""
    time = np.arange(1.0, 30.0)
    return xr.Dataset({"psi": ("time", case.mu_k * np.sin(time))}, {"time": time})


def test_turns_at_the_same_times_are_points_over_what_varies_on_request() -> None:
    """They were lines over the time that went to and fro."""
    study = dm.sweep(turns, CASE, mu_k=[0.2, 0.22, 0.24])
    ax = dm.plot_sweep(study, "psi", points=True)
    assert ax.get_xlabel().startswith("Kinetic friction")
    [dots] = ax.lines
    assert dots.get_linestyle() == "None"
    assert len(dots.get_xdata()) == study["psi"].size

    [alone] = dm.plot_sweep(study.isel(mu_k=0), "psi", points=True).lines
    assert alone.get_linestyle() == "None"


@pytest.mark.parametrize("wish", [{"lines": "mu_k"}, {"lines": False}, {"cmap": "viridis"}])
def test_points_have_no_lines_and_no_colours(wish: dict[str, Any]) -> None:
    with refusal("points=True: must be left out beside lines"):
        dm.plot_sweep(dm.sweep(turns, CASE, mu_k=[0.2, 0.22]), "psi", points=True, **wish)


def test_samples_of_one_motion_are_joined_by_no_line() -> None:
    number = ("sample", range(9), {"long_name": "number of the turn"})
    study = xr.Dataset({"psi": ("sample", np.arange(9.0))}, {"sample": number})
    [line] = dm.plot_sweep(study, "psi").lines
    assert line.get_linestyle() == "None"


# ---- Words, truth, and lists along an axis


def flagged(case: dm.Parameters, flag: bool) -> dict[str, float]:
    return {"size": case.Omega + flag}


def test_true_and_false_along_an_axis_are_words() -> None:
    """They were numbers from 0.0 to 1.0, and lines of 0 and 1."""
    study = dm.sweep(flagged, CASE, Omega=[8, 10], over={"flag": [False, True]})
    assert labels(dm.plot_sweep(study).figure) == ["Flag = no", "yes"]
    assert ticks_along(dm.plot_sweep(study, x="flag")) == ["no", "yes"]


def pushed(case: dm.Parameters, start: Any) -> dict[str, float]:
    return {"size": sum(start.values()) if isinstance(start, dict) else sum(start)}


@pytest.mark.parametrize(
    ("starts", "words"),
    [
        ([{"u": 1e-3}, {"u": 2e-3, "f": 1}], ["u = 0.001", "u = 0.002, f = 1"]),
        ([(9, 12), (9, 14)], ["9, 12", "9, 14"]),
        (np.array([[9, 12], [9, 14]]), ["9, 12", "9, 14"]),
    ],
)
def test_mappings_and_lists_vary_along_an_axis(starts: Any, words: list[str]) -> None:
    """They were refused, as no numbers or words."""
    study = dm.sweep(pushed, CASE, over={"start": starts})
    assert study["start"].values.tolist() == words
    assert ticks_along(dm.plot_sweep(study)) == words


def test_equal_mappings_are_refused() -> None:
    with refusal("must not be given twice"):
        dm.sweep(pushed, CASE, over={"start": [{"u": 1}, {"u": 1}]})


def test_scans_of_several_bounds_have_their_critical_speeds() -> None:
    """They were drawn over the number of the crossing."""
    over = {"bounds": [(10, 11), (10, 12)]}
    study = dm.sweep(dm.critical_speed, CASE, over=over, horizon=2)
    ax = dm.plot_sweep(study)
    assert ticks_along(ax) == ["10, 11", "10, 12"]


def test_names_of_samples_are_an_axis_beside_another() -> None:
    """It was refused, with the advice to take the other."""
    zipped = {"N": [300, 350], "mu_k": [0.2, 0.22], "sample": ["A", "B"]}
    study = dm.sweep(lambda case: case.N * case.Omega, CASE, zip=zipped, Omega=[10, 12])
    ax = dm.plot_sweep(study, x="sample")
    assert ticks_along(ax) == ["A", "B"]
    assert labels(ax.figure) == ["Speed Ω = 10 rad/s", "12 rad/s"]


def test_stacked_dimensions_are_those_of_paired_samples() -> None:
    """It was a TypeError."""
    study = dm.sweep(lambda case: case.N * case.Omega, CASE, N=[300, 350], Omega=[10, 12])
    ax = dm.plot_sweep(study.stack(point=("Omega", "N")), "value")
    assert ax.get_xlabel() == "Speed Ω (rad/s)"
    assert len(ax.lines[0].get_xdata()) == 4


# ---- Several variables of one kind


def variables(**columns: tuple[list[float], str, str]) -> xr.Dataset:
    """Variables with units and long names over the speed."""
    named = {
        name: ("Omega", values, {"units": unit, "long_name": words})
        for name, (values, unit, words) in columns.items()
    }
    return xr.Dataset(named, {"Omega": [10.0, 12.0]})


def test_times_in_seconds_and_in_thousandths_have_one_axis() -> None:
    """They were refused as of other units, though all are in seconds."""
    study = variables(
        stick_time=([0.006, 0.005], "s", "duration of stick"),
        period=([0.016, 0.015], "s", "period of the stick-slip cycle"),
    )
    ax = dm.plot_sweep(study, ["stick_time", "period"])
    assert ax.get_ylabel() == "Time (ms)"
    np.testing.assert_allclose([line.get_ydata() for line in ax.lines], [[6, 5], [16, 15]])


def test_shares_have_one_axis_and_so_have_verdicts() -> None:
    """They were refused as of other quantities."""
    study = variables(
        low=([0.1, 0.2], "1", "share of the starts, lower end"),
        high=([0.3, 0.4], "1", "share of the starts, upper end"),
        stable=([True, False], "1", "whether the cycle is stable"),
        near=([True, True], "1", "whether the motion is near"),
    )
    assert dm.plot_sweep(study, ["low", "high"]).get_ylabel() == "Share"
    ax = dm.plot_sweep(study, ["near", "stable"])
    assert ax.get_ylabel() == "Yes or no"
    assert [line.get_ydata().tolist() for line in ax.lines] == [[1, 1], [1, 0]]
    with refusal("is something else"):
        dm.plot_sweep(study, ["low", "stable"])


def test_critical_values_of_several_parameters_are_refused_together() -> None:
    """Numbers of rad/s and N stood along one axis, called "Value"."""
    study = xr.Dataset(
        {"value": ("name", [15.0, 300.0]), "status": ("name", ["ok", "ok"])},
        {"name": ["Omega", "N"]},
        {"function": "critical"},
    )
    with refusal(r"has another unit for each name: select one, as by study.isel\(name=0\)"):
        dm.plot_sweep(study)


# ---- What has no value


def test_periods_that_are_not_shown_are_no_zeros() -> None:
    """A line went down to 0, which is the number of no events."""
    words = "number of events after which the motion repeats, 0 if that is not shown"
    study = xr.Dataset(
        {"period_events": ("Omega", [1, 2, 0], {"units": "1", "long_name": words})},
        {"Omega": [10.0, 12.0, 14.0]},
        {"quantity": "bifurcation"},
    )
    ax = dm.plot_sweep(study, "period_events")
    words = words_of(ax.yaxis.label)
    assert words == "Number of events after which the motion repeats"
    assert ax.lines[0].get_ydata()[:2].tolist() == [1, 2]
    assert np.isnan(ax.lines[0].get_ydata()[2])
    assert "not shown to repeat" in [words_of(text) for text in ax.texts]


def test_a_point_without_any_sample_has_none_and_no_further_one() -> None:
    values = [[0.1, 0.2], [np.nan, np.nan]]
    number = ("sample", range(2), {"long_name": "number of the turn"})
    study = xr.Dataset(
        {"psi": (("Omega", "sample"), values)},
        {"Omega": [10.0, 12.0], "sample": number},
        {"quantity": "bifurcation"},
    )
    ax = dm.plot_sweep(study, "psi")
    assert [words_of(text) for text in ax.texts] == ["no sample"]


# ---- Bars and maps


@pytest.mark.parametrize("horizons", [[20, 40], [1, 20, 400]])
def test_bars_over_horizons_are_no_hairlines(horizons: list[float]) -> None:
    """They were at most 0.9 s wide."""
    classes = ["quiet", "separating"]
    shares = np.full((len(horizons), 2), 0.5)
    study = xr.Dataset(
        {"basin_fraction": (("horizon", "attractor_class"), shares)},
        {"horizon": np.array(horizons, dtype=float), "attractor_class": classes},
    )
    ax = dm.plot_sweep(study)
    left, right = ax.get_xlim()
    widths = [bar.get_width() / (right - left) for bar in ax.patches]
    assert min(widths) > 0.2
    if len(horizons) > 2:
        assert ticks_along(ax) == [f"{horizon:g}" for horizon in horizons]


def test_a_map_of_many_words_is_refused() -> None:
    """Its legend had an entry for each."""
    study = dm.sweep(
        lambda case: {"said": f"at {case.N} N and {case.Omega} rad/s"},
        CASE,
        N=[100, 200, 300, 400, 500],
        Omega=[10, 11, 12, 13, 14],
    )
    with refusal("has 25 different words, and a map tells 20 apart"):
        dm.plot_sweep(study, "said", lines=False)
