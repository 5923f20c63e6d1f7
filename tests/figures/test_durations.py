"""Figures say for how long motions were followed where results depend on it."""

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.missing_texts import missing_text
from disc_model.figures.words import label_in

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
