"""Numbers along axes: fewer of them where they would meet."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.ticker import FixedLocator, Formatter, MaxNLocator, ScalarFormatter

from disc_model.figures.types import Axes

MOST_STEPS = 6  # between numbers along an axis on which more of them would meet
NUMBERS_APART = 4.0  # points, least gap between these
HEIGHTS_APART = 1.5  # points, least gap between numbers on each other
BAR_APART = 2.0  # and beside a bar, where those about zero would seem one group
UNEVEN = ("asinh", "log", "symlog")  # scales on which equal steps have unequal lengths
Number = tuple[float, Any]
"""A number beside an axis, and the box that it takes."""


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
    gap = NUMBERS_APART * _pixels(axis)
    return all(after[0] - before[1] > gap for before, after in pairwise(ends))


def _shown(axis: Any, places: Any) -> Any:
    """Those of some places along an axis that lie on it."""
    low, high = sorted(axis.get_view_interval())
    rounding = 1e-3 * (high - low)
    return places[(places >= low - rounding) & (places <= high + rounding)]


def write_in_full(ax: Axes) -> None:
    """Write numbers along axes in full, without a number beside the panel to which they are to be added: it is
    overlooked."""
    for axis in (ax.xaxis, ax.yaxis):
        formatter = axis.get_major_formatter()
        if isinstance(formatter, ScalarFormatter):
            formatter.set_useOffset(False)


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
    """Hide numbers beside a bar of colours where they would meet.

    On even steps these are all but every second one from zero or a power of ten on, or every third,
    and so on. Where a scale is neither linear nor one of whole decades, the ends stay.
    """
    axis: Any = bar.yaxis
    _show_all_numbers(axis)
    numbers = _numbers_beside(axis)
    has_own_steps = isinstance(axis.get_major_locator(), FixedLocator)
    if bar.get_yscale() in UNEVEN and has_own_steps:
        hidden = _meeting(_ends_first(numbers), BAR_APART * _pixels(axis))
    else:
        hidden = _between_even_steps(axis, numbers)
    if hidden:
        _hide_numbers(axis, hidden)


def _between_even_steps(axis: Any, numbers: Sequence[Number]) -> list[float]:
    """Numbers to hide so that every second one from zero or a power of ten on is left, or every third,
    and so on, until they do not meet."""
    values = [number for number, _ in numbers]
    whole = [place for place in (0.0, *_shown(axis, axis.get_majorticklocs())) if place in values]
    anchor = values.index(whole[0]) if whole else 0

    every = 1
    kept = list(numbers)
    while not all(after[1].y0 > before[1].y1 for before, after in pairwise(kept)):
        every += 1
        kept = [each for i, each in enumerate(numbers) if (i - anchor) % every == 0]
    known = [number for number, _ in kept]
    return [number for number in values if number not in known]


def spare_heights(ax: Axes) -> None:
    """Hide numbers beside a scale of heights that is not linear where they would meet: those of minor
    ticks first, and of equal ones those that are further from zero; on a scale through zero, and
    on one that spans less than a factor of ten, the outermost ones stay, without which it would seem linear."""
    axis: Any = ax.yaxis
    if ax.get_yscale() == "linear":
        return
    _show_all_numbers(axis)
    numbers = _numbers_beside(axis)
    low, high = sorted(ax.get_ylim())
    if ax.get_yscale() == "symlog" or high < 10 * low:
        hidden = _meeting(_ends_first(numbers), gap=0.0)
    else:
        whole = _shown(axis, axis.get_majorticklocs())
        numbers.sort(key=lambda each: (each[0] not in whole, abs(each[0]), each[0]))
        hidden = _meeting(numbers, HEIGHTS_APART * _pixels(axis))
    if hidden:
        _hide_numbers(axis, hidden)


def _pixels(axis: Any) -> float:
    """Pixels in a point of the figure of an axis."""
    return float(axis.get_figure(root=True).dpi / 72)


def _ends_first(numbers: Sequence[Number]) -> list[Number]:
    """Numbers with their boxes, in the order in which they say most of an uneven scale: the ends, zero,
    powers of ten from the smallest on, which ends its linear part, and others."""
    values = [number for number, _ in numbers]
    ends = (min(values, default=0.0), max(values, default=0.0))

    def rank(each: Number) -> tuple[bool, bool, float]:
        number = each[0]
        return number not in (*ends, 0.0), not _is_power_of_ten(number), abs(number)

    return sorted(numbers, key=rank)


def _is_power_of_ten(number: float) -> bool:
    """Whether a number, or its negative, is a power of ten."""
    return f"{number:e}".lstrip("-").startswith("1.000000")


def _meeting(numbers: Sequence[Number], gap: float) -> list[float]:
    """Those of some numbers whose boxes would meet one of those before them, or come nearer to it than
    a gap."""
    kept: list[Any] = []
    hidden = []
    for number, box in numbers:
        if box.count_overlaps(kept):
            hidden.append(number)
        else:
            kept.append(box.padded(0, gap))
    return hidden


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


def _numbers_beside(axis: Any) -> list[Number]:
    """The numbers beside a vertical axis from the lowest on, and the boxes that they take."""
    found = []
    for minor in (False, True):
        shown = _shown(axis, axis.get_ticklocs(minor=minor))
        for text in axis.get_ticklabels(minor=minor):
            number = text.get_position()[1]
            if text.get_text() and number in shown:
                found.append((number, text.get_window_extent()))
    return sorted(found, key=lambda each: each[0])
