"""Labels and titles of axes: in lines that are no longer than these."""

import math
import re
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

from matplotlib.text import Text

from disc_model.figures.gap_rows import rows_above, stack_rows
from disc_model.figures.places import set_places
from disc_model.figures.symbols import seen, without_font
from disc_model.figures.types import Axes, Figure

BEYOND = 1.15  # length of a label over that of its axis, at most,
ROOM_BESIDE = 0.6  # or so many inches more beside panels that have none above or below,
SHARE_BESIDE = 0.5  # or this share of the height of the page,
SHARE_OF_ROW = 0.7  # and this share of that of a row, beside low panels
OF_PITCH = 0.95  # and at most this share of the distance of panels above each other
MOST_ABOVE = 2  # lines of words above a panel that are not left out after a colon
WHOLE = re.compile(
    r"(?<=\()[^()]{1,12}(?=\))| = (-?[\d.]+ (?=\S{1,5}(,|$)))?|(?<!\S)-?[\d.]+ (?=\S{1,5}(,|$))"
)
"""What stays on one line: a unit, and a value with its unit, and its name."""
COLOUR_BAR = "<colorbar>"  # what matplotlib calls the axes of one, above which a title may stand
HARD = "\ue000"  # stands for a blank at which no line ends


class Breakable(NamedTuple):
    """A text that may be broken, and along which side of its axes it stands.

    beyond : its length over that side, at most
    brief : whether what follows a colon may be left out
    """

    text: Text
    ax: Axes
    direction: str
    beyond: float
    brief: bool = False


class Broken(NamedTuple):
    """What a text says, and in which lines."""

    words: str
    lines: str


_BROKEN: WeakKeyDictionary[Text, Broken] = WeakKeyDictionary()
"""Texts that have been broken, which may need other lines when their axes have another size."""


def break_labels(figure: Figure, axes: Sequence[Axes] | None = None) -> None:
    """Break labels and titles of axes, all those of a figure unless some are given, into lines where
    they are longer than the axes; those that have been broken before, anew."""
    found = [each for ax in (figure.axes if axes is None else axes) for each in _texts_of(ax)]
    words = [words_of(each.text) for each in found]
    # the layout makes axes narrow under a long title, so that it is set with short ones
    for each in found:
        each.text.set_text("x")
    set_places(figure)  # sets the sizes
    beside = 0
    for each, said in zip(found, words, strict=True):
        if each.direction == "height":
            beside += _set_in_lines(figure, each, said)
    if beside:
        set_places(figure)  # axes are narrower beside labels of several lines
    for each, said in zip(found, words, strict=True):
        if each.direction == "width":
            _set_in_lines(figure, each, said)
    for ax in {each.ax: None for each in found}:
        stack_rows(ax)


def _set_in_lines(figure: Figure, label: Breakable, said: str) -> int:
    """Set a label to words, in as many lines as they need; returns how many there are beyond one."""
    room = _room(figure, label)
    label.text.set_text(said)
    _break(label.text, label.direction, room)
    if label.brief and label.text.get_text().count("\n") >= MOST_ABOVE:
        label.text.set_text(said.partition(":")[0])
        _break(label.text, label.direction, room)
    shown = label.text.get_text()
    _BROKEN[label.text] = Broken(said, shown)
    return shown.count("\n")


def words_of(text: Text) -> str:
    """The words of a text, as they were before it was broken, unless it has been replaced since."""
    shown = without_font(text.get_text())
    broken = _BROKEN.get(text)
    return broken.words if broken is not None and broken.lines == shown else shown


def _room(figure: Figure, label: Breakable) -> float:
    """Length in pixels that a text may have along its axes, of which it stands in the middle: not
    much beyond them, and not beyond the page."""
    box = label.ax.get_window_extent()
    page: Any = figure.get_figure(root=True)
    room = label.beyond * getattr(box, label.direction)
    if is_square(label.ax) and label.direction == "width" and label.beyond == 1.0:
        # its place may be wider than the panel
        slot = label.ax.get_position(original=True)
        room = max(room, slot.x1 * page.bbox.width - box.x0)
    if label.beyond == 1.0:
        return room
    i = ("width", "height").index(label.direction)
    place = label.ax.get_subplotspec()
    if i == 1 and place is not None:
        rows = place.get_topmost_subplotspec().get_gridspec().nrows
        share = SHARE_BESIDE if rows == 1 else SHARE_OF_ROW / rows
        room = max(room, share * page.bbox.height)
        if rows == 1:
            room = max(room, box.height + ROOM_BESIDE * page.dpi)
    middle = 0.5 * (box.min[i] + box.max[i])
    end = page.bbox.x1
    if label.direction == "height":
        end = _lowest_above(page, box)
        room = min(room, OF_PITCH * _pitch(label.ax))
    return min(room, 2 * min(middle, end - middle))


def _pitch(ax: Axes) -> float:
    """The distance in pixels from the middle of a panel to that of the next one above or below it, whose
    label stands at the same place across; infinite without one."""
    box = ax.get_window_extent()
    apart = [math.inf]
    for other in ax.figure.axes:
        place = other.get_window_extent()
        beside = place.x1 < box.x0 or place.x0 > box.x1
        level = place.y1 > box.y0 and place.y0 < box.y1
        if not beside and not level:
            apart.append(0.5 * abs(place.y0 + place.y1 - box.y0 - box.y1))
    return min(apart)


def _lowest_above(page: Any, box: Any) -> float:
    """The lower edge of a title of the page above the left end of a panel, in pixels, or that of the
    page without one."""
    titles = [text.get_window_extent() for text in page.texts if text.get_text()]
    above = [title.y0 for title in titles if title.x0 <= box.x0 and title.y0 >= box.y1]
    return float(min([page.bbox.y1, *above]))


def is_square(ax: Axes) -> bool:
    """Whether both axes have one scale, so that the panel does not fill a place of another shape."""
    return ax.get_aspect() != "auto"


def _texts_of(ax: Axes) -> Iterator[Breakable]:
    """Labels and titles of axes that say something."""
    for label, direction in ((ax.xaxis.label, "width"), (ax.yaxis.label, "height")):
        if label.get_text().strip():
            beyond = BEYOND
            if direction == "height" and ax.get_label() == COLOUR_BAR:
                beyond = 1.0
            yield Breakable(label, ax, direction, beyond)
    for title in titles_of(ax):
        yield Breakable(title, ax, "width", 1.0)
    for rows in rows_above(ax):
        yield Breakable(rows.words, ax, "width", 1.0, brief=True)


def titles_of(ax: Axes) -> list[Text]:
    """The titles of axes, that have a text, at the left, in the middle and at the right."""
    texts = {ax.get_title(loc) for loc in ("left", "center", "right")} - {""}
    return [
        child
        for child in ax.get_children()
        if isinstance(child, Text) and child not in ax.texts and child.get_text() in texts
    ]


def _break(label: Any, direction: str, room: float) -> None:
    """Break a label into as few lines as fit a room in pixels, or as its longest word leaves; each line of
    a title of several by itself."""
    lines = label.get_text().split("\n")
    if len(lines) == 1:
        _break_line(label, direction, room)
    elif direction == "width":
        broken = []
        for line in lines:
            label.set_text(line)
            _break_line(label, direction, room)
            broken.append(label.get_text())
        label.set_text("\n".join(broken))


def _break_line(label: Any, direction: str, room: float) -> None:
    """Break a label of one line."""
    text = WHOLE.sub(lambda found: found[0].replace(" ", HARD), label.get_text())
    length = getattr(label.get_window_extent(), direction)
    if length <= room:
        return
    words = text.split(" ")
    longest_word = max(map(seen, words))
    fewest = min(math.ceil(length / max(room, 1.0)), len(words))
    for count in range(fewest, len(words) + 1):
        lines = in_lines(text, count)
        label.set_text(lines.replace(HARD, " "))
        no_shorter = max(map(seen, lines.split("\n"))) <= longest_word
        if no_shorter or getattr(label.get_window_extent(), direction) <= room:
            return


def in_lines(text: str, count: int) -> str:
    """The text in at most so many lines, the longest of which is as short as it can be."""
    words = text.split(" ")
    longest = max(map(seen, words))
    lines = [text]
    for length in range(longest, sum(map(seen, words)) + 1):
        lines = _filled(words, length)
        if len(lines) <= count:
            break
    return "\n".join(lines)


def _filled(words: Sequence[str], length: int) -> list[str]:
    """Words in lines of at most a length, as it is seen."""
    lines = [words[0]]
    taken = seen(words[0])
    for word in words[1:]:
        taken += seen(word)
        if taken <= length:
            lines[-1] = f"{lines[-1]} {word}"
        else:
            lines.append(word)
            taken = seen(word)
    return lines
