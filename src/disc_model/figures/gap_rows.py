"""Rows of marks above a panel, and columns beside one, which stand for points of its lines without a
value, and why these have none."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary, WeakSet

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.text import Text
from matplotlib.transforms import ScaledTranslation, blended_transform_factory

from disc_model.figures.covered import twins_of
from disc_model.figures.drawing import GREY, large, mark, wide
from disc_model.figures.kept import Kept
from disc_model.figures.types import Array, Axes

FIRST = 4.0  # points, height of the first row above its panel,
APART = 5.0  # of a row, for marks of the usual size,
GAP = 0.5  # between a row and words,
BETWEEN = 2.0  # and more between these and the next row, which is nearer to its own
STRIP = "#e6e6e6"  # behind rows, so that nobody takes their marks for values
MOST = 0.15  # height of all rows above a panel, over that of the page: more of them are nearer
TEXT = 7.0  # points, size of the words
LINE = 1.25  # height of one of their lines, over this size
SHARE = 0.3  # height of all strips and words, over that of a row: more of them are smaller,
SMALL_TEXT = 6.0  # points, with words of this size at most,
SMALL_APART = 3.2  # points, a height of a row,
SMALL_BETWEEN = 1.0  # and a gap between words and the next row
TITLE = 6.0  # points, distance of a title from what stands above a panel


@dataclass
class Rows:
    """The rows of one reason, from the lowest on, the words above them, and the strip behind them.

    reason : the words in one line
    kept : all rows, also those that others of the same marks stand for
    """

    words: Text
    strip: Rectangle
    reason: str
    kept: list[Row] = field(default_factory=list)

    @property
    def seen(self) -> list[Row]:
        """The rows that are seen."""
        return [row for row in self.kept if row.marks.get_visible()]

    @property
    def rows(self) -> list[Any]:
        """The marks of each of them."""
        return [row.marks for row in self.seen]


@dataclass
class Row:
    """A row of marks.

    sweep : the number of the sweep of their line, if other sweeps have lines of the same colours
    dashes : of this line
    below : the line below the marks, which has these dashes, if there is one
    """

    marks: Any
    sweep: int | None
    dashes: Any
    below: Any = None


_ROWS: Kept[dict[str, Rows]] = Kept("rows")
"""The rows above panels, by their reasons, in their order."""
_MAY_BE_SMALL: WeakSet[Axes] = WeakSet()
"""The panels of readers, above which rows and words are smaller if there are many,"""
_SMALL: WeakSet[Axes] = WeakSet()
"""and those above which they are."""
_HEIGHTS: WeakKeyDictionary[Axes, float] = WeakKeyDictionary()
"""The heights of titles above panels with such rows, points."""


def allow_small_rows(axes: Sequence[Axes]) -> None:
    """Let rows above axes be smaller where they would take much of the page."""
    _MAY_BE_SMALL.update(axes)


def rows_above(ax: Axes) -> list[Rows]:
    """The rows above a panel from which they were not removed, as by ``ax.clear()``."""
    return [each for each in _ROWS.get(ax, {}).values() if each.words in ax.texts]


def add_row(
    ax: Axes, reason: str, across: Array, sweep: int | None = None, dashes: Any = "", **look: Any
) -> None:
    """Mark points above a panel, in a row under the words of their reason, which stand there once for
    all lines, also of those on axes on the same place, such as those of ``ax.twinx()``.

    sweep : number of the sweep of the line, if other sweeps have lines of the same colours
    dashes : of the line, "" if none joins its points
    """
    ax = _host_of(ax)
    reasons = _ROWS.get(ax, {})
    if not rows_above(ax):
        reasons = {}
        _SMALL.discard(ax)
    _ROWS[ax] = reasons
    if reason not in reasons:
        words = ax.text(0, 1, reason, fontsize=large(TEXT), ha="left", va="bottom")
        strip = Rectangle((0, 0), 1, 0, color=STRIP, linewidth=0, zorder=0, clip_on=False)
        ax.add_artist(strip)
        reasons[reason] = Rows(words, strip, reason)
    if not ax.spines["top"].get_visible():  # else the lowest row would pass for values
        ax.spines["top"].set(visible=True, color=GREY, linewidth=wide(0.5))
    transform = ax.get_xaxis_transform()
    [row] = ax.plot(
        across, [1.0] * len(across), transform=transform, clip_on=False, linestyle="", **look
    )
    reasons[reason].kept.append(Row(row, sweep, dashes))
    stack_rows(ax)


def add_column(ax: Axes, heights: Array, **look: Any) -> None:
    """Mark points to the right of a panel on a strip, of values along its vertical axis at which there is
    none along the horizontal one; the look has the label of a legend."""
    right: Any = ax.transAxes
    page: Any = ax.get_figure(root=True)
    beside = right + ScaledTranslation(mark(FIRST) / 72, 0, page.dpi_scale_trans)
    begin = (mark(FIRST) - 0.5 * mark(APART)) / 72
    wide_strip = page.dpi_scale_trans + ScaledTranslation(1, 0, right)
    place = blended_transform_factory(wide_strip, right)
    strip: dict[str, Any] = {"color": STRIP, "linewidth": 0, "zorder": 0, "clip_on": False}
    ax.add_artist(Rectangle((begin, 0), mark(APART) / 72, 1, transform=place, **strip))
    transform = blended_transform_factory(beside, ax.transData)
    ones = [1.0] * len(heights)
    ax.plot(ones, heights, transform=transform, clip_on=False, linestyle="", **look)


def tell_rows_apart(ax: Axes, sweeps: Collection[int]) -> None:
    """Show whose marks stand in rows above a panel that has lines of several sweeps, by the numbers of
    these: lines of the same dashes lie below marks. Rows that all sweeps have alike stand there
    once."""
    host = _host_of(ax)
    for each in rows_above(host):
        by_sweep = _by_sweep(each, sweeps)
        alike = _are_alike(by_sweep, sweeps)
        for place, rows in enumerate(by_sweep.values()):
            for row in rows:
                row.marks.set_visible(place == 0 or not alike)
                _draw_below(host, row, not alike)
    stack_rows(host)


def _draw_below(ax: Axes, row: Row, seen: bool) -> None:
    """Draw a line of the dashes of a row below its marks, or remove it."""
    if row.below is not None:
        row.below.remove()
        row.below = None
    if seen and row.dashes:
        look = {"color": row.marks.get_color(), "linestyle": row.dashes, "linewidth": wide(0.5)}
        row.below = Line2D([0, 1], [1, 1], clip_on=False, zorder=1, **look)
        ax.add_artist(row.below)


def _by_sweep(found: Rows, sweeps: Collection[int]) -> dict[int, list[Row]]:
    """The rows of a reason whose colours other sweeps have as well, by the numbers of their sweeps."""
    by_sweep: dict[int, list[Row]] = {}
    for row in found.kept:
        if row.sweep in sweeps and row.sweep is not None:
            by_sweep.setdefault(row.sweep, []).append(row)
    return by_sweep


def _are_alike(by_sweep: Mapping[int, Sequence[Row]], sweeps: Collection[int]) -> bool:
    """Whether all of some sweeps have rows with the same marks."""
    marks = [[_marks_of(row) for row in rows] for rows in by_sweep.values()]
    return len(marks) == len(sweeps) and all(each == marks[0] for each in marks)


def _marks_of(row: Row) -> tuple[Any, ...]:
    """Places and looks of the marks of a row."""
    marks = row.marks
    return (*marks.get_xdata(), str(marks.get_marker()), str(marks.get_color()))


def _host_of(ax: Axes) -> Axes:
    """The axes above which rows of others stand: those on the same place with rows, if there are
    any that share the horizontal axis."""
    shared = ax.get_shared_x_axes()
    hosts = [each for each in twins_of(ax) if shared.joined(ax, each) and rows_above(each)]
    return ax if rows_above(ax) or not hosts else hosts[0]


def stack_rows(ax: Axes) -> None:
    """Set the rows above a panel, and the words of their reasons in as many lines as they have now,
    on each other; titles stand above them, also those of panels beside it on the same axis. Where they
    would take much of a reader's figure, they are smaller."""
    found = rows_above(ax)
    if not found:
        return
    height = _stack(ax, found, _sizes_above(ax))
    if height > SHARE * 72 * _height_of_row(ax) and ax in _MAY_BE_SMALL:
        _SMALL.add(ax)
        height = _stack(ax, found, _sizes_above(ax))
    _HEIGHTS[ax] = height + TITLE
    beside = [each for each in ax.get_shared_y_axes().get_siblings(ax) if _in_row(each, ax)]
    highest = max(_HEIGHTS.get(each, 0.0) for each in beside)
    for each in beside:
        _lift_titles(each, highest)


class Sizes(NamedTuple):
    """Sizes of rows above a panel in points: that of words, the height of a row, and the gap between words and
    the next row."""

    text: float
    apart: float
    between: float


def _sizes_above(ax: Axes) -> Sizes:
    """The sizes of rows above a panel."""
    if ax in _SMALL:
        return Sizes(min(large(TEXT), SMALL_TEXT), min(mark(APART), SMALL_APART), SMALL_BETWEEN)
    return Sizes(large(TEXT), mark(APART), BETWEEN)


def _stack(ax: Axes, found: Sequence[Rows], sizes: Sizes) -> float:
    """Set rows above a panel on each other; returns their height in points."""
    page: Any = ax.get_figure(root=True)
    first = mark(FIRST) - 0.5 * (mark(APART) - sizes.apart)
    height = first
    apart = _distance(ax, found, sizes.apart)
    top = height
    for each in found:
        _set_strip(ax, each, height - 0.5 * sizes.apart, (len(each.rows) - 1) * apart + sizes.apart)
        for row in each.seen:
            up = ax.transAxes + ScaledTranslation(0, height / 72, page.dpi_scale_trans)
            row.marks.set_transform(blended_transform_factory(ax.transData, up))
            row.marks.set_markersize(min(row.marks.get_markersize(), sizes.apart))
            if row.below is not None:
                row.below.set_transform(up)
            height += apart
        height += GAP + 0.5 * sizes.apart - apart
        up = ax.transAxes + ScaledTranslation(0, height / 72, page.dpi_scale_trans)
        each.words.set_transform(up)
        each.words.set_fontsize(sizes.text)
        lines = each.words.get_text().count("\n") + 1
        top = height + lines * LINE * sizes.text
        height = top + first + sizes.between
    return top


def _height_of_row(ax: Axes) -> float:
    """The height in inches that the row of a panel has on its page."""
    page: Any = ax.get_figure(root=True)
    place = ax.get_subplotspec()
    if place is None:
        return float(page.get_figheight() * ax.get_position(original=True).height)
    whole = place.get_topmost_subplotspec()
    return float(page.get_figheight() * len(whole.rowspan) / whole.get_gridspec().nrows)


def _distance(ax: Axes, found: Sequence[Rows], apart: float) -> float:
    """The distance of rows above a panel in points, with which many of them leave it room; no more than
    they are apart otherwise."""
    page: Any = ax.get_figure(root=True)
    count = sum(len(each.rows) for each in found)
    return min(apart, MOST * 72 * page.get_figheight() / max(count, 1))


def _set_strip(ax: Axes, found: Rows, height: float, span: float) -> None:
    """Lay the strip of rows behind their marks, from a height in points above the panel on, over a span
    in points."""
    page: Any = ax.get_figure(root=True)
    found.strip.set_y(height / 72)
    found.strip.set_height(span / 72)
    axes: Any = ax.transAxes  # affine, which its type does not say
    up = page.dpi_scale_trans + ScaledTranslation(0, 1, axes)
    found.strip.set_transform(blended_transform_factory(ax.transAxes, up))


def _in_row(ax: Axes, other: Axes) -> bool:
    """Whether axes end at the same height."""
    places = [each.get_position(original=True) for each in (ax, other)]
    return bool(np.isclose(places[0].y1, places[1].y1))


def _lift_titles(ax: Axes, height: float) -> None:
    """Set the titles of axes, which keep their looks, so many points above them."""
    for loc in ("left", "center", "right"):
        words = ax.get_title(loc)
        if words:
            before = {text: text.get_fontproperties().copy() for text in _titles(ax, words)}
            ax.set_title(words, loc=loc, pad=height)
            for text, font in before.items():
                text.set_fontproperties(font)


def _titles(ax: Axes, words: str) -> list[Text]:
    """The titles of axes that have some words."""
    texts = [child for child in ax.get_children() if isinstance(child, Text)]
    return [text for text in texts if text not in ax.texts and text.get_text() == words]
