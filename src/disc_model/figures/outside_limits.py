"""Lines of which the limits of an axis, as a file states them, leave nothing to be seen."""

import re
from collections.abc import Sequence

import numpy as np
from matplotlib.lines import Line2D

from disc_model.figures.drawing import is_in_data
from disc_model.figures.types import Axes
from disc_model.figures.words import in_lines

WITHIN_VALUE = re.compile(r" (?==)|(?<==) |(?<=\d) (?=\S{1,5}$)")
"""Spaces of a name at which no line ends: a value stays with its name and unit."""
ALL = "all values"  # of a single line, which has no name


def note_outside(axes: Sequence[Axes], limits: tuple[float, float]) -> bool:
    """Say in the legend which lines of some panels lie outside the limits of their vertical axis in all
    of them, instead of naming these lines there. Returns whether any do."""
    shown: set[str] = set()
    hidden: dict[str, list[Line2D]] = {}
    for ax in axes:
        for line in _lines_with_values(ax):
            name = str(line.get_label())
            if _is_seen(line, limits):
                shown.add(name)
            else:
                hidden.setdefault(name, []).append(line)
    outside = [name for name in hidden if name not in shown and not name.startswith("_")]
    nothing_is_seen = bool(hidden) and not shown
    if not (outside or nothing_is_seen):
        return False
    for name in outside:
        for line in hidden[name]:
            line.set_label("_nolegend_")
    unbroken = [WITHIN_VALUE.sub("\u00a0", name) for name in outside]
    text = in_lines(f"outside the limits: {', '.join(unbroken) or ALL}")
    axes[0].plot([], [], linestyle="", label=text.replace("\u00a0", " "))
    return True


def _lines_with_values(ax: Axes) -> list[Line2D]:
    """The lines of a panel that have a value along both of its axes."""
    lines = [line for line in ax.lines if is_in_data(ax, line)]
    return [line for line in lines if np.isfinite(_heights(line)).any()]


def _is_seen(line: Line2D, limits: tuple[float, float]) -> bool:
    """Whether a line has a value within limits, or crosses them from one point to the next."""
    low, high = limits
    heights = _heights(line)
    inside = (heights >= low) & (heights <= high)
    crosses = (heights[:-1] < low) & (heights[1:] > high)
    crosses |= (heights[:-1] > high) & (heights[1:] < low)
    joined = line.get_linestyle() not in ("None", "", " ")
    return bool(inside.any() or (joined and crosses.any()))


def _heights(line: Line2D) -> np.ndarray:
    return np.asarray(line.get_ydata(), dtype=float)
