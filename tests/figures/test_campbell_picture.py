"""Campbell diagrams of a study on a reader's axes."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures import campbell
from disc_model.figures.campbell import ALONE, Peak, peaks
from disc_model.figures.classes import NOT_NEAR
from disc_model.figures.sizes import COLUMN, PAGE
from tests.figures.described import campbell_study
from tests.figures.reading import assert_fit_for_print, assert_numbers_are_apart, labels
from tests.refusals import refusal


@pytest.fixture(autouse=True)
def _closed() -> object:
    yield
    pyplot.close("all")


@pytest.mark.parametrize("width", [COLUMN, PAGE])
def test_a_campbell_diagram_takes_the_axes_of_a_reader(width: float) -> None:
    figure, axes = pyplot.subplots(2, 1, figsize=(width, 4.6), layout="constrained", sharex=True)
    top, bottom = dm.plot_campbell(campbell_study(), ax=axes, highest=150, title="(a) modes")
    assert [top, bottom] == [*axes]
    assert top.get_title() == "(a) modes"
    assert top.get_ylim() == (0, 150)
    assert " ".join(top.get_ylabel().split()) == "Frequency in the slider's frame (Hz)"
    assert bottom.get_xlabel() == "Speed Ω (rad/s)"
    [legend] = [ax.get_legend() for ax in axes if ax.get_legend()]
    assert "cut at 150 Hz: 1 mode above" in [text.get_text() for text in legend.get_texts()]
    assert_numbers_are_apart(top)
    assert_numbers_are_apart(bottom)
    assert_fit_for_print(figure)


def test_a_new_campbell_diagram_has_all_frequencies() -> None:
    top, _ = dm.plot_campbell(campbell_study())
    assert top.get_ylim()[1] > float(campbell_study()["sliding_frequency"].max())
    assert not [text for text in labels(top.figure) if text.startswith("cut")]
    assert_fit_for_print(top.figure)


def over_two_loads() -> xr.Dataset:
    study = campbell_study()
    return xr.concat([study, study], xr.Variable("N", np.array([300.0, 385.0])))


@pytest.mark.parametrize(
    ("study", "wishes", "said"),
    [
        (over_two_loads(), {}, r"study='N': must not vary along it: .* study.isel\(N=0\)"),
        (
            campbell_study().drop_vars("crossing_Omega"),
            {},
            "must be a study of `quantity: campbell`",
        ),
        (campbell_study(), {"highest": -1.0}, "highest=-1: must be a number > 0, in Hz"),
        (campbell_study().isel(Omega=[0]), {}, "must have two speeds or more"),
    ],
)
def test_what_is_no_campbell_diagram_is_refused(
    study: xr.Dataset, wishes: dict[str, Any], said: str
) -> None:
    with refusal(said):
        dm.plot_campbell(study, **wishes)


def test_points_of_a_cycle_that_the_motion_is_not_near_are_marked() -> None:
    """The largest of them was called a peak of growth, and a point that finer steps would resolve."""
    study = campbell_study()
    away = np.full(21, np.nan)
    away[[4, 5]] = 0.0
    study["near_motion"] = ("Omega", away)
    top, bottom = dm.plot_campbell(study)
    assert NOT_NEAR.label in labels(top.figure)
    assert ALONE not in labels(top.figure)
    crosses = [line for line in bottom.lines if line.get_marker() == "x"]
    assert [[*line.get_ydata()] for line in crosses] == [[0.35, 0.4]]
    assert [peak.place for peak in peaks(study)] == [12]
    assert_fit_for_print(top.figure)
    without = dm.plot_campbell(campbell_study())[0].figure
    assert NOT_NEAR.label not in labels(without)
    pyplot.close("all")


def test_peaks_of_a_picture_are_found_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lines, names and the legend found them anew."""
    sought = []

    def counted_peaks(study: xr.Dataset) -> Iterator[Peak]:
        sought.append(study)
        return peaks(study)

    monkeypatch.setattr(campbell, "peaks", counted_peaks)
    dm.plot_campbell(campbell_study())
    assert len(sought) == 1


GAP = np.nan


@pytest.mark.parametrize(
    ("rates", "places"),
    [
        ([GAP, 0.74, 0.53, 0.45, 0.40, 0.36], []),
        ([0.74, 0.70, 0.45, 0.40, 0.36, 0.33], []),
        ([0.10, 0.20, 0.30, GAP, 0.20, 0.10], []),
        ([0.10, 0.20, 0.30, 0.40, 0.50, 0.60], []),
        ([0.10, 0.20, 0.30, 0.28, 0.20, 0.10], [12]),
        ([0.00, 0.00, 0.30, 0.00, 0.00, 0.00], [12]),
    ],
    ids=["falls from a gap", "falls", "ends at a gap", "rises", "smooth peak", "by itself"],
)
def test_a_peak_is_above_both_its_neighbours(rates: list[float], places: list[int]) -> None:
    """Points along a flank that falls from the end of a branch were peaks of growth, each with a line."""
    study = campbell_study()
    study["growth_rate"][:] = -0.05
    study["growth_rate"][10:16] = rates
    study["growth_rate"][:10] = rates[0]
    study["growth_rate"][16:] = rates[-1]
    assert [peak.place for peak in peaks(study)] == places
