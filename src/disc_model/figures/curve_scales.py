"""Scales, ticks and labels of axes on which lines of a variable are drawn."""

from collections.abc import Sequence
from itertools import pairwise
from textwrap import fill
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.ticker import AutoLocator, NullLocator

from disc_model.figures.cells import scale_along
from disc_model.figures.class_axis import name_classes, words_along
from disc_model.figures.curve_marks import measured_along, set_margins
from disc_model.figures.drawing import is_in_data, plain_decades
from disc_model.figures.rate_scale import scale_heights
from disc_model.figures.types import Array, Axes
from disc_model.figures.words import are_counts, label_in

LINE = 1.1  # height of a line of text over its size
CHARACTER = 0.6  # mean width of a character over its size
MOST_LINES = 4  # of words along a horizontal axis


def set_scales(
    ax: Axes, study: xr.Dataset, names: Sequence[str], array: xr.DataArray, x: str, log: bool
) -> None:
    """Set the scales, ticks and labels of axes with lines of a variable.

    names, array : of its classes, and its heights, as `heights_of` gives them
    """
    variable = str(array.name)
    label, along = measured_along(array[x])
    _forget_empty(ax)
    shows = _shows_numbers(ax)
    scale_heights(ax, array, log)
    _scale_across(ax, array[x], along)
    ax.set_xlabel(label)
    ax.set_ylabel(label_in(study, variable))
    _set_ticks(ax, names, shows, whole=are_counts(study[variable]))
    set_margins(ax)


def _scale_across(ax: Axes, values: xr.DataArray, along: Array) -> None:
    """Scale the horizontal axis for the values along it, or turn the words there."""
    if along.dtype.kind == "U":
        _turn_words(ax, words_along(ax, along.astype(str).tolist()))
        return
    ax.set_xscale(scale_along(values))
    if are_counts(values):
        number_whole(ax.xaxis)
    if ax.get_xscale() == "log":
        plain_decades(ax.xaxis)


def _turn_words(ax: Axes, words: Sequence[str]) -> None:
    """Break words along the horizontal axis into lines if they have no room beside each other, turn them
    if that is not enough, and write only some of them if they have none then, either."""
    page: Any = ax.get_figure(root=True)
    label: Any = ax.xaxis.get_major_ticks()[0].label1
    # over the size of the words, which on a reader's own axes is larger
    room = page.get_figwidth() * ax.get_position().width * 72 / label.get_fontsize()
    if CHARACTER * len(words) * _widest_pair(words) <= room:
        return
    length = int(room / (CHARACTER * len(words))) - 1
    broken = [fill(word, max(length, 1), break_long_words=False) for word in words]
    if all(_fits(text, length) for text in broken):
        ax.set_xticks(range(len(words)), labels=broken)
        return
    ax.tick_params(axis="x", labelrotation=90)
    every = int(np.ceil(LINE * len(words) / room))
    ax.set_xticks(range(0, len(words), every), labels=words[::every])


def _fits(text: str, length: int) -> bool:
    """Whether a text in lines has few of them, none of them longer than a number of characters."""
    lines = text.splitlines()
    return len(lines) <= MOST_LINES and max(map(len, lines), default=0) <= length


def _widest_pair(words: Sequence[str]) -> float:
    """The largest distance that the middles of neighbours need, in characters, with half of one between
    them; 0 of a single word."""
    pairs = pairwise(words)
    return max((0.5 * (len(left) + len(right) + 1) for left, right in pairs), default=0.0)


class NoNumbers(NullLocator):
    """No ticks of an axis along which nothing has a value yet."""


def _forget_empty(ax: Axes) -> None:
    """Let an axis have numbers again on which no line had a value."""
    if isinstance(ax.yaxis.get_major_locator(), NoNumbers):
        ax.set_yscale("linear")
        ax.relim()


def _shows_numbers(ax: Axes) -> bool:
    """Whether anything has a value along the vertical axis, also in other panels that share it."""
    for each in ax.get_shared_y_axes().get_siblings(ax):
        in_panel = [patch for patch in each.patches if patch.get_clip_on()]  # no strip above it
        if in_panel or each.collections:
            return True
        for line in each.lines:
            if is_in_data(each, line) and np.isfinite(line.get_ydata()).any():
                return True
    return False


def _set_ticks(ax: Axes, names: Sequence[str], shows: bool, whole: bool) -> None:
    """Write the names of classes along the vertical axis, if there are any; whole numbers beside
    counts; nothing where no point of any line has a value, as numbers would be made up."""
    axis: Any = ax.yaxis
    if names:
        name_classes(ax, names)
    elif not shows:
        axis.set_major_locator(NoNumbers())
        axis.set_minor_locator(NullLocator())
    elif whole:
        number_whole(axis)


def number_whole(axis: Any) -> None:
    """Write whole numbers only along an axis of counts."""
    if isinstance(axis.get_major_locator(), AutoLocator):
        axis.get_major_locator().set_params(integer=True, min_n_ticks=1)
