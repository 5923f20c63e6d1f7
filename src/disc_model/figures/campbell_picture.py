"""A Campbell diagram of a study on a reader's axes."""

import math
from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.figures.campbell import column_of, highest_of
from disc_model.figures.campbell_arguments import checked_study, dims_of_columns
from disc_model.figures.campbell_legend import entries_of
from disc_model.figures.campbell_names import name_peaks
from disc_model.figures.campbell_panels import FREQUENCY, RATE, draw_panels
from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.drawing import COLUMN, PAGE, large
from disc_model.figures.head_texts import what_case
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.named_axes import Quantities, check_free
from disc_model.figures.sweep_titles import values_of
from disc_model.figures.types import Axes
from disc_model.figures.words import SPEED

HEIGHT = 5.4  # inch, with its legend
OF_SEVERAL = 4.4  # inch of each of several bands of panels
MOST_ACROSS = 3  # panels beside each other in a new figure


def plot_campbell(
    study: xr.Dataset,
    *,
    highest: float | str | None = None,
    multiples: Sequence[int] = (),
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> np.ndarray:
    """Draw frequencies, multiples and growth rates over the speed, as `disc_model.plot_campbell`
    describes."""
    drawn, limit = checked_study(study, highest, multiples)
    by = next(iter(dims_of_columns(drawn)), None)
    parts = parts_shown(drawn, by)
    columns = [column_of(part.data.transpose("Omega", ...)) for part in parts]
    shown = limit or highest_of(columns)
    if by and ax is not None and isinstance(title, str) and title:
        title += "\n"  # names of panels stand below it
    wishes = Wishes(ax, legend, labels, title)
    grid = _grid_for(len(parts), is_own=ax is None)
    with _page_for(wishes, grid, what_case(values_of(drawn))) as page:
        check_free(page.axes, FREQUENCY, "a Campbell diagram")
        above, below = _panels_of(page, grid, len(parts))
        frequencies = Quantities(SPEED, FREQUENCY)
        rates = Quantities(SPEED, " ".join(RATE.split()))
        page.show(*(frequencies if ax in above else rates for ax in page.axes))
        draw_panels(above, below, columns, shown, multiples)
        _name_panels(page, above, titles_of_panels(parts, drawn, by))
        for top, bottom, column in zip(above, below, columns, strict=True):
            name_peaks(top, bottom, column, shown)
        page.is_small = True
        page.explain(entries_of(columns, shown, multiples), beside="below")
    return np.array([above, below] if by else [*above, *below], dtype=object)


def _name_panels(page: Page, panels: Sequence[Axes], names: Sequence[str]) -> None:
    """Write the value of a further axis above each panel; also where the values of the case stand above the
    first one."""
    page.note = names[0]
    for ax, name in zip(panels, names, strict=True):
        if name:
            ax.set_title(name, loc="left", fontsize=large(8))


class Grid(NamedTuple):
    """The places of panels: so many bands of two rows, and so many panels across."""

    bands: int
    across: int


def _grid_for(count: int, *, is_own: bool) -> Grid:
    """The grid of so many columns of panels: a reader's axes are in one band, and a new figure has at most
    `MOST_ACROSS` beside each other."""
    if not is_own:
        return Grid(1, count)
    bands = math.ceil(count / MOST_ACROSS)
    return Grid(bands, math.ceil(count / bands))


def _page_for(wishes: Wishes, grid: Grid, case: str) -> AbstractContextManager[Page]:
    """The page of such a grid."""
    width = COLUMN if grid.across == 1 else PAGE
    height = HEIGHT if grid.bands == 1 else grid.bands * OF_SEVERAL
    shared: dict[str, Any] = {"sharex": True, "sharey": "row"}
    shared["height_ratios"] = [3, 2] * grid.bands
    rows = 2 * grid.bands
    return page_for(wishes, width, height, rows, grid.across, title=case, **shared)


def _panels_of(page: Page, grid: Grid, count: int) -> tuple[list[Axes], list[Axes]]:
    """The panels of frequencies and those of growth rates, as many as are drawn; others are removed."""
    rows = np.array(page.axes, dtype=object).reshape(2 * grid.bands, grid.across)
    above = [*rows[0::2].flat]
    below = [*rows[1::2].flat]
    for ax in (*above[count:], *below[count:]):
        page.remove(ax)
    return above[:count], below[:count]
