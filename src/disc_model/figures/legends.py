"""Legends that stay inside the page, whatever they say and however narrow it is."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from textwrap import fill
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rcParams
from matplotlib.font_manager import FontProperties
from matplotlib.transforms import Bbox, ScaledTranslation, Transform

from disc_model.figures.covered import covers, other_legends, twins_of
from disc_model.figures.head_texts import CHARACTER
from disc_model.figures.legend_samples import draw_legend
from disc_model.figures.places import has_settled, set_places
from disc_model.figures.symbols import broken
from disc_model.figures.types import Artist, Axes, FigureBase, Legend

PAGE_SHARE = 0.98  # of the width of a figure that its legend may have
NARROWEST = 12  # characters to which a name is broken at most
EDGE = 0.04  # inch, kept free beside a legend above a panel
BESIDE = 0.15  # inch, left free on both sides of a legend below a panel, together
LEFT = 0.02  # inch, least distance of such a legend from the left edge of the figure
SPREAD = 0.04  # share of its width by which it may be wider in other resolutions
HALF_GAP = 0.03  # inch, and from the middle between its axes and those beside them
PLACES = (
    "upper right",
    "upper left",
    "lower left",
    "lower right",
    "center left",
    "center right",
    "lower center",
    "upper center",
    "center",
)
"""Of a legend in axes, in the order of matplotlib."""
SMALLER = 0.8  # size of the text of a legend that finds too little room, over the usual one,
STILL_SMALLER = 0.65  # where many entries would stand in one column,
LEAST_TEXT = 6.0  # and its least size, points, unless the usual one is less
IN_A_ROW = 3  # entries below a panel for which no text is made smaller
PRINTED = (150, 300)
"""Resolutions, dots per inch, in which figures are saved beside that in which they are shown."""
ROUNDED = 0.1  # share by which a legend may be wider there
LEAST_HEIGHT = 1.05  # inch, that a panel keeps above its legend if a smaller one leaves it so much
LEAST_MAP = 1.6  # inch, height that a map keeps beside its legend
LEAST_CURVE = 1.2  # inch, and height that curves keep
LEGEND_SHARE = 0.25  # of the height of a new figure, beyond which a legend makes it higher
MOVES = 2  # of a legend below a panel after it has changed the size of the panel
ANCHOR = "_disc_model_anchor"
"""Attribute of a legend below axes: where it hangs."""
ROUNDING = 1.0  # pixel, to which places are rounded
LETTER = 0.3  # inch, kept free for the letter of one of several panels


class Key(NamedTuple):
    """What a legend says: its entries, and a title for what they are, "" for none."""

    handles: Sequence[Artist]
    title: str = ""


def figure_legend(
    figure: FigureBase,
    handles: Sequence[Artist],
    *,
    loc: str = "outside lower right",
    columns: int = 0,
    **look: Any,
) -> Legend:
    """Draw a legend of a figure in as many columns as its width has room for.

    Parameters
    ----------
    figure : figure, or part of one, with a constrained layout
    handles : entries, with their labels; nothing is drawn without one
    loc : place, as `Figure.legend` has it
    columns : greatest number of columns, 0 for as many as entries
    look : further options of `Figure.legend`

    Returns
    -------
    the legend, or None
    """
    if not handles and not look.get("title"):
        return None
    page: Any = figure
    count = max(len(handles), 1)
    if look.get("title"):
        room = round(page.bbox.width / page.get_figure(root=True).dpi / CHARACTER)
        lines = [fill(line, room) for line in look["title"].splitlines()]
        look["title"] = "\n".join(lines)
    draw = partial(draw_legend, page, handles, loc=loc, **look)
    return _widest_that_fits(draw, min(columns or count, count), PAGE_SHARE * page.bbox.width)


def legend_above(
    ax: Axes, handles: Sequence[Artist] = (), *, columns: int = 4, **look: Any
) -> Legend:
    """Draw a legend above the right end of the axes, where it covers nothing, in as many columns
    as fit between the left edge of the page, or of the axes, and this end."""
    entries = list(handles) or ax.get_legend_handles_labels()[0]
    if not entries:
        return None
    draw = partial(
        draw_legend,
        ax,
        entries,
        loc="lower right",
        bbox_to_anchor=(1, 1),
        borderaxespad=0.2,
        **look,
    )
    return _widest_that_fits(draw, min(columns, len(entries)), _room_above(ax))


def legend_inside(ax: Axes, handles: Sequence[Artist] = (), **look: Any) -> Legend:
    """Draw a legend inside the axes, a smaller one if the usual one would cover data or words;
    nothing, and None, if that would as well."""
    entries = list(handles) or ax.get_legend_handles_labels()[0]
    if not entries:
        return None
    page: Any = ax.get_figure(root=True)
    legend: Legend = None
    set_places(page)  # in which the legend has no part
    for size in ({}, small()):
        legend = draw_legend(ax, entries, loc="best", **{**size, **look})
        # axes that others make narrower later would be squeezed by it
        legend.set_in_layout(False)
        for place in _places_inside(ax):
            legend.set_loc(place)
            if not covers(legend, ax):
                return legend
    legend.remove()
    return None


def _places_inside(ax: Axes) -> tuple[str, ...]:
    """Places of a legend in axes, in the order in which they are tried. The best one by matplotlib is
    the first of them, unless there are points, which it takes for the corners of a line."""
    for line in ax.lines:
        if line.get_linestyle() == "None" and np.size(line.get_xdata()) > 1:
            return PLACES
    return ("best", *PLACES)


def keep_height(figure: FigureBase, axes: Sequence[Axes], least: float = LEAST_MAP) -> None:
    """Make a figure so high that its legend and titles leave its panels a height in inches."""
    page: Any = figure
    set_places(page)  # sets the places
    lowest = min(ax.bbox.height for ax in axes) / page.dpi
    rows = {round(ax.bbox.y0) for ax in axes}
    if lowest < least:
        page.set_figheight(page.get_figheight() + len(rows) * (least - lowest))


def keep_share(figure: FigureBase, legend: Legend) -> None:
    """Make a figure so high that its legend takes no more than a share of it."""
    if legend is None:
        return
    page: Any = figure
    height = legend.get_window_extent().height / page.dpi
    usual = page.get_figheight()
    page.set_figheight(usual + max(height - LEGEND_SHARE * usual, 0.0))


def small(share: float = SMALLER) -> dict[str, Any]:
    """Options of a legend that needs little room: its text has a share of the usual size, and its
    samples are shorter."""
    usual = FontProperties(size=rcParams["legend.fontsize"]).get_size_in_points()
    size = min(usual, max(share * usual, LEAST_TEXT))
    return {
        "fontsize": size,
        "title_fontsize": size,
        "handlelength": 1.4,
        "handletextpad": 0.5,
        "labelspacing": 0.3,
        "columnspacing": 0.9,
        "borderpad": 0.3,
    }


def legend_beside(ax: Axes, handles: Sequence[Artist], **look: Any) -> Legend:
    """Draw a legend on the right of a panel, in one column of broken lines where there is no room for
    more, at the height of its middle; nothing, and None, if it has no room even then."""
    page: Any = ax.get_figure(root=True)
    set_places(page)  # sets the places
    gap = BESIDE * page.dpi
    width = _free_below(ax, ()).right - ax.bbox.x1 - gap
    for size in ({}, small()):
        offset = ScaledTranslation(gap / page.dpi, 0, page.dpi_scale_trans)
        draw = partial(
            draw_legend,
            ax,
            handles,
            loc="center left",
            bbox_to_anchor=(1, 0.5),
            bbox_transform=ax.transAxes + offset,
            **{"borderaxespad": 0, **size, **look},
        )
        legend = _widest_that_fits(draw, 1, width)
        # a layout would squeeze the panel, which has this room on its right anyway
        legend.set_in_layout(False)
        box = legend.get_window_extent()
        if box.width <= width and box.height <= page.bbox.height:
            return legend
        legend.remove()
    return None


def finds_room_beside(ax: Axes) -> bool:
    """Whether the legend on the right of a panel ends before what stands there."""
    legend: Legend = ax.get_legend()
    return bool(legend.get_window_extent().x1 <= _free_below(ax, ()).right + ROUNDING)


def legend_below(
    ax: Axes, handles: Sequence[Artist], bars: Sequence[Axes] = (), spare: float = 0.0, **look: Any
) -> Legend:
    """Draw a legend below the label of the horizontal axis, in as many columns as there is room for
    between the left end of the labels and the right end of the axes, or of bars of colours beside
    them, but a spare length in inches; a smaller one where the usual one is wider than that, or where
    many entries would stand in one column."""
    if not handles:
        return None
    page: Any = ax.get_figure(root=True)
    set_places(page)  # sets the places
    frame = ax.bbox
    beside = [box for bar in bars for box in _stands_below(bar)]  # labels may have more lines there
    depth = frame.y0 - min(box.y0 for box in (frame, *_stands_below(ax), *beside))
    free = _free_below(ax, bars)
    free = Sides(free.left, free.right - spare * page.dpi)
    own = _sides_of(ax, *bars)
    reach = max(frame.x0 - max(own.left, free.left), 0.0)

    # below the axes and bars where it fits, else below their labels too, else beyond their right end
    room = min(own.right, free.right) - frame.x0 - BESIDE * page.dpi
    widest = free.right - frame.x0
    looks: list[dict[str, Any]] = [{}, small(1.0), small(), small(STILL_SMALLER), small(0.0)]
    places = []
    usual = [(0.0, looks[0], room), *((reach, looks[0], width) for width in (room, widest))]
    for shift, size, width in [*usual, *((reach, each, widest) for each in looks[1:])]:
        # as far below the axes when the layout has made them smaller
        offset = ScaledTranslation(-shift / page.dpi, -depth / page.dpi, page.dpi_scale_trans)
        draw = partial(
            draw_legend,
            ax,
            handles,
            loc="upper left",
            bbox_to_anchor=(0, 0),
            bbox_transform=ax.transAxes + offset,
            **{**size, **look},
        )
        places.append(Place(draw, width + shift, looks.index(size)))
    if len(handles) <= IN_A_ROW:
        place = _first_that_fits(places[:4], len(handles))
    else:
        place = _first_that_fits(places, 2)
    smaller = [place, *places[places.index(place) + 1 :]]
    place = _first_low_enough(smaller, len(handles), _room_below(ax, depth))
    legend = _widest_that_fits(place.draw, len(handles), place.width)

    # a layout that made room on its sides would squeeze narrow axes, which do not hold it anyway
    legend.get_tightbbox = partial(_as_wide_as, ax, legend)

    # lower axes may have narrower numbers, and begin further to the left; the layout may move them
    # once more when the legend has its place
    setattr(legend, ANCHOR, Anchor(place.draw.keywords["bbox_transform"]))
    for _ in range(MOVES):
        set_places(page)
        move_to_page(ax, bars)
        if has_settled(page):
            break
    return legend


@dataclass
class Anchor:
    """Where a legend below axes hangs: a transform, and how far it was moved to the right in pixels."""

    transform: Transform
    across: float = 0.0


def move_to_page(ax: Axes, bars: Sequence[Axes] = ()) -> None:
    """Move the legend below axes to their middle, or as near to it as it is on the page, and clear of
    what stands beside the axes if it can."""
    legend: Legend = ax.get_legend()
    anchor: Anchor = getattr(legend, ANCHOR)
    free = _free_below(ax, bars)
    box = legend.get_window_extent()
    frame = Bbox.union([ax.bbox, *(bar.bbox for bar in bars)])
    middle = 0.5 * (frame.x0 + frame.x1)
    left = min(middle - 0.5 * box.width, free.right - (1 + SPREAD) * box.width)
    anchor.across += max(left, free.left) - box.x0
    legend.set_bbox_to_anchor((anchor.across / ax.bbox.width, 0), anchor.transform)


class Place(NamedTuple):
    """How a legend is drawn at a place, the width in pixels that it has there, and the number of its
    look: legends of one look are equally wide."""

    draw: partial[Legend]
    width: float
    look: int


def _first_that_fits(places: Sequence[Place], columns: int) -> Place:
    """The first place that is wide enough for so many columns, or for as many fewer as need be; the
    last one if none is."""
    for count in _columns_tried(places[0].draw, columns):
        widths: dict[int, float] = {}
        for place in places:
            if place.look not in widths:
                widths[place.look] = _width_in(place, count)
            if widths[place.look] <= place.width:
                return place
    return places[-1]


def _width_in(place: Place, columns: int) -> float:
    """The width in pixels of a legend at a place, in so many columns."""
    trial = place.draw(ncols=columns)
    width = printed_width(trial, place.width)
    trial.remove()
    return width


def printed_width(legend: Legend, width: float) -> float:
    """The width in pixels of a legend, the greatest of those that it has in usual resolutions if one of
    them may exceed a width: letters are rounded to pixels."""
    own = float(legend.get_window_extent().width)
    if not (1 - ROUNDED) * width < own <= width:
        return own
    page: Any = legend.get_figure(root=True)
    shown = page.dpi
    widths = [own]
    for dpi in PRINTED:
        page._set_dpi(dpi, forward=False)
        widths.append(legend.get_window_extent().width * shown / dpi)
    page._set_dpi(shown, forward=False)
    return max(widths)


def _first_low_enough(places: Sequence[Place], columns: int, height: float) -> Place:
    """The first place at which a legend in at most so many columns has no more than a height in pixels;
    the one at which it is lowest if there is none."""
    heights = []
    for place in places:
        trial = _widest_that_fits(place.draw, columns, place.width)
        heights.append(trial.get_window_extent().height)
        trial.remove()
        if heights[-1] <= height:
            return place
    return places[heights.index(min(heights))]


def _room_below(ax: Axes, depth: float) -> float:
    """The height in pixels that a legend can have on the page below the labels of axes, which reach so
    many pixels below these, if the axes keep their least height."""
    page: Any = ax.get_figure(root=True)
    box = ax.get_tightbbox()
    above = 0.0 if box is None else max(box.y1 - page.bbox.height, 0.0)
    room = ax.bbox.y1 - above - depth - LEAST_HEIGHT * page.dpi
    place = ax.get_subplotspec()
    if place is None or place.get_topmost_subplotspec().is_last_row():
        return float(room)
    return float("inf")


class Sides(NamedTuple):
    """Where something ends on the left and on the right, in pixels."""

    left: float
    right: float


def _sides_of(*axes: Axes) -> Sides:
    """The sides of axes with what stands beside them."""
    boxes: list[Bbox] = []
    for ax in axes:
        beside = ax.yaxis.get_tightbbox()
        boxes += [ax.bbox] if beside is None else [ax.bbox, beside]
    return Sides(min(box.x0 for box in boxes), max(box.x1 for box in boxes))


def _free_below(ax: Axes, bars: Sequence[Axes]) -> Sides:
    """Where a legend below axes may begin and end: halfway to what stands beside them in their row,
    or at the edges of the page."""
    page: Any = ax.get_figure(root=True)
    own = _sides_of(ax, *bars)
    gap = HALF_GAP * page.dpi
    left = LEFT * page.dpi
    right = page.bbox.width - LEFT * page.dpi
    for other in page.axes:
        if other is ax or other in bars:
            continue
        in_row = other.bbox.y0 < ax.bbox.y1 and other.bbox.y1 > ax.bbox.y0
        if in_row and other.bbox.x1 <= ax.bbox.x0:
            left = max(left, 0.5 * (_sides_of(other).right + own.left) + gap)
        elif in_row and other.bbox.x0 >= ax.bbox.x1:
            right = min(right, 0.5 * (own.right + _sides_of(other).left) - gap)
    return Sides(left, right)


def finds_room_below(ax: Axes, bars: Sequence[Axes] = ()) -> bool:
    """Whether the legend below axes stays clear of what stands beside them, and of their labels."""
    legend: Legend = ax.get_legend()
    box = legend.get_window_extent()
    free = _free_below(ax, bars)
    clear = box.count_overlaps(other_legends(ax)) == 0
    for each in _labels_below(ax):
        clear = clear and box.y1 <= each.y0 + ROUNDING
    return clear and box.x0 >= free.left - ROUNDING and box.x1 <= free.right + ROUNDING


def _labels_below(ax: Axes) -> list[Bbox]:
    """The extents of numbers and labels below axes and those on the same place."""
    boxes = [each.xaxis.get_tightbbox() for each in (ax, *twins_of(ax))]
    return [box for box in boxes if box is not None]


def _stands_below(ax: Axes) -> list[Bbox]:
    """The extents of what stands below axes already: labels, and legends of others on the same
    place."""
    legends = [box for box in other_legends(ax) if box.y1 <= ax.bbox.y0]
    return [*_labels_below(ax), *legends]


def finds_room_inside(ax: Axes) -> bool:
    """Whether the legend in axes covers nothing."""
    return not covers(ax.get_legend(), ax)


def _as_wide_as(ax: Axes, legend: Legend, renderer: Any = None) -> Bbox:
    """The extent of a legend in height, and of its axes in width."""
    box = legend.get_window_extent(renderer)
    return Bbox.from_extents(ax.bbox.x0, box.y0, ax.bbox.x1, box.y1)


def _room_above(ax: Axes) -> float:
    """Width, in pixels, that a legend above the axes can have: their own, or up to the left edge
    of the page where no axes are in between."""
    figure: Any = ax.get_figure(root=True)
    place = ax.get_subplotspec()
    if len(figure.axes) > 1:
        return float(ax.bbox.width - LETTER * figure.dpi)
    if place is None or not place.is_first_col():
        return float(ax.bbox.width)
    return float(ax.bbox.x1 - EDGE * figure.dpi)


def _columns_tried(draw: partial[Legend], most: int) -> Sequence[int]:
    """The numbers of columns among which that of a legend is chosen: the one asked for, if there is
    one, or all from the greatest one to 1."""
    asked = draw.keywords.get("ncols")
    return [asked] if asked else range(most, 0, -1)


def _widest_that_fits(draw: partial[Legend], most: int, width: float) -> Legend:
    """The legend in the greatest number of columns whose width in pixels it does not exceed; in
    one column of broken lines where even that is too wide."""
    *more, fewest = _columns_tried(draw, most)
    for count in more:
        legend = draw(ncols=count)
        if printed_width(legend, width) <= width:
            return legend
        legend.remove()
    legend = draw(ncols=fewest)
    said = [text.get_text() for text in (*legend.get_texts(), legend.get_title())]
    longest = max(map(len, said), default=0)
    while legend.get_window_extent().width > width and longest > NARROWEST:
        longest = max(NARROWEST, round(0.9 * longest))
        for text in (*legend.get_texts(), legend.get_title()):
            text.set_text(broken(text.get_text(), longest))
    return legend
