"""Figures say for how long motions were followed where results depend on it."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.missing_texts import missing_text
from disc_model.figures.words import label_in
from tests.figures.reading import as_map

CASE = dm.Parameters(N=385, Omega=15, n_diameters=2)
LOADS = [300.0, 385.0]  # N


def study_of(function: str, name: str, options: str, **attrs: str) -> xr.Dataset:
    """A study of a variable with options, some of whose points have no value."""
    variable = xr.DataArray([1.0, np.nan], dims="N", attrs=attrs)
    stated = {"function": function, "options": options}
    return xr.Dataset({name: variable}, {"N": LOADS, "scan_Omega": [8.0, 22.0]}, stated)


@pytest.mark.parametrize(
    ("horizon", "said"),
    [
        ("50", "none found from 8 to 22 rad/s in steps of 14 rad/s within 50 s"),
        ('"2 min"', "none found from 8 to 22 rad/s in steps of 14 rad/s within 2 min"),
        ("[50]", "none found from 8 to 22 rad/s in steps of 14 rad/s within 50 s"),
        ("[50, 100]", "none found from 8 to 22 rad/s in steps of 14 rad/s"),
    ],
)
def test_a_critical_speed_that_was_not_found_has_its_horizon(horizon: str, said: str) -> None:
    """Pictures said from which speed to which, but not within which time."""
    study = study_of("critical_speed", "critical_speed", f'{{"horizon": {horizon}}}')
    assert missing_text(study, "critical_speed") == said


def test_a_critical_speed_names_the_horizon_that_was_not_given() -> None:
    study = dm.sweep(dm.critical_speed, CASE, N=LOADS, bounds=(8, 9))
    assert (
        missing_text(study, "critical_speed")
        == "none found from 8 to 9 rad/s in steps of 1 rad/s within 1000 s"
    )
    ax = dm.plot_sweep(study)
    assert (
        " ".join(ax.get_ylabel().split()) == "Critical speed for separation within 1000 s (rad/s)"
    )
    pyplot.close("all")


def test_a_horizon_that_is_selected_is_named() -> None:
    study = dm.sweep(dm.critical_speed, CASE, N=LOADS, bounds=(8, 9), horizon=[1, 2])
    assert label_in(study, "critical_speed") == "Critical speed for separation (rad/s)"
    ax = dm.plot_sweep(study.sel(horizon=2))
    assert " ".join(ax.get_ylabel().split()) == "Critical speed for separation within 2 s (rad/s)"
    pyplot.close("all")


def test_a_horizon_that_varies_is_an_axis_and_is_named_once_it_is_selected() -> None:
    study = dm.sweep(dm.outcome, CASE, over={"horizon": [1, 2]}, N=LOADS)
    assert label_in(study, "outcome") == "Outcome"
    assert missing_text(study, "first_separation") == "none within the horizon"
    ax = dm.plot_sweep(study, "time_reached", x="horizon", lines="N")
    assert ax.get_xlabel() == "Horizon (s)"
    ax = dm.plot_sweep(study, "time_reached", x="N", lines="horizon")
    (legend,) = ax.figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["Horizon = 1 s", "2 s"]
    ax = dm.plot_sweep(study.sel(horizon=2), "outcome")
    assert " ".join(ax.get_ylabel().split()) == "Outcome within 2 s"
    pyplot.close("all")


def test_a_critical_value_of_multipliers_has_no_horizon() -> None:
    study = study_of("critical", "value", '{"bounds": [8, 22]}', units="rad s-1")
    assert missing_text(study, "value") == "none found from 8 to 22 rad/s"
    assert label_in(study, "value") == "Value (rad/s)"


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("critical_energy", "no start led to lasting separation within 60 s"),
        ("attractor_period", "no further attractor, or not periodic"),
    ],
)
def test_an_energy_that_was_not_found_has_its_horizon(name: str, said: str) -> None:
    study = study_of("basins", name, '{"horizon": 60}')
    assert missing_text(study, name) == said


@pytest.mark.parametrize(
    ("function", "name", "long_name", "said"),
    [
        (
            "critical_speed",
            "n_crossings",
            "number of speeds at which separation within the horizon begins",
            "Number of speeds at which separation within 5 s begins",
        ),
        (
            "lyapunov_exponents",
            "separations",
            "number of separations in that time",
            "Number of separations within 5 s",
        ),
        ("floquet", "separations", "number of separations in its period", ""),
        ("simulate", "n_separations", "number of separations", "Number of separations within 5 s"),
        ("simulate", "first_separation", "time of the first separation", ""),
    ],
)
def test_counts_have_the_time_in_which_they_were_counted(
    function: str, name: str, long_name: str, said: str
) -> None:
    """ "In that time" was said of none, and counts of runs did not say for how long these were."""
    study = study_of(function, name, '{"horizon": 5}', long_name=long_name)
    for time in ("t_end", "duration"):
        study[time] = ("N", [5.0, 5.0])
    usual = long_name[0].upper() + long_name[1:]
    assert label_in(study, name) == (said or usual)


@pytest.mark.parametrize(
    ("options", "ends", "said"),
    [
        ("{}", [5.0, np.nan], "Number of separations within 5 s"),
        ("{}", [5.0, 6.0], "Number of separations"),
        ('{"initial_state": "a state"}', [5.0, 5.0], "Number of separations"),
        (
            '{"initial_state": "a state", "duration": 2}',
            [5.0, 5.0],
            "Number of separations within 2 s",
        ),
    ],
)
def test_runs_of_several_or_unknown_lengths_name_none(
    options: str, ends: list[float], said: str
) -> None:
    study = study_of("simulate", "n_separations", options, long_name="number of separations")
    study["t_end"] = ("N", ends)
    assert label_in(study, "n_separations") == said


def entries(ax: Any) -> list[str]:
    """The words of a legend."""
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_runs_of_two_lengths_share_axes_and_are_told_apart() -> None:
    first = dm.sweep(dm.simulate, CASE, N=LOADS, t_end=0.1)
    second = dm.sweep(dm.simulate, CASE, N=LOADS, t_end="0.2 s")
    _, ax = pyplot.subplots()
    dm.plot_sweep(first, ax=ax)
    dm.plot_sweep(second, ax=ax)
    assert ax.get_ylabel() == "Number of separations"
    assert entries(ax) == ["within 0.1 s", "within 0.2 s"]
    pyplot.close("all")


def test_times_of_one_run_share_its_length() -> None:
    study = dm.sweep(dm.simulate, CASE, N=LOADS, t_end=0.1)
    _, ax = pyplot.subplots()
    dm.plot_sweep(study, ["time_stick", "time_slip"], ax=ax)
    assert ax.get_ylabel() == "Time spent within 0.1 s (s)"
    assert entries(ax) == ["Time spent sticking", "Time spent slipping"]
    pyplot.close("all")


def test_bars_of_colours_have_the_time_in_which_they_were_counted() -> None:
    study = dm.sweep(dm.simulate, CASE, N=LOADS, Omega=[10.0, 12.0], t_end=0.1)
    ax = as_map(study, "n_events")
    label = ax.figure.axes[1].get_ylabel()
    assert " ".join(label.split()) == "Number of events within 0.1 s"
    pyplot.close("all")
