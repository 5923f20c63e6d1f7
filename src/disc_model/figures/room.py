"""Room for the labels and legends of pictures on a reader's figure."""

from collections.abc import Mapping, Sequence
from itertools import chain
from typing import Any
from weakref import WeakSet

from matplotlib.text import Text

from disc_model.figures.case_titles import case_above
from disc_model.figures.colours import bars_of
from disc_model.figures.labels import (
    break_labels,
    part_numbers,
    set_upright,
    spare_heights,
    spare_numbers,
)
from disc_model.figures.legends import (
    finds_room_below,
    finds_room_beside,
    finds_room_inside,
    move_to_page,
)
from disc_model.figures.named_axes import own_labels, shown_on
from disc_model.figures.page_legends import PLACED, write_legend
from disc_model.figures.pages import Page, Wishes
from disc_model.figures.places import set_places, ticks_once
from disc_model.figures.placing import fit_to_page, restore_margins
from disc_model.figures.types import Axes, Legend

ROUNDS = 4  # in which legends find their places after axes have got other sizes
SPARE = 0.03  # inch, which they leave free more in each: their height changes the width of axes
_DRAWN_ON: WeakSet[Axes] = WeakSet()
"""Axes of readers that have a picture of this package."""


def make_room(page: Page, wishes: Wishes) -> None:
    """Let axes, labels and legends of a reader's figure not meet, also those of former pictures,
    whose axes have other sizes since this one has been drawn."""
    figure: Any = page.ax.get_figure(root=True)
    _remember(page, wishes)
    _DRAWN_ON.update(page.axes)
    panels = {ax: bars_of(ax) for ax in figure.axes if ax in _DRAWN_ON}
    for ax in page.axes:
        part_numbers(ax)

    with ticks_once(figure):
        _find_places(page, panels)
    for ax, bars in panels.items():
        part_numbers(ax)
        spare_heights(ax)
        for bar in bars:
            spare_numbers(bar)
    _move_legends(figure)


def _find_places(page: Page, panels: Mapping[Axes, Sequence[Axes]]) -> None:
    """Give panels, with the bars of colours beside them, and legends their places."""
    figure: Any = page.ax.get_figure(root=True)
    plain = figure.get_layout_engine() is None
    if plain:
        restore_margins(figure)
        break_labels(figure, [*panels, *chain(*panels.values())])
    for _ in range(ROUNDS):
        if plain:
            fit_to_page(figure, panels)
        if len(panels) > len(page.axes):
            break_labels(figure, [*panels, *chain(*panels.values())])
        set_places(figure)  # sets the places
        cramped = _cramped_in(figure)
        if not cramped:
            break
        for former, asked in cramped:
            former.spare += SPARE
            write_legend(former, asked)
            _remember(former, asked)
    if plain:
        fit_to_page(figure, panels)


def _below_axes(figure: Any) -> dict[Legend, tuple[Page, Wishes]]:
    """The legends that were placed below axes, and the pictures to which they belong."""
    found = {}
    for legend in filter(None, (ax.get_legend() for ax in figure.axes)):
        page, wishes = vars(legend).get(PLACED, (None, None))
        if page is not None and page.beside == "below":
            found[legend] = (page, wishes)
    return found


def _move_legends(figure: Any) -> None:
    """Move legends below axes, which have other margins since they were placed, onto the page, with
    letters of one size."""
    placed = _below_axes(figure)
    if not placed:
        return
    _set_in_one_size([legend for legend, (_, asked) in placed.items() if asked.legend is True])
    set_places(figure)  # sets the places
    for page, _ in placed.values():
        move_to_page(page.axes[-1], page.beside_last)


def _set_in_one_size(legends: Sequence[Legend]) -> None:
    """Set all legends in the letters of the smallest."""
    texts = [text for legend in legends for text in (*legend.get_texts(), legend.get_title())]
    least = min((text.get_fontsize() for text in texts), default=0.0)
    for text in texts:
        text.set_fontsize(least)


def set_own_upright(figure: Any) -> None:
    """Set the symbols of all pictures on a reader's figure in upright letters; labels that the reader
    has written stay."""
    for ax in figure.axes:
        if ax not in _DRAWN_ON:
            continue
        own = own_labels(ax)
        labels = {"x": ax.xaxis.label, "y": ax.yaxis.label}
        set_upright(label for along, label in labels.items() if along not in own)
        set_upright(case_above(ax))
        for artist in filter(None, (*shown_on(ax).drawn, ax.get_legend())):
            set_upright(artist.findobj(Text))
        for bar in bars_of(ax):
            set_upright(bar.findobj(Text))


def _remember(page: Page, wishes: Wishes) -> None:
    """Note at the legend of a picture, if it was placed here, what it belongs to."""
    if page.legend is not None:
        vars(page.legend)[PLACED] = (page, wishes)


def _cramped_in(figure: Any) -> list[tuple[Page, Wishes]]:
    """The pictures on a figure whose legends have no room, but those that a reader has placed and
    those that have found none in all rounds."""
    found = []
    for legend in filter(None, (ax.get_legend() for ax in figure.axes)):
        page, wishes = vars(legend).get(PLACED, (None, None))
        if page is not None and page.spare < ROUNDS * SPARE and not _finds_room(page):
            found.append((page, wishes))
    return found


def _finds_room(page: Page) -> bool:
    """Whether the legend of a picture covers nothing, and meets nothing beside it."""
    if page.beside == "below":
        return finds_room_below(page.axes[-1], page.beside_last)
    if page.beside == "beside":
        return finds_room_beside(page.ax)
    return finds_room_inside(page.ax)
