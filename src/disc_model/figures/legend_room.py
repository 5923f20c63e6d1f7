"""Room of legends on a reader's figure: which of them cover something, and those below axes."""

from collections.abc import Sequence
from typing import Any

from disc_model.figures.legends import (
    finds_room_below,
    finds_room_beside,
    finds_room_inside,
    move_to_page,
)
from disc_model.figures.page_legends import PLACED
from disc_model.figures.pages import Page, Wishes
from disc_model.figures.places import set_places
from disc_model.figures.types import Legend

ROUNDS = 4  # in which legends find their places after axes have got other sizes
SPARE = 0.03  # inch, which they leave free more in each: their height changes the width of axes


def _placed_on(figure: Any) -> dict[Legend, tuple[Page, Wishes]]:
    """The legends on a figure that were placed for their readers, and the pictures to which they belong."""
    found = {}
    for legend in filter(None, (ax.get_legend() for ax in figure.axes)):
        if PLACED in vars(legend):
            found[legend] = vars(legend)[PLACED]
    return found


def move_legends(figure: Any) -> None:
    """Set the legends of all panels in letters of one size, and move those below axes, which have other
    margins since they were placed, onto the page."""
    placed = _placed_on(figure)
    _set_in_one_size([legend for legend, (_, asked) in placed.items() if asked.legend is True])
    below = [page for page, _ in placed.values() if page.beside == "below"]
    if not below:
        return
    set_places(figure)  # sets the places
    for page in below:
        move_to_page(page.axes[-1], page.beside_last)


def _set_in_one_size(legends: Sequence[Legend]) -> None:
    """Set all legends in the letters of the smallest."""
    texts = [text for legend in legends for text in (*legend.get_texts(), legend.get_title())]
    least = min((text.get_fontsize() for text in texts), default=0.0)
    for text in texts:
        text.set_fontsize(least)


def remember_legend(page: Page, wishes: Wishes) -> None:
    """Note at the legend of a picture, if it was placed here, what it belongs to."""
    if page.legend is not None:
        vars(page.legend)[PLACED] = (page, wishes)


def cramped_in(figure: Any) -> list[tuple[Page, Wishes]]:
    """The pictures on a figure whose legends have no room, but those that a reader has placed and
    those that have found none in all rounds."""
    found = []
    for page, wishes in _placed_on(figure).values():
        if page.spare < ROUNDS * SPARE and not _finds_room(page):
            found.append((page, wishes))
    return found


def _finds_room(page: Page) -> bool:
    """Whether the legend of a picture covers nothing, and meets nothing beside it."""
    if page.beside == "below":
        return finds_room_below(page.axes[-1], page.beside_last)
    if page.beside == "beside":
        return finds_room_beside(page.ax)
    return finds_room_inside(page.ax)
