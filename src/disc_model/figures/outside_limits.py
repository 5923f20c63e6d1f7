"""Lines of which the limits of an axis, as a file states them, leave nothing to be seen."""

from collections.abc import Sequence
from textwrap import fill

import numpy as np
from matplotlib.lines import Line2D

from disc_model.figures.drawing import is_in_data
from disc_model.figures.types import Axes
from disc_model.figures.value_texts import LONGEST_NAME

ALL = "all values"  # of a single line, which has no name
NOTE = "outside the limits"
"""What matplotlib calls the entry of a legend that says it."""


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
    unbroken = [name.replace(" ", "\u00a0") for name in outside]  # a value stays with its unit
    words = f"outside the limits: {', '.join(unbroken) or ALL}"
    text = fill(words, LONGEST_NAME, break_long_words=False, break_on_hyphens=False)
    axes[0].plot([], [], linestyle="", label=text.replace("\u00a0", " "), gid=NOTE)
    return True


def remove_note(ax: Axes) -> None:
    """Remove what a legend says of lines outside the limits of an axis, before further lines are drawn
    there."""
    for note in _notes_on(ax):
        note.remove()


def words_of_note(ax: Axes) -> list[str]:
    """What a legend says of lines outside the limits of an axis, in one line; none if it says nothing."""
    return [str(note.get_label()).replace("\n", " ") for note in _notes_on(ax)]


def _notes_on(ax: Axes) -> list[Line2D]:
    """The entries of a legend that say what is outside the limits of an axis."""
    return [line for line in ax.lines if line.get_gid() == NOTE]


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
