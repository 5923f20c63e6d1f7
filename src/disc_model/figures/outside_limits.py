"""Lines of which the limits of an axis, as a file or a reader states them, leave nothing to be seen, or a
part."""

from collections.abc import Sequence
from textwrap import fill

import numpy as np
from matplotlib.lines import Line2D

from disc_model.figures import legend_samples
from disc_model.figures.drawing import is_in_data, mark
from disc_model.figures.types import Array, Axes
from disc_model.figures.value_texts import LONGEST_NAME

ALL = "all values"  # of a single line, which has no name
NOTE = f"{legend_samples.NOTE}: outside the limits"
"""What matplotlib calls the entry of a legend that says it, and marks where lines go on outside."""
ARROW = 3.5
"""Size of such a mark, points."""


def note_outside(axes: Sequence[Axes], limits: tuple[float, float]) -> bool:
    """Say in the legend which lines of some panels lie outside the limits of their vertical axis in all
    of them, instead of naming these lines there. Returns whether any do. Arrows at the edge show where
    others go on outside."""
    shown: set[str] = set()
    hidden: dict[str, list[Line2D]] = {}
    for ax in axes:
        for line in _lines_with_values(ax):
            name = str(line.get_label())
            if _is_seen(line, limits):
                shown.add(name)
                _mark_cuts(ax, line, limits)
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
    labels = [str(note.get_label()).replace("\n", " ") for note in _notes_on(ax)]
    return [label for label in labels if not label.startswith("_")]


def _notes_on(ax: Axes) -> list[Line2D]:
    """The entries of a legend that say what is outside the limits of an axis, and the arrows there."""
    return [line for line in ax.lines if line.get_gid() == NOTE]


def _lines_with_values(ax: Axes) -> list[Line2D]:
    """The lines of a panel that have a value along both of its axes."""
    lines = [line for line in ax.lines if is_in_data(ax, line) and line.get_gid() != NOTE]
    return [line for line in lines if np.isfinite(_heights(line)).any()]


def _is_seen(line: Line2D, limits: tuple[float, float]) -> bool:
    """Whether a line has a value within limits, or crosses them from one point to the next."""
    low, high = limits
    heights = _heights(line)
    inside = (heights >= low) & (heights <= high)
    crosses = (heights[:-1] < low) & (heights[1:] > high)
    crosses |= (heights[:-1] > high) & (heights[1:] < low)
    return bool(inside.any() or (_is_joined(line) and crosses.any()))


def _is_joined(line: Line2D) -> bool:
    """Whether a line joins its points."""
    return line.get_linestyle() not in ("None", "", " ")


def _mark_cuts(ax: Axes, line: Line2D, limits: tuple[float, float]) -> None:
    """Draw arrows at the edges of a panel where a line goes on outside, or where points lie there that no
    line joins."""
    for end, marker in zip(limits, ("v", "^"), strict=True):
        is_upper = marker == "^"
        places = _places_beyond(ax, line, end, is_upper)
        if not places.size:  # an unclipped line without a point has an extent at the page's corner
            continue
        ax.plot(
            places,
            np.full(places.size, end),
            linestyle="",
            marker=marker,
            color=line.get_color(),
            markersize=mark(ARROW),
            clip_on=False,
            label="_nolegend_",
            gid=NOTE,
            scalex=False,
            scaley=False,
        )


def _places_beyond(ax: Axes, line: Line2D, end: float, is_upper: bool) -> Array:
    """Where along the axis a line crosses an end of the limits, or its points lie beyond it."""
    x = np.asarray(line.get_xdata(), dtype=float)
    heights = _heights(line)
    beyond = heights > end if is_upper else heights < end
    if not _is_joined(line):
        return x[beyond]
    known = np.isfinite(heights)
    joined = np.zeros(known.size, dtype=bool)
    joined[1:] |= known[:-1]
    joined[:-1] |= known[1:]
    alone = x[beyond & ~joined]
    crosses = (beyond[:-1] != beyond[1:]) & known[:-1] & known[1:]
    across = ax.xaxis.get_transform()
    upward = ax.yaxis.get_transform()
    x = across.transform(x)
    heights = upward.transform(heights)
    [before] = np.nonzero(crosses)
    after = before + 1
    way = upward.transform(np.array([end])) - heights[before]
    share = way / (heights[after] - heights[before])
    found = x[before] + share * (x[after] - x[before])
    return np.append(across.inverted().transform(found), alone)


def _heights(line: Line2D) -> np.ndarray:
    return np.asarray(line.get_ydata(), dtype=float)
