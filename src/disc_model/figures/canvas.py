"""The page of a picture that a result draws of itself: a figure of its own, or a reader's axes, and
what the reader asks of its legend, labels and title."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from typing import Any

from matplotlib import pyplot
from matplotlib.text import Text

from disc_model.figures.case_titles import title_text
from disc_model.figures.drawing import large
from disc_model.figures.labels import break_labels, set_upright
from disc_model.figures.legends import keep_height
from disc_model.figures.pages import OWN, given_axes, restate, write_legend
from disc_model.figures.pages import Page as Page  # a page is asked for with wishes
from disc_model.figures.pages import Wishes as Wishes
from disc_model.figures.placing import check_room, stack_narrow
from disc_model.figures.room import make_room, set_own_upright
from disc_model.figures.shared_labels import clear_repeated
from disc_model.figures.style import readers_style


@contextmanager
def page_for(
    wishes: Wishes,
    width: float,
    height: float,
    rows: int = 1,
    columns: int = 1,
    *,
    title: str = "",
    stacked: float = 0.0,
    **shared: Any,
) -> Iterator[Page]:
    """The page of a picture, which is finished by its legend, labels and title.

    A new figure has a size in inches, the style of this package where the reader has none, and a
    title with the values of a case. A reader's axes keep their figure's title. Those of a row in a
    narrow figure without others are set below each other, each of a height `stacked` in inches, if
    there is one.
    """
    wishes.check()
    if wishes.ax is not None:
        asked = wishes.labels or {}
        page = Page(given_axes(wishes.ax, rows * columns), own=False, asked=asked, case=title)
        if stacked:
            stack_narrow(page.axes, stacked)
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
                set_upright(figure.findobj(Text))
            else:
                set_own_upright(figure)
        return
    with readers_style():
        figure = pyplot.figure(figsize=(width, height), layout="constrained")
        figure.set_gid(OWN)
        panels = list(figure.subplots(rows, columns, squeeze=False, **shared).flat)
        page = Page(panels, own=True, asked=wishes.labels or {})
        try:
            yield page
            page.bars = [ax for ax in figure.axes if ax not in page.axes]
            above = title_text(width, "", wishes.title)
            if wishes.has_usual_title:
                above = title_text(width, title)
            if above:
                figure.suptitle(above, fontsize=large(8))
            restate(page, wishes)
            write_legend(page, wishes)
            break_labels(figure)
            page.remember()
            if page.is_map:
                keep_height(figure, page.axes)
            set_upright(figure.findobj(Text))
        except BaseException:
            pyplot.close(figure)  # a notebook would show it, half drawn
            raise


def _finish(page: Page, wishes: Wishes) -> None:
    """Write labels, title and legend on a reader's axes."""
    figure: Any = page.ax.get_figure(root=True)
    restate(page, wishes)
    shown = [*page.axes, *page.bars]
    break_labels(figure, shown)  # long ones would leave the legend no room
    write_legend(page, wishes)
    break_labels(figure, shown)  # of axes that may be lower or narrower now
    if page.beside == "below":  # also below labels that have more lines now
        write_legend(page, wishes)
    make_room(page, wishes)
    if page.bars:
        check_room(page.axes)
