"""What the picture of a Campbell diagram says of crossings that are not known, and its axes and gaps."""

import numpy as np
import xarray as xr

import disc_model as dm
from disc_model.studies.quantities.campbell import EFFECTS
from tests.figures.every_kind import flag
from tests.figures.made_up import campbell_study
from tests.figures.reading import labels
from tests.refusals import refusal


def study_of(effects: list[str], steps: list[float]) -> xr.Dataset:
    """A study with such effects of its three crossings, and steps that resolve them."""
    study = campbell_study()
    study["crossing_effect"] = flag(("crossing",), effects, EFFECTS)
    study["crossing_step"] = ("crossing", steps)
    return study


def said_of(study: xr.Dataset) -> list[str]:
    """What the legend says of crossings that are not known."""
    top, _ = dm.plot_campbell(study)
    said = [text.replace("\n", " ") for text in labels(top.figure)]
    return [text for text in said if text.startswith("3 crossings: ")]


def test_the_legend_names_the_step_of_the_narrowest_unresolved_window() -> None:
    """It said "smaller steps"; steps of the study are 0.5 rad/s."""
    study = study_of(["unresolved", "unresolved", "rises"], [0.048, 0.2, 0.01])
    assert said_of(study) == ["3 crossings: 2 need steps of 0.04 rad/s (1 marked)"]


def test_a_multiple_is_open_over_speeds_without_a_cycle() -> None:
    """It was interpolated there, and met modes that it has no crossing with."""
    study = campbell_study()
    study["stick_slip_frequency"][16:18] = np.nan
    expected = 2 * study["stick_slip_frequency"].values
    top, _ = dm.plot_campbell(study, multiples=[2])
    drawn = [np.asarray(line.get_ydata(), dtype=float) for line in top.lines]
    alike = [each for each in drawn if np.array_equal(each, expected, equal_nan=True)]
    assert len(alike) == 1


def test_many_values_are_refused_with_a_selection_that_works() -> None:
    """It named places, as `isel` has them."""
    study = campbell_study()
    several = xr.IndexVariable("N", 100.0 * np.arange(2, 9))
    loads = xr.concat([study] * several.size, several)
    with refusal(r"study='N': .*study\.sel\(N=200\.0\)"):
        dm.plot_campbell(loads)
    dm.plot_campbell(loads.sel(N=200.0))
