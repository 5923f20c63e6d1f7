"""Places of axes in figures without a layout engine, which would let legends and labels fall off
the page."""

import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from matplotlib.transforms import Bbox

from disc_model.errors import require
from disc_model.figures.labels import break_labels
from disc_model.figures.places import has_collapsed, set_places
from disc_model.figures.types import Array, Axes, Figure

MARGIN = 0.03  # inch, kept free along the edges of the page
ROUNDS = 3  # numbers along an axis may change with its length
LEAST_PANEL = 8.0  # mm, side of a panel beside a bar and a legend
LEAST_STEP = 0.1  # pixel, less than which is rounding
LEAST_SIDE = 0.6  # inch, of a panel, up to which gaps between panels are widened
LEAST_BESIDE = 2.4  # inch of the width of a figure for each of several panels beside each other
LEAST_SHARE = 0.1  # of their size, or of the page, that axes keep in any case


MARGINS = ("left", "right", "bottom", "top", "wspace", "hspace")


class Margins(NamedTuple):
    """Margins of a figure and gaps between its axes: those of its reader, and those that were widened
    from them."""

    own: dict[str, float]
    widened: dict[str, float]


_MARGINS: WeakKeyDictionary[Any, Margins] = WeakKeyDictionary()


class Beyond(NamedTuple):
    """How far axes and what belongs to them reach beyond the page, or into what stands beside them in
    a grid, in pixels; 0 if they do not."""

    left: float
    right: float
    below: float
    above: float


def stack_narrow(axes: Sequence[Axes], height: float) -> None:
    """Set panels that stand beside each other in too narrow a figure, and alone in it, below each
    other, in a figure so high that each has a height in inches."""
    page: Any = axes[0].get_figure(root=True)
    places: list[Any] = [ax.get_subplotspec() for ax in axes]
    if len(axes) < 2 or {*page.axes} != {*axes} or None in places:
        return
    grid = places[0].get_gridspec()
    is_row = (grid.nrows, grid.ncols) == (1, len(axes))
    narrow = page.get_figwidth() < LEAST_BESIDE * len(axes)
    part: Any = axes[0].get_figure(root=False)
    if not is_row or not narrow or part is not page:
        return
    for ax, place in zip(axes, page.add_gridspec(len(axes), 1), strict=True):
        ax.set_subplotspec(place)
        ax.tick_params(labelleft=True)  # panels of a row that share an axis leave them out
    page.set_figheight(max(page.get_figheight(), height * len(axes)))


def restore_margins(figure: Any) -> None:
    """Give a figure the margins of its reader back, unless these are others now: what is drawn later
    may need less room than what stood there before."""
    now = {name: getattr(figure.subplotpars, name) for name in MARGINS}
    known = _MARGINS.get(figure)
    if known is None or known.widened != now:
        known = Margins(now, now)
        _MARGINS[figure] = known
    figure.subplots_adjust(**known.own)


def _keep_margins(figure: Any) -> None:
    """Note the margins to which a figure's own ones have been widened."""
    now = {name: getattr(figure.subplotpars, name) for name in MARGINS}
    _MARGINS[figure] = _MARGINS[figure]._replace(widened=now)


def fit_to_page(figure: Figure, panels: Mapping[Axes, Sequence[Axes]]) -> None:
    """Make room on the page for labels, titles and legends of panels and of bars of colours beside
    them, and between those of neighbours in a grid.

    Axes of a grid get larger margins and gaps, as by `subplots_adjust`, so that rows and columns stay
    in line and a later `tight_layout` works; others shrink. They begin from those of the reader each
    time, since what is drawn now may need less.
    """
    restore_margins(figure)
    _widen_for(figure, panels)
    _keep_margins(figure)


def _widen_for(figure: Figure, panels: Mapping[Axes, Sequence[Axes]]) -> None:
    """Widen margins and gaps, or shrink axes, until all has room or nothing changes."""
    for _ in range(ROUNDS):
        set_places(figure)  # sets the places
        changed = False
        for ax, bars in panels.items():
            beyond = _beyond(ax, bars)
            if max(beyond) < LEAST_STEP:
                continue
            before = _places_of(panels)
            place = ax.get_subplotspec()
            if place is None:
                _shrink(ax, bars, beyond)
            else:
                _widen_margins(figure, place.get_topmost_subplotspec(), beyond)
            if np.abs(_places_of(panels) - before).max() > LEAST_STEP:
                changed = True
                set_places(figure)  # so that a gap is not widened from both sides
                break_labels(figure, [ax, *bars])  # a longer one would take ever more room
        if not changed:
            return


def _places_of(panels: Iterable[Axes]) -> Array:
    """Corners of panels, in pixels."""
    return np.array([ax.get_window_extent().extents for ax in panels])


def _shrink(ax: Axes, bars: Sequence[Axes], beyond: Beyond) -> None:
    """Shrink axes by as much as they reach beyond the page; bars keep their width."""
    page: Any = ax.get_figure(root=True)
    width, height = page.bbox.size
    for each in (ax, *bars):
        place = each.get_position(original=True)
        left = place.x0 + beyond.left / width
        if each is not ax:
            left = place.x0 - beyond.right / width
        right = place.x1 - beyond.right / width
        lower = place.y0 + beyond.below / height
        upper = place.y1 - beyond.above / height
        right = max(right, left + LEAST_SHARE * place.width)
        upper = max(upper, lower + LEAST_SHARE * place.height)
        each.set_position(Bbox.from_extents(left, lower, right, upper))


def _widen_margins(page: Any, place: Any, beyond: Beyond) -> None:
    """Widen the margins of a grid of axes, or the gaps between its columns and rows, by as much as
    axes at a place in it reach beyond the page or into others."""
    margins = page.subplotpars
    width, height = page.bbox.size
    left = margins.left
    right = margins.right
    across = 0.0
    if place.is_first_col():
        left += beyond.left / width
    else:
        across = max(across, beyond.left / width)
    if place.is_last_col():
        right -= beyond.right / width
    else:
        across = max(across, beyond.right / width)

    lower = margins.bottom
    upper = margins.top
    up = 0.0
    if place.is_last_row():
        lower += beyond.below / height
    else:
        up = max(up, beyond.below / height)
    if place.is_first_row():
        upper -= beyond.above / height
    else:
        up = max(up, beyond.above / height)

    grid = place.get_gridspec()
    left = max(min(left, right - LEAST_SHARE), 0.0)
    lower = max(min(lower, upper - LEAST_SHARE), 0.0)
    columns = Row(margins.right - margins.left, grid.ncols, margins.wspace)
    rows = Row(margins.top - margins.bottom, grid.nrows, margins.hspace)
    page.subplots_adjust(
        left=left,
        right=right,
        bottom=lower,
        top=upper,
        wspace=columns.gap_in(right - left, across, LEAST_SIDE * page.dpi / width),
        hspace=rows.gap_in(upper - lower, up, LEAST_SIDE * page.dpi / height),
    )


class Row(NamedTuple):
    """Axes in a row or a column: its length as a share of the page, how many there are, and the gap
    between two over their length."""

    whole: float
    number: int
    gap: float

    def gap_in(self, whole: float, wider: float, least: float) -> float:
        """The gap over the axes in another length, where it has the width that it had, and is wider
        by a share of the page; but axes that are longer than the least length have that at least."""
        gaps = self.number - 1
        if not gaps:
            return self.gap
        width = self.gap * self.whole / (self.number + self.gap * gaps)
        before = (whole - width * gaps) / self.number
        after = (whole - (width + wider) * gaps) / self.number
        size = max(after, min(before, least))
        return (whole - size * self.number) / gaps / size


def _beyond(ax: Axes, bars: Sequence[Axes]) -> Beyond:
    """How far axes, bars, labels and legend reach beyond the page, or into those beside them."""
    page: Any = ax.get_figure(root=True)
    margin = MARGIN * page.dpi
    taken = _extent([ax, *bars])
    left = margin
    right = page.bbox.width - margin
    floor = margin
    ceiling = _ceiling(page) - margin
    place = ax.get_subplotspec()
    if place is not None:
        own = place.get_topmost_subplotspec()
        left = max([left, *(box.x1 + margin for box in _beside(page, own, -1, 0))])
        right = min([right, *(box.x0 - margin for box in _beside(page, own, 1, 0))])
        floor = max([floor, *(box.y1 + margin for box in _beside(page, own, 0, 1))])
        ceiling = min([ceiling, *(box.y0 - margin for box in _beside(page, own, 0, -1))])
    return Beyond(
        max(left - taken.x0, 0.0),
        max(taken.x1 - right, 0.0),
        max(floor - taken.y0, 0.0),
        max(taken.y1 - ceiling, 0.0),
    )


def _ceiling(page: Any) -> float:
    """Where the room for axes ends above: at the edge of the page, or at a title that its reader has set
    there, in pixels."""
    said = page.get_suptitle()
    titles = [text for text in page.texts if said and text.get_text() == said]
    lower = [text.get_window_extent().y0 for text in titles]
    height = float(page.bbox.height)
    return min([height, *(y for y in lower if y > height / 2)])


def _beside(page: Any, own: Any, across: int, down: int) -> list[Bbox]:
    """The extents of axes at the places of a grid next to one, on the side to which a step of
    columns and rows leads."""
    found = []
    for ax in page.axes:
        place = ax.get_subplotspec()
        if place is None:
            continue
        other = place.get_topmost_subplotspec()
        if other.get_gridspec() is not own.get_gridspec():
            continue
        columns = _steps(own.colspan, other.colspan)
        rows = _steps(own.rowspan, other.rowspan)
        if (columns, rows) == (across, down):
            found.append(_extent([ax]))
    return found


def _steps(own: range, other: range) -> int:
    """On which side of some columns or rows others lie, -1 or 1; 0 if they share one."""
    if other.start >= own.stop:
        return 1
    if other.stop <= own.start:
        return -1
    return 0


def _extent(axes: Sequence[Axes]) -> Bbox:
    """The extent of axes with their labels, titles and legends."""
    boxes = [box for each in axes if (box := each.get_tightbbox()) is not None]
    legends: list[Any] = [each.get_legend() for each in axes]
    boxes += [legend.get_tightbbox() for legend in legends if legend is not None]
    return Bbox.union(boxes)


def check_room(axes: Sequence[Axes]) -> None:
    """Raise `ParameterError` if a bar and a legend leave no room for the panels of a reader's axes."""
    figure: Any = axes[0].get_figure(root=True)
    with warnings.catch_warnings():  # of a layout that gives up, which is said here
        warnings.simplefilter("ignore")
        set_places(figure)
    collapsed = has_collapsed(figure)
    sides = [side for ax in axes for side in (ax.bbox.width, ax.bbox.height)]
    left = 25.4 * min(sides) / figure.dpi
    rest = "no room for the panel" if collapsed else f"{left:.0f} mm for the panel"
    rule = f"must be larger, or legend=False: a colour bar and a legend leave {rest}"
    width, height = 25.4 * np.asarray(figure.get_size_inches())
    said = f"axes of a figure of {width:.0f} by {height:.0f} mm"
    enough = not collapsed and left >= LEAST_PANEL
    require((enough, "ax", said, rule))
