"""Room for the labels and legends of pictures on a reader's figure."""

from collections.abc import Mapping, Sequence
from itertools import chain
from typing import Any

from disc_model.figures.axis_numbers import part_numbers, spare_heights, spare_numbers
from disc_model.figures.colours import bars_of
from disc_model.figures.labels import break_labels
from disc_model.figures.legend_room import ROUNDS, SPARE, cramped_in, move_legends, remember_legend
from disc_model.figures.own_symbols import DRAWN_ON
from disc_model.figures.page_legends import write_legend
from disc_model.figures.pages import Page, Wishes
from disc_model.figures.places import set_places, ticks_once
from disc_model.figures.placing import fit_to_page, restore_margins
from disc_model.figures.types import Axes


def make_room(page: Page, wishes: Wishes) -> None:
    """Let axes, labels and legends of a reader's figure not meet, also those of former pictures,
    whose axes have other sizes since this one has been drawn."""
    figure: Any = page.ax.get_figure(root=True)
    remember_legend(page, wishes)
    DRAWN_ON.update(page.axes)
    panels = {ax: bars_of(ax) for ax in figure.axes if ax in DRAWN_ON}
    for ax in page.axes:
        part_numbers(ax)

    with ticks_once(figure):
        _find_places(page, panels)
    for ax, bars in panels.items():
        part_numbers(ax)
        spare_heights(ax)
        for bar in bars:
            spare_numbers(bar)
    move_legends(figure)


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
        cramped = cramped_in(figure)
        if not cramped:
            break
        for former, asked in cramped:
            former.spare += SPARE
            write_legend(former, asked)
            remember_legend(former, asked)
    if plain:
        fit_to_page(figure, panels)
