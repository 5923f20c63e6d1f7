"""Pages on axes of a reader, whose figure keeps its style and its title."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from typing import Any

from disc_model.figures.gap_rows import allow_small_rows
from disc_model.figures.labels import break_labels
from disc_model.figures.legends import LEAST_CURVE, keep_height
from disc_model.figures.own_symbols import set_symbols
from disc_model.figures.page_legends import write_legend
from disc_model.figures.pages import OWN, Page, Wishes, given_axes, restate
from disc_model.figures.places import set_places, ticks_once
from disc_model.figures.placing import check_room, stack_narrow
from disc_model.figures.repeated_bars import leave_label_to_last
from disc_model.figures.room import make_room
from disc_model.figures.shared_labels import clear_repeated
from disc_model.figures.small_panels import remember_sides, warn_of_small_panels
from disc_model.figures.style import readers_style


@contextmanager
def page_on_axes(wishes: Wishes, count: int, case: str, stacked: float) -> Iterator[Page]:
    """The page of a picture on the axes of a reader, which is finished by its legend, labels and title.

    count : of its panels
    case : the values of its case, in words
    stacked : height in inches of axes of a row in a narrow figure, which are set below each other; 0 if they
        stay beside each other
    """
    asked = wishes.labels or {}
    page = Page(given_axes(wishes.ax, count), own=False, asked=asked, case=case)
    if stacked:
        stack_narrow(page.axes, stacked)
    remember_sides(page.axes)
    allow_small_rows(page.axes)
    figure: Any = page.ax.get_figure(root=True)
    before = set(figure.axes)
    # what is added to a figure of this package has its style
    style = readers_style() if figure.get_gid() == OWN else nullcontext()
    with style:
        yield page
        page.bars = [ax for ax in figure.axes if ax not in before]
        with warnings.catch_warnings():  # of sizes before everything has its place
            warnings.filterwarnings("ignore", message="constrained_layout not applied")
            page.keep_labels()
            _finish(page, wishes)
        page.remember()
        clear_repeated(page.axes)
        if figure.get_gid() == OWN:
            keep_height(figure, page.axes, LEAST_CURVE)
        set_symbols(figure)
    warn_of_small_panels(figure)


def _finish(page: Page, wishes: Wishes) -> None:
    """Write labels, title and legend on a reader's axes."""
    figure: Any = page.ax.get_figure(root=True)
    if page.bars and wishes.title is True:
        set_places(figure)  # a title fits the panel beside its bar
    restate(page, wishes)
    shown = [*page.axes, *page.bars, *leave_label_to_last(page)]
    break_labels(figure, shown)  # long ones would leave the legend no room
    former = _legends_in_layout(figure)
    with ticks_once(figure):
        write_legend(page, wishes)
        others = _legends_in_layout(figure) != former or page.beside != "inside"
        if figure.get_layout_engine() is not None and others:  # which makes axes smaller
            break_labels(figure, shown)
            if page.beside == "below":  # also below labels that have more lines now
                write_legend(page, wishes)
    make_room(page, wishes)
    if page.bars:
        check_room(page.axes)


def _legends_in_layout(figure: Any) -> list[Any]:
    """The legends of a figure and of its axes for which a layout makes room."""
    legends = [*figure.legends, *(ax.get_legend() for ax in figure.axes)]
    return [legend for legend in legends if legend is not None and legend.get_in_layout()]
