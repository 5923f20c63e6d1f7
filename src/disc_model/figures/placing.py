"""Places of axes in figures without a layout engine, which would let legends and labels fall off
the page."""

import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

from matplotlib.transforms import Bbox

from disc_model.errors import require
from disc_model.figures.types import Axes

MARGIN = 0.03  # inch, kept free along the edges of the page
ROUNDS = 2  # numbers along an axis may change with its length
LEAST_PANEL = 8.0  # mm, side of a panel beside a bar and a legend
LEAST_SHARE = 0.1  # of their size, or of the page, that axes keep in any case


class Beyond(NamedTuple):
    """How far axes and what belongs to them reach beyond their place, in pixels; 0 if they do not."""

    left: float
    right: float
    below: float
    above: float


def fit_to_page(ax: Axes, bars: Sequence[Axes] = ()) -> None:
    """Make room on the page for labels, titles and legend of axes and of bars of colours beside them;
    and for the legend above the panels of the next row, if there is one.

    Axes of a grid get larger margins, as by `subplots_adjust`, so that rows and columns stay in line
    and a later `tight_layout` works; others shrink.
    """
    page: Any = ax.get_figure(root=True)
    place = ax.get_subplotspec()
    for _ in range(ROUNDS):
        page.draw_without_rendering()  # sets the places
        beyond = _beyond(ax, bars)
        if not any(beyond):
            return
        if place is None:
            _shrink(ax, bars, beyond)
        else:
            _widen_margins(page, place.get_topmost_subplotspec(), beyond)


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
    """Widen the margins of a grid of axes, or the gap between its rows, by as much as axes at a place
    in it reach beyond the page or into the next row."""
    margins = page.subplotpars
    width, height = page.bbox.size
    left = margins.left + beyond.left / width
    right = margins.right - beyond.right / width
    lower = margins.bottom
    upper = margins.top - beyond.above / height
    rows = place.get_gridspec().nrows
    gaps = margins.hspace
    if place.is_last_row():
        lower += beyond.below / height
    else:
        whole = upper - lower
        row = whole / (rows + gaps * (rows - 1))
        gap = gaps * row + beyond.below / height
        row = (whole - gap * (rows - 1)) / rows
        gaps = gap / max(row, LEAST_SHARE * whole / rows)
    if right - left > LEAST_SHARE and upper - lower > LEAST_SHARE:
        page.subplots_adjust(left=left, right=right, bottom=lower, top=upper, hspace=gaps)


def _beyond(ax: Axes, bars: Sequence[Axes]) -> Beyond:
    """How far axes, bars, labels and legend reach beyond the page, or into the row below."""
    page: Any = ax.get_figure(root=True)
    margin = MARGIN * page.dpi
    boxes = [box for each in (ax, *bars) if (box := each.get_tightbbox()) is not None]
    legend = ax.get_legend()
    if legend is not None:
        boxes.append(legend.get_window_extent())
    taken = Bbox.union(boxes)
    floor = margin
    place = ax.get_subplotspec()
    if place is not None and not place.get_topmost_subplotspec().is_last_row():
        labels = ax.xaxis.get_tightbbox()
        floor = ax.bbox.y0 if labels is None else labels.y0
    return Beyond(
        max(margin - taken.x0, 0.0),
        max(taken.x1 + margin - page.bbox.width, 0.0),
        max(floor - taken.y0, 0.0),
        max(taken.y1 + margin - page.bbox.height, 0.0),
    )


def check_room(axes: Sequence[Axes]) -> None:
    """Raise `ParameterError` if a bar and a legend leave no room for the panels of a reader's axes."""
    figure: Any = axes[0].get_figure(root=True)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        figure.draw_without_rendering()  # sets the sizes
    collapsed = any("collapsed to zero" in str(each.message) for each in caught)
    sides = [side for ax in axes for side in (ax.bbox.width, ax.bbox.height)]
    left = 25.4 * min(sides) / figure.dpi
    rule = "must have room beside a colour bar and a legend: larger axes, or legend=False"
    said = f"{left:.0f} mm for the panel"
    if collapsed:
        said = "nothing for the panel"
    enough = not collapsed and left >= LEAST_PANEL
    require((enough, "ax", said, rule))
