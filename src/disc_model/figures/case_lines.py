"""How a case is drawn beside others in one panel: the look that sets it apart, and its lines."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from disc_model.figures.branch_lines import Look
from disc_model.figures.drawing import mark, wide
from disc_model.figures.family import LOOKS
from disc_model.figures.still_motions import ends_shown
from disc_model.figures.types import Array, Artist, Axes

MARKERS = "osD^vP"
THIN = 0.6
"""Width of the first of whole lines that lie on each other, points."""
WIDEST = 3.8
"""And of the last one, if its edge shows beside the others then."""
EDGES = (0.7, 1.2)
"""Least and greatest difference of the widths of one such line and the next, points."""
Limits = tuple[tuple[float, float], tuple[float, float]]
"""Of the horizontal and of the vertical axis."""


class Style(NamedTuple):
    """What sets a case apart from others, by its place in their order: colour and dashes of a line, or
    colour and shape of marks.

    cases : how many there are
    from_end : whether time is counted from the end of each, and is negative
    """

    place: int
    cases: int = 1
    from_end: bool = False

    @property
    def look(self) -> Look:
        """Colour and dashes."""
        return LOOKS[self.place % len(LOOKS)]

    @property
    def edge(self) -> float:
        """By how much each whole line is wider than the one before, points."""
        least, greatest = EDGES
        alike = (WIDEST - THIN) / max(self.cases - 1, 1)
        return max(least, min(greatest, alike))

    def layered(self) -> dict[str, Any]:
        """Options of a whole line that is wider than the one before, and below it: dashes of lines
        that go to and fro, or around, would fill their own gaps."""
        return {
            "color": self.look.colour,
            "linewidth": wide(THIN + self.place * self.edge),
            "zorder": 2 - 0.01 * self.place,
            "solid_capstyle": "butt",  # a wide sample of a legend would reach its name
        }

    def marks(self, points: float) -> dict[str, Any]:
        """Options of open marks of a size in points: those below others show."""
        return {
            "linestyle": "",
            "marker": MARKERS[self.place % len(MARKERS)],
            "color": self.look.colour,
            "markerfacecolor": "none",
            "markersize": mark(points),
        }


class Lines(NamedTuple):
    """How a case is drawn beside others in one panel.

    draw : draws it on axes in a style; returns its entry of a legend, which has no label yet
    limits : of the axes that show it
    what : the name of what is drawn, if axes can show several in one unit
    stretch : begin and end of the samples in time, s; None of what is not sampled over time, or whole
    """

    draw: Callable[[Axes, Style], Artist]
    limits: Limits
    what: str = ""
    stretch: tuple[float, float] | None = None


def limits_of_motion(values: Array, share: float, size: float) -> tuple[float, float]:
    """Limits of a variable of a motion, which show one that stands still in comparison with a size as
    a flat line."""
    return limits_of(np.array(ends_shown(values, size)), share)


def limits_of(values: Array, share: float) -> tuple[float, float]:
    """Limits that leave a share of the values' range free on both sides."""
    low = float(np.nanmin(values))
    high = float(np.nanmax(values))
    room = share * (high - low) or 1e-6 * max(abs(high), 1e-6)
    return low - room, high + room


def limits_around(several: Sequence[Limits]) -> Limits:
    """Limits of both axes that hold all of several."""
    across, up = np.array(several).transpose(1, 0, 2)
    return (across.min(), across.max()), (up.min(), up.max())
