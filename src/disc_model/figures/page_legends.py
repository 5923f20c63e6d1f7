"""The legend of a picture: its entries, those of pictures on the same axes, and where it stands."""

from collections.abc import Collection, Mapping, Sequence
from itertools import chain
from typing import Any

from disc_model.errors import Fault, ParameterError
from disc_model.figures.covered import twins_of
from disc_model.figures.entries import keep_entries
from disc_model.figures.labels import is_square
from disc_model.figures.legend_samples import in_order, write_notes
from disc_model.figures.legends import (
    figure_legend,
    keep_share,
    legend_below,
    legend_beside,
    legend_inside,
    small,
)
from disc_model.figures.pages import OWN, Page, Wishes
from disc_model.figures.symbols import without_font
from disc_model.figures.types import Artist, Axes

MANY = 8  # entries of a legend of a new figure beyond which their text is smaller
SAMPLE = 2.0  # length of their samples over this size: a whole period of dashes
PLACED = "_disc_model_placed"
"""Attribute of a legend that was placed for its reader: its picture, and what was asked of it."""
PLACING = ("loc", "bbox_to_anchor")
"""Options of a legend that say where it stands."""


def _joined(
    axes: Sequence[Axes], handles: Sequence[Artist], replaced: Collection[str]
) -> list[Artist]:
    """The entries of the legend that axes have, or that their figure has of them alone, but some
    that are replaced, and others whose words are not among these; the legend is removed."""
    figure: Any = axes[0].get_figure()
    former: list[Any] = [*filter(None, (ax.get_legend() for ax in axes))]
    if set(figure.axes) <= set(axes):
        former += figure.legends
    elif figure.get_gid() == OWN:  # other panels have the entries too
        former += figure.legends
        replaced = ()
    entries: dict[str, Artist] = {}
    for legend in former:
        for handle in _entries_of(legend):
            words = str(handle.get_label())
            if words not in replaced:
                entries.setdefault(words, handle)
        legend.remove()
    for handle in handles:
        entries.setdefault(str(handle.get_label()), handle)
    return [*entries.values()]


def _entries_of(legend: Any) -> list[Artist]:
    """The entries of a legend, labelled by their words."""
    for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True):
        words = without_font(text.get_text()).replace("\n", " ")  # long ones stand in lines
        handle.set_label(words)
    return [*legend.legend_handles]


def _joined_with_twins(page: Page) -> list[Artist]:
    """The entries of legends of pictures on the same place, such as the other axes of ``ax.twinx()``,
    and those of a page, each look and words once; these legends are removed, but such that a reader
    has placed."""
    entries: dict[Any, Artist] = {}
    for twin in chain.from_iterable(map(twins_of, page.axes)):
        legend: Any = twin.get_legend()
        if legend is None or PLACED not in vars(legend) or legend.get_title().get_text():
            continue
        for handle in _entries_of(legend):
            if str(handle.get_label()) not in page.replaced:
                entries[_seen_as(handle)] = handle
        legend.remove()
    for handle in page.handles:
        entries.setdefault(_seen_as(handle), handle)
    return [*entries.values()]


def _seen_as(handle: Artist) -> tuple[str, ...]:
    """What tells an entry of a legend from others: its words and its look."""
    looks = ("label", "color", "facecolor", "linestyle", "marker", "hatch")
    return tuple(str(getattr(handle, f"get_{look}", str)()) for look in looks)


def write_legend(page: Page, wishes: Wishes) -> None:
    """Write the legend, if there is one, in the look that the reader's options give: in their place,
    or else below a new figure, or inside a reader's axes or below them."""
    if wishes.legend is False:
        keep_entries(page)
        return
    if not page.handles:
        return
    if page.joins and not page.own:
        page.handles = _joined(page.axes, page.handles, page.replaced)
    look: dict[str, Any] = {"title": page.heading}
    if isinstance(wishes.legend, Mapping):
        look |= _checked_look(page, wishes.legend)
    if any(name in look for name in PLACING):
        handles = in_order(page.handles)
        placed = page.ax.legend(handles=handles, **look)
        write_notes(placed, handles)
    elif page.figure.get_gid() == OWN:
        size = {}
        if page.is_small or len(page.handles) > MANY:
            size = {**small(), "handlelength": SAMPLE}
        legend = figure_legend(page.figure, page.handles, **{**size, **look})
        keep_share(page.figure, legend)
    else:
        page.handles = _joined_with_twins(page)
        _place_legend(page, look)


def _checked_look(page: Page, options: Mapping[str, Any]) -> dict[str, Any]:
    """The options of a legend by their newer names; raises `ParameterError` if matplotlib refuses
    one."""
    look = dict(options)
    if "ncol" in look:
        look["ncols"] = look.pop("ncol")
    try:
        page.ax.legend(handles=list(page.handles), **look).remove()
    except (TypeError, ValueError) as error:
        raise ParameterError(Fault.of(("legend",), options, str(error))) from None
    return look


def _place_legend(page: Page, look: Mapping[str, Any]) -> None:
    """Write the legend inside a reader's axes, beside a square panel, or below the axes."""
    page.legend = None
    if page.beside == "inside":
        page.legend = legend_inside(page.ax, page.handles, **look)
    if page.beside != "below" and page.legend is None and is_square(page.ax):
        page.beside = "beside"
        anchor = page.ax.get_anchor()
        page.ax.set_anchor("W")  # so that all room is on one side
        page.legend = legend_beside(page.ax, page.handles, **look)
        if page.legend is None:
            page.ax.set_anchor(anchor)
    if page.legend is None:
        page.beside = "below"
        last = page.axes[-1]
        page.legend = legend_below(last, page.handles, page.beside_last, page.spare, **look)
