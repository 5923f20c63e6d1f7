"""Pictures of bifurcations in which some motions have no events, or had not settled: a figure of a study, a
curve, and a sweep say the same of them."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.analysis.classify import ANSWER
from disc_model.data.variables import LONG_TERM_OUTCOMES, PHASES
from disc_model.figures.gap_rows import rows_above
from tests.figures.described import drawn, status
from tests.figures.every_kind import column, flag, over, stated

NAN = np.nan
SPEEDS = [8.0, 9.0, 10.0, 11.0]
SLIDES = 10.0


def study_of(section: str, settled: list[str], phases: list[str]) -> xr.Dataset:
    """Motions at four speeds, of which one slides steadily."""
    angles = np.array([0.031, 0.035, 0.028, 0.033])
    angles[np.array(phases) == "none"] = NAN
    kinds = ["other_cycle", "separating", "steady_sliding", "undecided"]
    data = {
        "psi": (
            ("Omega", "sample"),
            np.column_stack([angles, angles]),
            column("bifurcation", "psi"),
        ),
        "phase": flag(("Omega", "sample"), [[phase] * 2 for phase in phases], ("none", *PHASES)),
        "settled": flag(("Omega",), settled, ANSWER.flags),
        "kind": flag(("Omega",), kinds, LONG_TERM_OUTCOMES),
        "period_events": ("Omega", [1, 2, 0, 0], column("bifurcation", "period_events")),
        "status": status(("Omega",), ["ok"] * 4),
    }
    words = {**stated(section=section), "quantity": "bifurcation"}
    return xr.Dataset(data, over(Omega=np.array(SPEEDS), sample=np.arange(2)), words)


SETTLED = ["settled", "settled", "settled", "undecided"]
PHASES_AT = {
    "event": ["stick", "separation", "none", "separation"],
    "stroboscopic": ["slip", "slip", "slip", "slip"],
}


@pytest.fixture(params=["event", "stroboscopic"])
def study(request: pytest.FixtureRequest) -> xr.Dataset:
    return study_of(request.param, SETTLED, PHASES_AT[request.param])


def line_called(ax: Axes, name: str) -> Any:
    """The marks that a legend calls by a name."""
    [found] = [line for line in ax.lines if line.get_label() == name]
    return found


def marked(ax: Axes, reason: str) -> list[float]:
    """The places that are marked above a panel for a reason."""
    rows = [each for each in rows_above(ax) if each.words.get_text() == reason]
    return [float(place) for each in rows for row in each.rows for place in row.get_xdata()]


def entries(ax: Axes) -> set[str]:
    """What the legends of a picture say."""
    page: Any = ax.figure
    legends = [*page.legends, ax.get_legend()]
    texts = [text for legend in legends if legend for text in legend.get_texts()]
    return {text.get_text().replace("\n", " ") for text in texts}


def test_steady_sliding_stands_on_a_strip_below_all_angles() -> None:
    """It stood on the axis of angles, at the lowest of which it was read."""
    study = study_of("event", SETTLED, PHASES_AT["event"])
    ax, *_ = drawn("bifurcation", study, x="Omega").axes
    line = line_called(ax, "steady sliding")
    assert line.get_xdata().tolist() == [SLIDES]
    [strip] = ax.patches
    assert strip.get_y() < line.get_ydata()[0] < strip.get_y() + strip.get_height()
    low, high = ax.get_ylim()
    lowest = 1e3 * float(study["psi"].min())
    assert strip.get_height() < (lowest - low) / (high - low), "no angle lies on the strip"
    assert min(ax.get_yticks()) > low + strip.get_height() * (high - low)


def test_steady_sliding_is_no_motion_that_is_not_shown_to_repeat(study: xr.Dataset) -> None:
    """Of samples once a turn it was marked as such; at events it was left out."""
    _, ax, *_ = drawn("bifurcation", study, x="Omega").axes
    assert line_called(ax, "steady sliding").get_xdata().tolist() == [SLIDES]
    assert line_called(ax, "not shown to repeat").get_xdata().tolist() == [11.0]


def test_a_curve_and_a_sweep_say_so_of_periods_above_the_panel(study: xr.Dataset) -> None:
    """A curve joined zeros by a line."""
    curve, *_ = drawn("curve", study, x="Omega", variable="period_events").axes
    for ax in (curve, dm.plot_sweep(study, "period_events")):
        assert marked(ax, "steady sliding") == [SLIDES]
        assert marked(ax, "not shown to repeat") == [11.0]


def test_a_sweep_says_so_of_angles_at_events() -> None:
    ax = dm.plot_sweep(study_of("event", SETTLED, PHASES_AT["event"]), "psi")
    assert marked(ax, "steady sliding") == [SLIDES]
    assert SLIDES not in marked(ax, "kind of motion")
    assert len(rows_above(ax)) == 2


NONE_SETTLED = ["undecided", "changing", "settled", "undecided"]


def test_marks_of_motions_that_had_not_settled_name_their_event() -> None:
    """All were one ring of no event."""
    study = study_of("event", NONE_SETTLED, PHASES_AT["event"])
    figure, *_ = drawn("bifurcation", study, x="Omega").axes
    for ax in (figure, dm.plot_sweep(study, "psi")):
        released = line_called(ax, "at release of stick, not settled")
        lost = line_called(ax, "at loss of contact, not settled")
        assert {*released.get_xdata()} == {8.0}
        assert {*lost.get_xdata()} == {9.0, 11.0}
        assert released.get_marker() != lost.get_marker()
        assert {released.get_label(), lost.get_label()} <= entries(ax)


def test_a_single_motion_names_its_event_along_the_axis() -> None:
    """The axis of numbers said nothing of which event they count."""
    study = study_of("event", SETTLED, PHASES_AT["event"])
    words = {8.0: "at release of stick", 9.0: "at loss of contact"}
    for speed, name in words.items():
        ax = dm.plot_sweep(study.sel(Omega=speed), "psi", ax=pyplot.figure().add_subplot())
        assert name in ax.get_ylabel().replace("\n", " ")
