"""Samples of lines in a legend show what tells these apart."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.legend import Legend

from disc_model.figures.family import LOOKS
from disc_model.figures.legends import (
    figure_legend,
    legend_above,
    legend_below,
    legend_inside,
    small,
)


def dashed_lines() -> Axes:
    """Three lines with marks, which differ in their dashes."""
    _, ax = pyplot.subplots(layout="constrained")
    for shift, look in enumerate(LOOKS[:3]):
        style = look.line(0.7)
        style["color"] = "C0"
        ax.plot([0, 1], [shift, shift], marker="o", markersize=3, **style)
    ax.set_ylim(-1, 9)
    return ax


def assert_dashes_are_seen(legend: Legend) -> None:
    """Each sample has its marks at its ends, and a period of its dashes between these."""
    samples = legend.get_lines()
    assert len(samples) == 3
    for sample in samples:
        _, dashes = sample._dash_pattern
        length = np.ptp(sample.get_xdata())
        between_marks = length - sample.get_markersize()
        assert sample.get_markevery() is None, "marks are at the ends"
        assert between_marks >= sum(dashes or ())


@pytest.mark.parametrize("draw", [legend_inside, legend_below, legend_above])
@pytest.mark.parametrize("look", [{}, small()])
def test_samples_show_dashes_between_marks(
    draw: Callable[..., Legend], look: dict[str, Any]
) -> None:
    """A mark in the middle covered the gap, and the samples of all sweeps looked the same."""
    ax = dashed_lines()
    handles = [*ax.lines]
    legend = draw(ax, handles, **look)
    assert_dashes_are_seen(legend)


def test_samples_of_a_figure_show_dashes_between_marks() -> None:
    ax = dashed_lines()
    handles = [*ax.lines]
    legend = figure_legend(ax.figure, handles)
    assert_dashes_are_seen(legend)


def test_samples_of_lines_that_marks_tell_apart_keep_their_length() -> None:
    _, ax = pyplot.subplots()
    ax.plot([0, 1], [0, 1], marker="o", label="whole")
    ax.plot([0, 1], [1, 0], "--", marker="s", label="of another colour and mark")
    legend = legend_inside(ax)
    assert legend.handlelength == 2
