"""Bifurcation diagrams say what kind of motion each of their columns of points is of."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import same_color
from matplotlib.lines import Line2D

import disc_model as dm
from disc_model.analysis.classify import ANSWER
from disc_model.data.variables import LONG_TERM_OUTCOMES, PHASES
from disc_model.figures.bifurcation_samples import RINGS, UNDECIDED
from disc_model.figures.gap_rows import rows_above
from disc_model.figures.kind_rows import FILLS, SAMPLES, SHAPES, WORDS
from tests.figures.described import drawn, status
from tests.figures.every_kind import column, flag, over, stated
from tests.figures.reading import labels, small_axes

SPEEDS = np.array([8.0, 9.0, 10.0])
KINDS = ["quiet", "separating", "undecided"]


def study_of(section: str) -> xr.Dataset:
    """Two samples of each of three motions."""
    angles = np.array([[0.031, 0.032], [0.028, 0.04], [0.03, 0.035]])
    phases = [["stick"] * 2, ["separation"] * 2, ["stick"] * 2]
    data = {
        "psi": (("Omega", "sample"), angles, column("bifurcation", "psi")),
        "phase": flag(("Omega", "sample"), phases, ("none", *PHASES)),
        "settled": flag(("Omega",), ["settled"] * 3, ANSWER.flags),
        "kind": flag(("Omega",), KINDS, LONG_TERM_OUTCOMES),
        "period_events": ("Omega", [1, 2, 0], column("bifurcation", "period_events")),
        "status": status(("Omega",), ["ok"] * 3),
    }
    words = {**stated(section=section), "quantity": "bifurcation"}
    return xr.Dataset(data, over(Omega=SPEEDS, sample=np.arange(2)), words)


@pytest.mark.parametrize(("section", "words"), [("stroboscopic", FILLS), ("event", WORDS)])
def test_a_sweep_has_a_row_for_each_kind_which_the_legend_names(section: str, words: str) -> None:
    """A stable cycle filled an interval once a turn, and looked like chaos."""
    ax = dm.plot_sweep(study_of(section), "psi")
    [strip] = rows_above(ax)
    assert strip.words.get_text().replace("\n", " ") == words
    places = [list(row.get_xdata()) for row in strip.rows]
    assert places == [[8.0], [9.0], [10.0]]
    assert {*KINDS} <= {*labels(ax.figure)}


def test_only_cycles_fill_intervals() -> None:
    study = study_of("stroboscopic")
    ax = dm.plot_sweep(study.isel(Omega=[2, 2]).assign_coords(Omega=[10.0, 11.0]), "psi")
    [strip] = rows_above(ax)
    assert strip.words.get_text().replace("\n", " ") == WORDS


def test_a_figure_of_a_study_has_the_same_rows() -> None:
    ax = drawn("bifurcation", study_of("stroboscopic"), x="Omega").axes[0]
    marks = {line.get_label(): line for line in ax.lines}
    for kind, speed in zip(KINDS, SPEEDS, strict=True):
        assert marks[kind].get_marker() == SHAPES[kind]
        assert list(marks[kind].get_xdata()) == [speed]
    title = ax.get_legend().get_title().get_text()
    assert FILLS in title.replace("\n", " ")


def test_two_sweeps_have_rows_of_their_colours_on_one_strip() -> None:
    ax = dm.plot_sweep(study_of("stroboscopic"), "psi", labels={"case": "one"})
    other = study_of("stroboscopic").isel(Omega=[0, 1])
    dm.plot_sweep(other, "psi", ax=ax, labels={"case": "two"})
    [strip] = rows_above(ax)
    colours = [row.get_color() for row in strip.rows]
    assert len(colours) == 5
    assert len({*colours[:3]}) == len({*colours[3:]}) == 1
    assert colours[0] != colours[3]


def test_releases_are_told_from_losses_of_contact_among_many_points() -> None:
    """Both were dots of a point and a half."""
    study = study_of("event")
    numbers = ("sample", np.arange(200), study["sample"].attrs)
    many = study.isel(sample=np.zeros(200, dtype=int)).assign_coords(sample=numbers)
    ax = dm.plot_sweep(many, "psi")
    marks = {line.get_label(): line for line in ax.lines}
    releases = marks["at release of stick"]
    losses = marks["at loss of contact"]
    assert (releases.get_marker(), losses.get_marker()) == ("4", "^")
    assert releases.get_markersize() > losses.get_markersize() + 1


# ---- Several sweeps at events


def three_sweeps_at_events() -> Axes:
    """Axes with samples at events of three sweeps that have the same values."""
    ax = small_axes()
    for case in ("one", "two", "three"):
        dm.plot_sweep(study_of("event"), "psi", ax=ax, labels={"case": case})
    return ax


def marks_at(ax: Axes, event: str) -> list[Line2D]:
    """The marks of samples at an event, of all sweeps in their order."""
    return [line for line in ax.lines if str(line.get_label()).startswith(event)]


def is_full(marks: Line2D) -> bool:
    """Whether the inside of marks has their colour."""
    return same_color(marks.get_markerfacecolor(), marks.get_color())


def test_full_marks_are_of_losses_of_contact_in_strip_and_panel() -> None:
    """In the panel they were of releases, and in the strip of motions that separate."""
    ax = three_sweeps_at_events()
    assert [is_full(marks) for marks in marks_at(ax, "at loss of contact")] == [True] * 3
    assert not any(is_full(marks) for marks in marks_at(ax, "at release of stick")[1:])
    [strip] = rows_above(ax)
    full = {row.get_marker() for row in strip.rows if is_full(row)}
    assert full == {SHAPES["separating"], SHAPES["undecided"]}


def test_samples_have_no_mark_of_a_kind_of_motion_nor_of_a_ring() -> None:
    """Squares of a second sweep stood in the panel and in the strip, and triangles of a third were rings."""
    panel = [*three_sweeps_at_events().lines]
    taken = {*SHAPES.values(), *RINGS.values(), UNDECIDED["marker"]}
    assert not {*SAMPLES} & taken
    named = [line for line in panel if str(line.get_label()).endswith(("two", "three"))]
    assert not {line.get_marker() for line in named} & taken
    assert len(SAMPLES) >= 3


@pytest.mark.parametrize("event", ["at loss of contact", "at release of stick"])
def test_samples_of_later_sweeps_are_larger_and_lie_below(event: str) -> None:
    """Squares of a second sweep hid the forks of the first."""
    marks = marks_at(three_sweeps_at_events(), event)
    sizes = [each.get_markersize() for each in marks]
    order = [each.get_zorder() for each in marks]
    assert sizes == sorted({*sizes})
    assert order == sorted({*order}, reverse=True)


def test_samples_once_a_turn_of_later_sweeps_are_thin_and_lie_below() -> None:
    """Bold triangles of a third sweep hid the dots of the first."""
    ax = small_axes()
    for case in ("one", "two", "three"):
        dm.plot_sweep(study_of("stroboscopic"), "psi", ax=ax, labels={"case": case})
    marks = [line for line in ax.lines if line.get_label() in ("one", "two", "three")]
    order = [each.get_zorder() for each in marks]
    assert len(order) == 3
    assert order == sorted({*order}, reverse=True)
    assert {each.get_markeredgewidth() < 1 for each in marks[1:]} == {True}
