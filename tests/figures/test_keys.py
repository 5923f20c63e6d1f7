"""Samples of lines in a legend show what tells these apart."""

from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot

from disc_model.figures.family import LOOKS
from disc_model.figures.legends import (
    figure_legend,
    legend_above,
    legend_below,
    legend_inside,
    small,
)


@pytest.mark.parametrize("place", ["inside", "below", "above", "figure"])
@pytest.mark.parametrize("look", [{}, small()])
def test_samples_show_dashes_between_marks(place: str, look: dict[str, Any]) -> None:
    """A mark in the middle covered the gap, and the samples of all sweeps looked the same."""
    figure, ax = pyplot.subplots(layout="constrained")
    for shift, each in enumerate(LOOKS[:3]):
        line = {**each.line(0.7), "color": "C0"}
        ax.plot([0, 1], [shift, shift], marker="o", markersize=3, **line)
    ax.set_ylim(-1, 9)
    handles = [*ax.lines]
    draw: Any = {"inside": legend_inside, "below": legend_below, "above": legend_above}
    legend = draw[place](ax, handles, **look) if place in draw else figure_legend(figure, handles)
    for sample in legend.get_lines():
        _, dashes = sample._dash_pattern
        shown = np.ptp(sample.get_xdata()) - sample.get_markersize()
        assert sample.get_markevery() is None, "marks are at the ends"
        assert shown >= sum(dashes or ())
    pyplot.close(figure)


def test_samples_of_lines_that_marks_tell_apart_keep_their_length() -> None:
    figure, ax = pyplot.subplots()
    ax.plot([0, 1], [0, 1], marker="o", label="whole")
    ax.plot([0, 1], [1, 0], "--", marker="s", label="of another colour and mark")
    legend = legend_inside(ax)
    assert legend.handlelength == 2
    pyplot.close(figure)
