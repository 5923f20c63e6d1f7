"""Labels and titles of axes: no longer than these, and in the units of the reader."""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from types import MappingProxyType
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator, Formatter, FuncFormatter, MaxNLocator, NullFormatter

from disc_model.data.variables import SHOWN, typeset
from disc_model.figures.drawing import DECADES
from disc_model.figures.gap_rows import rows_above, stack_rows
from disc_model.figures.places import set_places
from disc_model.figures.types import Axes, Figure
from disc_model.figures.words import UNITS

MOST_STEPS = 6  # between numbers along an axis on which more of them would meet
NUMBERS_APART = 4.0  # points, least gap between these
BEYOND = 1.15  # length of a label over that of its axis, at most,
ROOM_BESIDE = 0.6  # or so many inches more beside panels that have none above or below,
SHARE_BESIDE = 0.5  # or this share of the height of the page,
SHARE_OF_ROW = 0.7  # and this share of that of a row, beside low panels
MOST_ABOVE = 2  # lines of words above a panel that are not left out after a colon
MARKUP = re.compile(r"\\\w+|[${}_^]")  # of mathematical text; a symbol for a command
WHOLE = re.compile(r"(?<=\()[^()]{1,12}(?=\))| = (-?[\d.]+ (?=\S{1,5}(,|$)))?")
"""What stays on one line: a unit, and a value with its name and unit."""
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
    return min(room, 2 * min(middle, end - middle))


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
    """Break a label into as few lines as fit a room in pixels, or as its longest word leaves."""
    text = WHOLE.sub(lambda found: found[0].replace(" ", HARD), label.get_text())
    length = getattr(label.get_window_extent(), direction)
    if length <= room or "\n" in text:
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


def seen(word: str) -> int:
    """Number of characters of a word that are seen, and the blank after it."""
    return len(MARKUP.sub(lambda found: "x" if found[0].startswith("\\") else "", word)) + 1


# ---- Symbols


def set_upright(texts: Iterable[Any]) -> None:
    """Set symbols with an index, such as c_p, in upright letters, as all others are, whatever the
    setting of matplotlib when the texts are drawn."""
    for text in texts:
        said = text.get_text()
        if "$" in said:
            text.set_text(re.sub(r"\$([^$]+)\$", r"$\\mathrm{\1}$", without_font(said)))


def without_font(text: str) -> str:
    """A text with symbols in the letters that matplotlib's setting gives them."""
    return re.sub(r"\$\\mathrm\{([^$]+)\}\$", r"$\1$", text)


def in_a_row(text: str) -> str:
    """A text without the letters of its symbols and the lines in which it stands."""
    return without_font(text).replace("\n", " ")


# ---- Numbers along axes


def part_numbers(ax: Axes) -> None:
    """Have fewer numbers along a horizontal linear axis, as long as they meet or leave the figure.

    matplotlib's layout can leave no room for the last one where their count depends on the width.
    """
    axis: Any = ax.xaxis
    if not isinstance(axis.get_major_locator(), MaxNLocator):
        return
    for steps in range(MOST_STEPS, 0, -1):
        if _numbers_have_room(axis):
            return
        ax.locator_params(axis="x", nbins=steps)
    if not _numbers_have_room(axis):
        ax.set_xticks(_shown(axis, axis.get_majorticklocs())[[0, -1]])


def _numbers_have_room(axis: Any) -> bool:
    """Whether numbers along a horizontal axis have a gap between them, and end within the figure."""
    labels = axis.get_ticklabels()  # also sets their texts and places
    shown = _shown(axis, axis.get_majorticklocs())
    boxes = [text.get_window_extent() for text in labels if text.get_position()[0] in shown]
    ends = sorted((box.x0, box.x1) for box in boxes)
    figure = axis.get_figure(root=True)
    if ends and ends[-1][1] > figure.bbox.x1:
        return False
    gap = NUMBERS_APART * figure.dpi / 72
    return all(after[0] - before[1] > gap for before, after in pairwise(ends))


def _shown(axis: Any, places: Any) -> Any:
    """Those of some places along an axis that lie on it."""
    low, high = sorted(axis.get_view_interval())
    rounding = 1e-3 * (high - low)
    return places[(places >= low - rounding) & (places <= high + rounding)]


class Sparing(Formatter):
    """The numbers of another formatter, but those that are hidden."""

    def __init__(self, all_of_them: Formatter) -> None:
        self.all_of_them = all_of_them
        self.hidden: list[float] = []

    def __call__(self, x: float, pos: int | None = None) -> str:
        if self.hidden and np.isclose(x, self.hidden, rtol=1e-9, atol=0).any():
            return ""
        return self.all_of_them(x, pos)

    def set_axis(self, axis: Any) -> None:
        super().set_axis(axis)
        self.all_of_them.set_axis(axis)

    def set_locs(self, locs: Any) -> None:
        self.all_of_them.set_locs(locs)


def spare_numbers(bar: Axes) -> None:
    """Hide numbers beside a bar of colours where they would meet: all but every second one from zero
    or a power of ten on, or every third, and so on."""
    axis: Any = bar.yaxis
    _show_all_numbers(axis)
    numbers = _numbers_beside(axis)
    values = [number for number, _ in numbers]
    whole = [place for place in (0.0, *_shown(axis, axis.get_majorticklocs())) if place in values]
    anchor = values.index(whole[0]) if whole else 0

    every = 1
    kept = numbers
    while not all(after[1].y0 > before[1].y1 for before, after in pairwise(kept)):
        every += 1
        kept = [each for i, each in enumerate(numbers) if (i - anchor) % every == 0]
    if every == 1:
        return
    known = [number for number, _ in kept]
    _hide_numbers(axis, [number for number in values if number not in known])


def spare_heights(ax: Axes) -> None:
    """Hide numbers beside a scale of heights that is not linear where they would meet: those of minor
    ticks first, and of equal ones those that are further from zero."""
    axis: Any = ax.yaxis
    if ax.get_yscale() == "linear":
        return
    _show_all_numbers(axis)
    whole = _shown(axis, axis.get_majorticklocs())
    numbers = sorted(
        _numbers_beside(axis), key=lambda each: (each[0] not in whole, abs(each[0]), each[0])
    )
    kept: list[Any] = []
    hidden = []
    for number, box in numbers:
        if box.count_overlaps(kept):
            hidden.append(number)
        else:
            kept.append(box)
    if hidden:
        _hide_numbers(axis, hidden)


def _show_all_numbers(axis: Any) -> None:
    """Show what formatters have left out."""
    for each in (axis.get_major_formatter(), axis.get_minor_formatter()):
        if isinstance(each, Sparing):
            each.hidden = []


def _hide_numbers(axis: Any, hidden: list[float]) -> None:
    """Have formatters that leave out some numbers."""
    major = axis.get_major_formatter()
    minor = axis.get_minor_formatter()
    for each, replace in ((major, axis.set_major_formatter), (minor, axis.set_minor_formatter)):
        sparing = each if isinstance(each, Sparing) else Sparing(each)
        sparing.hidden = hidden
        replace(sparing)


def _numbers_beside(axis: Any) -> list[tuple[float, Any]]:
    """The numbers beside a vertical axis from the lowest on, and the boxes that they take."""
    found = []
    for minor in (False, True):
        shown = _shown(axis, axis.get_ticklocs(minor=minor))
        for text in axis.get_ticklabels(minor=minor):
            number = text.get_position()[1]
            if text.get_text() and number in shown:
                found.append((number, text.get_window_extent()))
    return sorted(found, key=lambda each: each[0])


# ---- Units of the reader


def restate_axes(figure: Figure, key_by_label: Mapping[str, str] = MappingProxyType({})) -> None:
    """Give axes in the units of the reader: their labels and ticks; what is drawn stays.

    key_by_label : the parameter or sampled variable that has the unit of an axis, by labels that do not
        begin with its name
    """
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            for name, (unit, factor) in UNITS.get().items():
                shown = SHOWN[name]
                text = axis.get_label_text()
                known = typeset(f"{shown.name} {shown.symbol}".strip())
                is_meant = text.startswith(known) or key_by_label.get(text) == name
                if is_meant and text.endswith(f"({shown.unit})"):
                    axis.set_label_text(text.removesuffix(f"({shown.unit})") + f"({unit})")
                    _set_ticks(axis, factor / shown.factor)


def _set_ticks(axis: Any, ratio: float) -> None:
    """Set ticks at round numbers of another unit, `ratio` of which are one of the axis's: powers of ten
    on a scale that is not linear, unless it shows fewer than two of them."""
    low, high = ratio * np.asarray(axis.get_view_interval())
    ticks = np.asarray(DECADES)
    if axis.get_scale() == "linear" or np.count_nonzero((ticks >= low) & (ticks <= high)) < 2:
        ticks = np.asarray(MaxNLocator(7, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high))
    axis.set_major_locator(FixedLocator((ticks / ratio).tolist()))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value * ratio:.6g}"))
    axis.set_minor_formatter(NullFormatter())  # its numbers would be those of the other unit
