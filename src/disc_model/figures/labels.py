"""Labels of axes that are no longer than their axes."""

import math
import re
from typing import Any

from matplotlib.figure import Figure

BEYOND = 1.15  # length of a label over that of its axis, at most
MARKUP = re.compile(r"\\\w+|[${}_^]")  # of mathematical text; a symbol for a command


def break_labels(figure: Figure) -> None:
    """Break labels of axes into lines where they are longer than their axes."""
    figure.draw_without_rendering()  # sets the sizes
    for ax in figure.axes:
        box = ax.get_window_extent()
        _break(ax.xaxis.label, "width", BEYOND * box.width)
        _break(ax.yaxis.label, "height", BEYOND * box.height)


def _break(label: Any, direction: str, room: float) -> None:
    """Break a label into as few lines as fit a room in pixels."""
    text = label.get_text()
    length = getattr(label.get_window_extent(), direction)
    if not text.strip() or length <= room or "\n" in text:
        return
    for count in range(math.ceil(length / room), len(text.split()) + 1):
        label.set_text(in_lines(text, count))
        if getattr(label.get_window_extent(), direction) <= room:
            return


def in_lines(text: str, count: int) -> str:
    """The text in at most so many lines of about equal length, as it is seen."""
    words = text.split(" ")
    share = sum(map(seen, words)) / count
    lines, length = [""], 0.0
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
