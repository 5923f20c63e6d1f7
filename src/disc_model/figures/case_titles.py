"""The values of a case above a reader's axes."""

import re
from textwrap import fill
from typing import Any
from weakref import WeakKeyDictionary

from matplotlib.text import Text

from disc_model.figures.drawing import large
from disc_model.figures.head_texts import CHARACTER, head_text
from disc_model.figures.labels import titles_of
from disc_model.figures.symbols import in_a_row
from disc_model.figures.types import Axes

MOST_LINES = 3  # of values of a case above a picture
SIZE = 8.0  # points
FEW_LINES = 2  # above a reader's axes, more than which are in smaller letters
SMALLER = 0.75  # of the usual size,
LEAST_SIZE = 6.0  # and their least size, points

DISC_WITH_RANGE = re.compile(r"a disc given by (?P<modes>\d+ modes?) of [^,]+")
"""What titles say of a disc that is given by its modes, with the range of their frequencies."""

_WRITTEN: WeakKeyDictionary[Axes, str] = WeakKeyDictionary()
"""What was written above axes, in one line."""


def title_text(width: float, said: str, asked: str | bool | None = None) -> str:
    """The values of a case, or else a title that a reader asks for, in lines that fit a width in inches."""
    title = asked if isinstance(asked, str) else ""
    return head_text(width, title, _with_short_disc(said, width), MOST_LINES)


def _with_short_disc(said: str, width: float) -> str:
    """The values of a case, in which a disc given by its modes is called as in legends if all that is said of
    it is longer than a line of a width in inches."""
    disc = DISC_WITH_RANGE.search(said)
    if disc is None or len(disc[0]) <= width / CHARACTER:
        return said
    return said.replace(disc[0], f"disc of {disc['modes']}")


def write_case(ax: Axes, said: str, note: str = "") -> None:
    """Write the values of a case above axes, in lines that fit their width, and a note below them; in smaller
    letters where they would be many lines."""
    size = large(SIZE)
    text = _case_text(ax, said, note, size)
    if text.count("\n") >= FEW_LINES:
        size = min(size, max(SMALLER * size, LEAST_SIZE))
        text = _case_text(ax, said, note, size)
    ax.set_title(text, loc="left", fontsize=size)
    _WRITTEN[ax] = in_a_row(ax.get_title(loc="left"))


def _case_text(ax: Axes, said: str, note: str, size: float) -> str:
    """The values of a case, and a note, in lines of letters of a size in points that fit the width of axes."""
    figure: Any = ax.get_figure(root=True)
    width = ax.get_window_extent().width / figure.dpi * SIZE / size
    lines = [title_text(width, said)]
    if note != said:
        lines.append(head_text(width, note, ""))
    return _narrowed("\n".join(filter(None, lines)), width)


def _narrowed(text: str, width: float) -> str:
    """A text whose lines of words are broken to fit a width in inches; a value stays with its name."""
    length = max(round(width / CHARACTER), 1)
    lines = []
    for line in text.splitlines():
        if "=" not in line:
            line = fill(line, length, break_long_words=False, break_on_hyphens=False)
        lines.append(line)
    return "\n".join(lines)


def rewrite_case(ax: Axes, said: str) -> None:
    """Write other values above axes, if those of a case stand there."""
    if case_above(ax):
        write_case(ax, said)


def case_above(ax: Axes) -> list[Text]:
    """The title of axes, if it has the values of a case; none if its reader has set another since."""
    title = ax.get_title(loc="left")
    if not title or in_a_row(title) != _WRITTEN.get(ax):
        return []
    return [text for text in titles_of(ax) if text.get_text() == title]
