"""Rows of marks above a panel, and columns beside one, which stand for points of its lines without a
value, and why these have none."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary, WeakSet

import numpy as np
from matplotlib.patches import Rectangle
from matplotlib.text import Text
from matplotlib.transforms import ScaledTranslation, blended_transform_factory

from disc_model.figures.covered import twins_of
from disc_model.figures.drawing import GREY, large, mark, wide
from disc_model.figures.types import Array, Axes

FIRST = 4.0  # points, height of the first row above its panel,
APART = 5.0  # of a row, for marks of the usual size,
GAP = 0.5  # between a row and words,
BETWEEN = 2.0  # and more between these and the next row, which is nearer to its own
STRIP = "#e6e6e6"  # behind rows, so that nobody takes their marks for values
MOST = 0.15  # height of all rows above a panel, over that of the page: more of them are nearer
TEXT = 7.0  # points, size of the words
LINE = 1.25  # height of one of their lines, over this size
SHARE = (
    0.3  # height of all strips and words, over that of a row of panels: more of them are smaller,
)
SMALL_TEXT = 6.0  # points, with words of this size at most,
SMALL_APART = 3.2  # points, a height of a row,
SMALL_BETWEEN = 1.0  # and a gap between words and the next row
TITLE = 6.0  # points, distance of a title from what stands above a panel


@dataclass
class Rows:
    """The rows of one reason, from the lowest on, the words above them, and the strip behind them.

    reason : the words without the name of the sweep whose points they are
    said : the words with this name, in one line
    sweep : the number of this sweep, if others have rows of the same looks
    """

    words: Text
    strip: Rectangle
    reason: str
    said: str
    sweep: int | None = None
    rows: list[Any] = field(default_factory=list)


_ROWS: WeakKeyDictionary[Axes, dict[tuple[str, int | None], Rows]] = WeakKeyDictionary()
"""The rows above panels, by their reasons and sweeps, in their order."""
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
    """The rows that are seen above a panel."""
    return [each for each in _kept_above(ax) if each.strip.get_visible()]


def _kept_above(ax: Axes) -> list[Rows]:
    """The rows above a panel from which they were not removed, as by ``ax.clear()``, also those that
    are not seen because others have the same marks."""
    return [each for each in _ROWS.get(ax, {}).values() if each.words in ax.texts]


def add_row(ax: Axes, reason: str, across: Array, sweep: int | None = None, **look: Any) -> None:
    """Mark points above a panel, in a row under the words of their reason, which stand there once for
    all lines, also of those on axes on the same place, such as those of ``ax.twinx()``; or once for
    all lines of a sweep, by its number, if others have rows of the same looks."""
    ax = _host_of(ax)
    if not _kept_above(ax):
        _ROWS[ax] = {}
        _SMALL.discard(ax)
    reasons = _ROWS[ax]
    key = (reason, sweep)
    if key not in reasons:
        words = ax.text(0, 1, reason, fontsize=large(TEXT), ha="left", va="bottom")
        strip = Rectangle((0, 0), 1, 0, color=STRIP, linewidth=0, zorder=0, clip_on=False)
        ax.add_artist(strip)
        reasons[key] = Rows(words, strip, reason, reason, sweep)
    if not ax.spines["top"].get_visible():  # else the lowest row would pass for values
        ax.spines["top"].set(visible=True, color=GREY, linewidth=wide(0.5))
    transform = ax.get_xaxis_transform()
    [row] = ax.plot(
        across, [1.0] * len(across), transform=transform, clip_on=False, linestyle="", **look
    )
    reasons[key].rows.append(row)
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


def silence_rows(ax: Axes) -> None:
    """Take the words of rows away, which keep their marks; strips have them as labels for a legend of the
    reader."""
    host = _host_of(ax)
    found = rows_above(host)
    for number, each in enumerate(found, start=1):
        strip = f"strip {number}" if len(found) > 1 else "strip"
        each.strip.set_label(f"{strip} above: {each.said}")
        each.words.set_text("")
    stack_rows(host)


def name_rows(ax: Axes, names: Mapping[int, str]) -> None:
    """Add the names of sweeps, by their numbers, to the words of rows that are those of one sweep."""
    host = _host_of(ax)
    by_reason: dict[str, list[Rows]] = {}
    for each in _kept_above(host):
        if each.sweep is not None and each.sweep in names:
            reason, colon, further = each.reason.partition(":")
            each.said = f"{reason}, {names[each.sweep]}{colon}{further}"
            each.words.set_text(each.said)
        by_reason.setdefault(each.reason, []).append(each)
    for alike in by_reason.values():
        _show_once(alike)
    stack_rows(host)


def _show_once(found: Sequence[Rows]) -> None:
    """Show rows of one reason, or the first of them alone, without a name, where all have the same
    marks."""
    first, *others = found
    same = all(_marks_of(each) == _marks_of(first) for each in others)
    for each in others:
        for artist in (each.words, each.strip, *each.rows):
            artist.set_visible(not same)
    if others and same:
        first.said = first.reason
        first.words.set_text(first.said)


def _marks_of(found: Rows) -> list[tuple[Any, ...]]:
    """Places and looks of the marks of rows."""
    return [(*row.get_xdata(), str(row.get_marker()), str(row.get_color())) for row in found.rows]


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
        for row in each.rows:
            up = ax.transAxes + ScaledTranslation(0, height / 72, page.dpi_scale_trans)
            row.set_transform(blended_transform_factory(ax.transData, up))
            row.set_markersize(min(row.get_markersize(), sizes.apart))
            height += apart
        height += GAP + 0.5 * sizes.apart - apart
        up = ax.transAxes + ScaledTranslation(0, height / 72, page.dpi_scale_trans)
        each.words.set_transform(up)
        each.words.set_fontsize(sizes.text)
        said = each.words.get_text()
        lines = said.count("\n") + 1 if said else 0
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
