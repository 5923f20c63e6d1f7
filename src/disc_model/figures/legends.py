"""Legends that stay inside the page, whatever they say and however narrow it is."""

from collections.abc import Callable, Sequence
from functools import partial
from textwrap import fill
from typing import Any, NamedTuple

from disc_model.figures.types import Artist, Axes, FigureBase
from disc_model.figures.words import CHARACTER

PAGE_SHARE = 0.98  # of the width of a figure that its legend may have
NARROWEST = 12  # characters to which a name is broken at most
EDGE = 0.04  # inch, kept free beside a legend above a panel
LETTER = 0.3  # inch, kept free for the letter of one of several panels

Legend = Any


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
    draw = partial(page.legend, handles=list(handles), loc=loc, **look)
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
        ax.legend,
        handles=entries,
        loc="lower right",
        bbox_to_anchor=(1, 1),
        borderaxespad=0.2,
        **look,
    )
    return _widest_that_fits(draw, min(columns, len(entries)), _room_above(ax))


def legend_inside(ax: Axes, handles: Sequence[Artist] = (), **look: Any) -> Legend:
    """Draw a legend inside the axes, where it covers least."""
    entries = list(handles) or ax.get_legend_handles_labels()[0]
    return ax.legend(handles=entries, loc="best", **look) if entries else None


def legend_below(ax: Axes, handles: Sequence[Artist], **look: Any) -> Legend:
    """Draw a legend below the label of the horizontal axis, in as many columns as the axes are
    wide."""
    if not handles:
        return None
    page: Any = ax.get_figure(root=True)
    page.draw_without_rendering()  # sets the places
    lowest = ax.xaxis.get_tightbbox()
    bottom = 0.0 if lowest is None else ax.transAxes.inverted().transform((0, lowest.y0))[1]
    draw = partial(
        ax.legend, handles=list(handles), loc="upper left", bbox_to_anchor=(0, bottom), **look
    )
    return _widest_that_fits(draw, len(handles), float(ax.bbox.width))


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


def _widest_that_fits(draw: Callable[..., Legend], most: int, width: float) -> Legend:
    """The legend in the greatest number of columns whose width in pixels it does not exceed; in
    one column of broken lines where even that is too wide."""
    for count in range(most, 0, -1):
        legend = draw(ncols=count)
        if legend.get_window_extent().width <= width:
            return legend
        if count > 1:
            legend.remove()
    longest = max((len(text.get_text()) for text in legend.get_texts()), default=0)
    while legend.get_window_extent().width > width and longest > NARROWEST:
        longest = max(NARROWEST, round(0.9 * longest))
        for text in legend.get_texts():
            text.set_text(fill(text.get_text(), longest))
    return legend
