"""What the picture of a Campbell diagram says of crossings that are not known, and its axes and gaps."""

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.campbell_counts import rounded_down
from disc_model.figures.sizes import COLUMN, PAGE
from disc_model.studies.quantities.campbell import EFFECTS
from tests.figures.described import campbell_study
from tests.figures.every_kind import flag
from tests.figures.reading import assert_fit_for_print, labels
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
    assert_fit_for_print(top.figure)
    said = [text.replace("\n", " ") for text in labels(top.figure)]
    return [text for text in said if text.startswith("3 crossings: ")]


def test_the_legend_names_the_step_of_the_narrowest_unresolved_window() -> None:
    """It said "smaller steps"; steps of the study are 0.5 rad/s."""
    study = study_of(["unresolved", "unresolved", "rises"], [0.048, 0.2, 0.01])
    assert said_of(study) == ["3 crossings: 2 need steps of 0.04 rad/s (1 marked)"]


def test_the_legend_names_no_step_wider_than_those_of_the_study() -> None:
    study = study_of(["unresolved"] * 3, [0.6, 0.7, 0.8])
    assert said_of(study) == ["3 crossings: all unresolved (2 marked)"]


def test_the_legend_asks_for_a_wider_scan_where_a_window_leaves_it() -> None:
    """It asked for smaller steps."""
    study = study_of(["beyond_scan", "beyond_scan", "rises"], [0.1] * 3)
    assert said_of(study) == ["3 crossings: 2 need a wider scan (1 marked)"]


def test_both_remedies_are_told_apart() -> None:
    study = study_of(["beyond_scan", "unresolved", "rises"], [0.1] * 3)
    said = "3 crossings: 1 needs steps of 0.1 rad/s, 1 needs a wider scan (marked)"
    assert said_of(study) == [said]


def test_steps_that_differ_much_are_named_from_the_least_on() -> None:
    """One of 279 crossings needed steps of 2e-6 rad/s, and the legend asked for these alone."""
    study = study_of(["unresolved", "unresolved", "rises"], [0.0005, 0.2, 0.01])
    assert said_of(study) == ["3 crossings: 2 need steps of 0.0005 to 0.2 rad/s (1 marked)"]


@pytest.mark.parametrize(
    ("value", "rounded"), [(0.048, 0.04), (0.02, 0.02), (0.07, 0.07), (1.9, 1), (12, 10)]
)
def test_steps_are_rounded_down(value: float, rounded: float) -> None:
    assert rounded_down(value) == pytest.approx(rounded)


@pytest.mark.parametrize("width", [COLUMN, PAGE])
def test_both_panels_on_own_axes_have_the_speeds_of_the_study(width: float) -> None:
    """The lower one had a margin."""
    _, axes = pyplot.subplots(2, 1, figsize=(width, 4.6), layout="constrained")
    top, bottom = dm.plot_campbell(campbell_study(), ax=axes)
    assert top.get_xlim() == bottom.get_xlim() == (8, 18)


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


def test_a_multiple_at_a_peak_is_open_where_the_motion_is_near_another_cycle() -> None:
    """It had the frequency of the other cycle there."""
    study = campbell_study()
    away = np.full(21, np.nan)
    away[17:19] = 0.0
    study["near_motion"] = ("Omega", away)
    near = study["near_motion"].isnull()
    expected = 2.5 * study["stick_slip_frequency"].where(near).values
    top, _ = dm.plot_campbell(study)
    drawn = [np.asarray(line.get_ydata(), dtype=float) for line in top.lines]
    alike = [each for each in drawn if np.array_equal(each, expected, equal_nan=True)]
    assert len(alike) == 1
