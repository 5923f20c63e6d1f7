"""Campbell diagrams of a study on a reader's axes."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures import campbell
from disc_model.figures.campbell_legend import ALONE
from disc_model.figures.campbell_peaks import Peak, peaks
from disc_model.figures.classes import NOT_NEAR
from disc_model.figures.sizes import COLUMN, PAGE
from disc_model.studies.quantities.campbell import EFFECTS
from tests.figures.described import campbell_study
from tests.figures.every_kind import flag
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
        (dm.Parameters(N=385, Omega=15), {}, "must be a study of `quantity: campbell`"),
        (xr.Dataset({"N": 1}), {}, "study=a dataset of 1 variable: must be a study"),
        (campbell_study(), {"highest": -1.0}, "highest=-1: must be a number > 0, in Hz"),
        (
            campbell_study(),
            {"highest": "3 kg"},
            "highest='3 kg': must be a number in Hz, or with a unit",
        ),
        (campbell_study(), {"highest": "high"}, "highest='high': must be a number > 0, in Hz"),
        (campbell_study().isel(Omega=[0]), {}, "must have two speeds or more"),
    ],
)
def test_what_is_no_campbell_diagram_is_refused(
    study: Any, wishes: dict[str, Any], said: str
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


def test_the_highest_frequency_may_have_a_unit() -> None:
    """A study's figure took it, and the picture did not."""
    top, _ = dm.plot_campbell(campbell_study(), highest="0.15 kHz")
    assert top.get_ylim() == (0, 150)


def test_a_second_diagram_needs_axes_of_its_own() -> None:
    """Two on the same axes had black lines and names on each other."""
    _, axes = pyplot.subplots(2, 1, layout="constrained")
    dm.plot_campbell(campbell_study(), ax=axes)
    before = [len(ax.lines) for ax in axes]
    with refusal("shows a Campbell diagram already: give each its own axes"):
        dm.plot_campbell(campbell_study(), ax=axes)
    assert [len(ax.lines) for ax in axes] == before
    for ax in axes:
        ax.clear()
    dm.plot_campbell(campbell_study(), ax=axes)


@pytest.mark.parametrize(
    ("highest", "said"),
    [
        (None, ["2 modes of 5 not computed"]),
        (250.0, ["2 modes of 5 not computed"]),
        (150.0, ["cut at 150 Hz: 3 modes above", "2 modes of 5 not computed"]),
    ],
)
def test_modes_without_room_are_counted(highest: float | None, said: list[str]) -> None:
    """Only modes that had room were counted above the edge, and nothing was said without one."""
    study = campbell_study().assign(n_modes=("Omega", np.full(21, 5)))
    figure = dm.plot_campbell(study, highest=highest)[0].figure
    found = [text for text in labels(figure) if text.startswith("cut") or "computed" in text]
    assert found == said
    assert_fit_for_print(figure)


def with_sliding(*rates: float, gone: slice) -> xr.Dataset:
    """A study whose modes of steady sliding have these growth rates at all speeds, without a cycle at
    some of them."""
    study = campbell_study()
    growth = np.tile(rates, (21, 1))
    study["sliding_growth_rate"] = (("Omega", "mode"), growth)
    words = np.full(21, "ok", dtype=object)
    words[gone] = "no_stick_slip"
    study["status"] = flag(("Omega",), words, ("ok", "no_stick_slip"))
    study["growth_rate"][gone] = np.nan
    return study


@pytest.mark.parametrize(
    ("largest", "word"), [(0.5, "unstable steady sliding"), (-0.5, "steady sliding")]
)
def test_steady_sliding_without_a_cycle_is_named(largest: float, word: str) -> None:
    """It was shaded as if nothing were known: "no growth rate"."""
    study = with_sliding(-1.0, largest, -2.0, gone=slice(14, 21))
    top, bottom = dm.plot_campbell(study)
    said = labels(top.figure)
    assert word in said
    assert not [text for text in said if text.startswith("no growth rate")]
    assert len(top.patches) == len(bottom.patches) == 1
    assert bottom.patches[0].get_hatch(), "told apart in grey print"
    assert_fit_for_print(top.figure)


def test_modes_beyond_the_room_decide_whether_sliding_is_stable() -> None:
    study = with_sliding(-1.0, -0.5, -2.0, gone=slice(14, 21))
    study["largest_sliding_growth_rate"] = ("Omega", np.full(21, 0.2))
    assert "unstable steady sliding" in labels(dm.plot_campbell(study)[0].figure)


def test_modes_that_grow_are_thick() -> None:
    """Unstable modes of steady sliding were drawn like stable ones."""
    name = "mode of steady sliding that grows"
    study = with_sliding(-1.0, 0.5, -2.0, gone=slice(14, 21))
    top, _ = dm.plot_campbell(study)
    assert name in labels(top.figure)
    *thin, thick = top.lines[:4]
    assert thick.get_linewidth() > 2 * max(line.get_linewidth() for line in thin)
    assert [*thick.get_ydata()] == [*study["sliding_frequency"].sel(mode=2).values]
    stable = with_sliding(-1.0, -0.5, -2.0, gone=slice(14, 21))
    assert name not in labels(dm.plot_campbell(stable)[0].figure)


NOT_CROSSED = "peak of growth, no crossing found at it"


def test_a_peak_without_a_crossing_is_told_from_one_at_a_crossing() -> None:
    """The legend said "crossing at it" of peaks at which none was."""
    study = campbell_study()
    top, bottom = dm.plot_campbell(study.isel(crossing=[0, 1]))
    said = labels(top.figure)
    assert NOT_CROSSED in said
    assert "peak of growth, crossing at it" in said
    marks = {line.get_marker(): [*line.get_xdata()] for line in bottom.lines}
    assert marks["D"] == [study["Omega"].values[12]]
    far = study.assign(crossing_Omega=("crossing", [9.0, 9.0, 9.0]))
    said = labels(dm.plot_campbell(far)[0].figure)
    assert NOT_CROSSED in said
    assert not [text for text in said if "crossing at it" in text or "multiple" in text]
    study["growth_rate"][[4, 11]] = -0.05  # the points before the peaks
    unresolved = study.assign(crossing_Omega=("crossing", [9.0, 9.0, 9.0]))
    said = labels(dm.plot_campbell(unresolved)[0].figure)
    assert f"speed of a {NOT_CROSSED}" in said


@pytest.mark.parametrize(
    ("effects", "said"),
    [
        (["unresolved"] * 3, ["3 crossings unresolved: smaller steps"]),
        (["unresolved", "unresolved", "rises"], ["2 of 3 crossings unresolved: smaller steps"]),
        (["unresolved", "no_rise", "rises"], ["1 of 3 crossings unresolved"]),
        (["no_rise", "no_rise", "rises"], []),
    ],
)
def test_unresolved_crossings_are_counted(effects: list[str], said: list[str]) -> None:
    """Of 213 crossings none was resolved, and the figure said nothing."""
    study = campbell_study()
    study["crossing_effect"] = flag(("crossing",), effects, EFFECTS)
    figure = dm.plot_campbell(study)[0].figure
    assert [text for text in labels(figure) if "unresolved" in text] == said
    assert_fit_for_print(figure)


def test_rates_of_other_cycles_count_for_the_scale() -> None:
    """Of rates about -1/s beside one of 80/s, which is another cycle's, the scale was linear."""
    study = campbell_study()
    study["growth_rate"][:] = np.linspace(-1.2, -1.0, 21)
    study["growth_rate"][4] = 80.0
    away = np.full(21, np.nan)
    away[4] = 0.0
    study["near_motion"] = ("Omega", away)
    _, bottom = dm.plot_campbell(study)
    assert bottom.get_yscale() == "symlog"
    low, high = bottom.transAxes.inverted().transform(
        bottom.transData.transform([(8, -1.2), (8, 0)])
    )[:, 1]
    assert high - low > 0.1
