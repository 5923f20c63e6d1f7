"""Labels and titles that are no longer than their axes."""

import math
import re
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

BEYOND = 1.15  # length of a label over that of its axis, at most
MARKUP = re.compile(r"\\\w+|[${}_^]")  # of mathematical text; a symbol for a command


def break_labels(figure: Figure, axes: Sequence[Axes] | None = None) -> None:
    """Break labels and titles of axes, all those of a figure unless some are given, into lines where
    they are longer than the axes."""
    figure.draw_without_rendering()  # sets the sizes
    for ax in figure.axes if axes is None else axes:
        box = ax.get_window_extent()
        _break(ax.xaxis.label, "width", BEYOND * box.width)
        _break(ax.yaxis.label, "height", BEYOND * box.height)
        for title in titles_of(ax):
            _break(title, "width", box.width)


def titles_of(ax: Axes) -> list[Text]:
    """The titles of axes, that have a text, at the left, in the middle and at the right."""
    texts = {ax.get_title(loc) for loc in ("left", "center", "right")} - {""}
    return [
        child
        for child in ax.get_children()
        if isinstance(child, Text) and child not in ax.texts and child.get_text() in texts
    ]


def _break(label: Any, direction: str, room: float) -> None:
    """Break a label into as few lines as fit a room in pixels."""
    text = label.get_text()
    length = getattr(label.get_window_extent(), direction)
    if not text.strip() or length <= room or "\n" in text:
        return
    for count in range(math.ceil(length / room), len(text.split(" ")) + 1):
        label.set_text(in_lines(text, count))
        if getattr(label.get_window_extent(), direction) <= room:
            return


def in_lines(text: str, count: int) -> str:
    """The text in at most so many lines of about equal length, as it is seen."""
    words = text.split(" ")
    share = sum(map(seen, words)) / count
    lines = [""]
    length = 0.0
    for word in words:
        # a word goes to the line in which its middle lies
        if lines[-1] and length + seen(word) / 2 > share * len(lines) and len(lines) < count:
            lines.append(word)
        else:
            lines[-1] = f"{lines[-1]} {word}".strip()
        length += seen(word)
    return "\n".join(lines)


def seen(word: str) -> int:
    """Number of characters of a word that are seen, and the blank after it."""
    return len(MARKUP.sub(lambda found: "x" if found[0].startswith("\\") else "", word)) + 1
