"""Legends below the panels of a reader: in their middle, where there is room."""

import pytest
from matplotlib import pyplot
from matplotlib.lines import Line2D

from disc_model.figures.legends import legend_below


def test_legends_of_panels_below_each_other_are_below_their_middles() -> None:
    """They began further to the left than their panels, each by another length."""
    figure, axes = pyplot.subplots(3, 1, figsize=(4.5, 8))
    figure.subplots_adjust(right=0.8)
    for ax, loads in zip(axes, ([300.0], [300.0, 350.0], [300.0, 350.0, 400.0]), strict=True):
        handles = [Line2D([], [], label=f"N = {load:g} N") for load in loads]
        legend_below(ax, handles)
    figure.draw_without_rendering()
    for ax in axes:
        box = ax.get_legend().get_window_extent()
        assert 0.5 * (box.x0 + box.x1) == pytest.approx(0.5 * (ax.bbox.x0 + ax.bbox.x1), abs=1)


def test_a_legend_that_is_nearly_as_wide_as_the_page_stays_on_it() -> None:
    figure, ax = pyplot.subplots(figsize=(3.31, 3))
    legend_below(ax, [Line2D([], [], label="a rather long name of a line in a figure")])
    figure.draw_without_rendering()
    box = ax.get_legend().get_window_extent()
    assert box.x0 >= 0
    assert box.x1 <= figure.bbox.width
