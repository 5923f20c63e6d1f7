"""Words in figures stand clear of strips, of labels of other panels and of the end of the page."""

from itertools import pairwise

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.legend import Legend
from matplotlib.patches import Rectangle
from matplotlib.transforms import Bbox

from disc_model.figures.labels import break_labels
from disc_model.figures.legends import LEAST_CURVE, printed_width
from disc_model.figures.poincare import heading_of
from disc_model.figures.sizes import COLUMN
from tests.figures.described import bifurcation, curve, late_range


def heights_of_labels(axes: list[Axes]) -> list[Bbox]:
    """The extents of the labels of vertical axes, from above."""
    return [ax.yaxis.label.get_window_extent() for ax in axes if ax.get_ylabel()]


def test_the_name_of_a_case_stands_above_the_strip_of_a_bifurcation_diagram() -> None:
    """Marks of the strip covered "Fig. 13"."""
    figure = bifurcation()
    figure.draw_without_rendering()
    upper = figure.axes[0]
    [name] = [text for text in upper.texts if text.get_text() == "F11"]
    [strip] = [patch for patch in upper.patches if isinstance(patch, Rectangle)]
    assert name.get_window_extent().y0 >= strip.get_window_extent().y1


def test_legends_leave_the_samples_of_a_bifurcation_diagram_their_height() -> None:
    """Those above three panels of a column left 9 mm."""
    figure = bifurcation(width="column")
    figure.draw_without_rendering()
    assert figure.axes[0].bbox.height / figure.dpi >= 0.9 * LEAST_CURVE


def test_labels_of_panels_above_each_other_do_not_meet() -> None:
    """In a column each ran into the next, and the highest into the title."""
    figure = curve(log=True, panels="each", width="column")
    figure.draw_without_rendering()
    labels = heights_of_labels(figure.axes)
    assert len(labels) == 3
    for upper, lower in pairwise(labels):
        assert upper.y0 > lower.y1


@pytest.mark.parametrize("width", ["column", "page"])
def test_discs_below_each_other_have_numbers_each(width: str) -> None:
    """The lower of two panels had neither numbers nor a label."""
    figure = late_range(width)
    numbered = [bool(ax.get_ylabel()) for ax in figure.axes]
    assert numbered == [True, width == "column"]
    sides = [ax.yaxis.get_tick_params()["labelleft"] for ax in figure.axes]
    assert sides == numbered


def test_each_line_of_a_title_is_broken_where_axes_are_narrow() -> None:
    """The second line of a critical speed's note left the page."""
    figure, ax = pyplot.subplots(figsize=(COLUMN, 2.4), layout="constrained")
    first = "already unstable at the lower bound"
    second = "tongues narrower than 0.05 rad/s may be missed by this search"
    ax.set_title(f"{first}\n{second}", loc="left")
    break_labels(figure)
    figure.draw_without_rendering()
    said = ax.get_title(loc="left")
    assert " ".join(said.split()) == f"{first} {second}"
    [title] = [text for text in ax.get_children() if getattr(text, "get_text", str)() == said]
    assert title.get_window_extent().x1 <= figure.bbox.width


def test_a_heading_says_once_that_separation_is_ignored() -> None:
    """Figures said "Separation ignored, separation ignored"."""
    fate = "separation ignored"
    assert heading_of("Separation ignored, larger preload", fate).count("eparation") == 1
    assert heading_of("Ω = 15 rad/s", "no separation") == "Ω = 15 rad/s, no separation"
    assert heading_of("", fate) == fate


def legend_of(ax: Axes) -> Legend:
    """A legend of words whose width depends on the resolution."""
    for name in ("unstable near the static start", "cycles computed", "no cycle found"):
        ax.plot([0, 1], label=name)
    return ax.legend(ncols=3, fontsize=6)


def test_the_width_of_a_legend_is_that_of_a_saved_picture() -> None:
    """At 150 dots per inch it was wider than on the screen, and left the page."""
    figure, ax = pyplot.subplots(figsize=(COLUMN, 2.4), dpi=100)
    legend = legend_of(ax)
    shown = legend.get_window_extent().width
    assert printed_width(legend, 2 * shown) == shown
    found = printed_width(legend, 1.01 * shown)
    assert figure.dpi == 100
    saved = []
    for dpi in (150, 300):
        figure.set_dpi(dpi)
        saved.append(legend.get_window_extent().width / dpi * 100)
    assert np.isclose(found, max(shown, *saved))
    assert max(saved) > shown
