"""Colours that tell which of two axes on the same place, as of ``ax.twinx()``, a line belongs to."""

from collections.abc import Sequence
from typing import Any

from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex
from matplotlib.lines import Line2D

from disc_model.figures.covered import twins_of
from disc_model.figures.drawing import INDIGO, is_in_data
from disc_model.figures.types import Artist, Axes

SECOND = INDIGO
"""Of a line whose own colour the other axes have."""


def tell_axes_apart(ax: Axes, own: Sequence[Artist], other: Axes, former: Sequence[Artist]) -> None:
    """Give the labels and numbers of heights of two axes on the same place the colours of their lines,
    the second of which has another one where both would be alike.

    own, former : what was drawn on the axes, and on the other ones before
    """
    lines = _in_data(ax, own)
    before = _in_data(other, former)
    if not lines or not before:
        return
    taken = _colour_of(before[0])
    if _colour_of(lines[0]) == taken:
        for line in lines:
            line.set_color(SECOND)
    _colour_axis(other, taken)
    _colour_axis(ax, _colour_of(lines[0]))


def shown_beside(ax: Axes) -> list[Axes]:
    """Other axes on the same place with heights of their own."""
    shared = ax.get_shared_y_axes()
    return [each for each in twins_of(ax) if not shared.joined(ax, each)]


def _in_data(ax: Axes, drawn: Sequence[Artist]) -> list[Any]:
    """The lines and bands that are drawn in the units of both axes."""
    kinds = (Line2D, PolyCollection)
    return [each for each in drawn if isinstance(each, kinds) and is_in_data(ax, each)]


def _colour_of(drawn: Any) -> str:
    """The colour of a line or a band."""
    if isinstance(drawn, PolyCollection):
        faces: Any = drawn.get_facecolor()
        return str(to_hex(faces[0]))
    return str(to_hex(drawn.get_color()))


def _colour_axis(ax: Axes, colour: str) -> None:
    """Give the label and the numbers of heights a colour."""
    ax.yaxis.label.set_color(colour)
    ax.tick_params(axis="y", which="both", colors=colour)
