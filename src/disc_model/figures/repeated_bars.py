"""Labels of the bars of maps that stand beside each other on a reader's axes: of several that are alike, the last
one of a row has the label, as it would leave narrow panels little room."""

from itertools import pairwise
from typing import NamedTuple
from weakref import ReferenceType, WeakKeyDictionary, ref

from disc_model.figures.labels import words_of
from disc_model.figures.pages import Page
from disc_model.figures.types import Axes

NARROW = 3  # columns of a grid, of that many or more


class Bar(NamedTuple):
    """The bar of a map, and the words of its label."""

    ax: ReferenceType[Axes]
    words: str


_BARS: WeakKeyDictionary[Axes, Bar] = WeakKeyDictionary()
"""The bars of maps on a reader's axes."""


def leave_label_to_last(page: Page) -> list[Axes]:
    """Take the label of a bar away if the map at the right has the same; returns the axes of all maps in the
    row that may have more room then."""
    if len(page.axes) != 1 or len(page.bars) != 1:
        return []
    [bar] = page.bars
    _BARS[page.ax] = Bar(ref(bar), words_of(bar.yaxis.label))
    row = _maps_in_row(page.ax)
    cleared = [left for left, right in pairwise(row) if _clear_repeated(left, right)]
    return row if cleared else []


def _maps_in_row(ax: Axes) -> list[Axes]:
    """The maps with a bar in the row of one in a grid of narrow columns, from left to right."""
    place = ax.get_subplotspec()
    if place is None or place.get_topmost_subplotspec().get_gridspec().ncols < NARROW:
        return []
    own = place.get_topmost_subplotspec()
    columns = {}
    for other in ax.figure.axes:
        found = other.get_subplotspec()
        if other not in _BARS or found is None:
            continue
        beside = found.get_topmost_subplotspec()
        if beside.get_gridspec() is own.get_gridspec() and beside.rowspan == own.rowspan:
            columns[beside.colspan.start] = other
    return [columns[start] for start in sorted(columns)]


def _clear_repeated(left: Axes, right: Axes) -> bool:
    """Take the label of the bar of a map away if it is that of the next one; returns whether it was there."""
    reference, words = _BARS[left]
    bar = reference()
    if bar is None or words_of(bar.yaxis.label) != words or _BARS[right].words != words:
        return False
    bar.set_ylabel("")
    return True
