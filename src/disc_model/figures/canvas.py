"""The page of a picture that a result draws of itself: a figure of its own, or a reader's axes, and
what the reader asks of its legend, labels and title."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from matplotlib import pyplot
from matplotlib.text import Text

from disc_model.figures.case_titles import title_text
from disc_model.figures.drawing import large
from disc_model.figures.labels import break_labels
from disc_model.figures.legends import LEAST_CURVE, LEAST_MAP, keep_height
from disc_model.figures.page_legends import write_legend
from disc_model.figures.pages import OWN, restate
from disc_model.figures.pages import Page as Page  # a page is asked for with wishes
from disc_model.figures.pages import Wishes as Wishes
from disc_model.figures.readers_axes import page_on_axes
from disc_model.figures.style import readers_style
from disc_model.figures.symbols import set_upright


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
        with page_on_axes(wishes, rows * columns, title, stacked) as page:
            yield page
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
            keep_height(figure, page.axes, LEAST_MAP if page.is_map else LEAST_CURVE)
            set_upright(figure.findobj(Text))
        except BaseException:
            pyplot.close(figure)  # a notebook would show it, half drawn
            raise
