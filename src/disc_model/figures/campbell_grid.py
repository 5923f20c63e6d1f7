"""The grid of panels of a new Campbell diagram, or of a reader's axes for one."""

import math
from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.figures.campbell_panels import FREQUENCY, HEIGHT, RATE
from disc_model.figures.canvas import Page, Wishes, page_for
from disc_model.figures.drawing import COLUMN, PAGE, large
from disc_model.figures.head_texts import what_case
from disc_model.figures.named_axes import Quantities
from disc_model.figures.sweep_titles import values_of
from disc_model.figures.types import Axes
from disc_model.figures.words import label_of

OF_SEVERAL = 4.4  # inch of each of several bands of panels
MOST_ACROSS = 3  # panels beside each other in a new figure


class Grid(NamedTuple):
    """The places of panels: so many bands of two rows, and so many panels across."""

    bands: int
    across: int


def grid_for(count: int, *, is_own: bool) -> Grid:
    """The grid of so many columns of panels: a reader's axes are in one band, and a new figure has at most
    `MOST_ACROSS` beside each other."""
    if not is_own:
        return Grid(1, count)
    bands = math.ceil(count / MOST_ACROSS)
    return Grid(bands, math.ceil(count / bands))


def page_of(wishes: Wishes, grid: Grid, study: xr.Dataset) -> AbstractContextManager[Page]:
    """The page of such a grid, for a study whose case the title says."""
    case = what_case(values_of(study))
    width = COLUMN if grid.across == 1 else PAGE
    height = HEIGHT if grid.bands == 1 else grid.bands * OF_SEVERAL
    shared: dict[str, Any] = {"sharex": True, "sharey": "row"}
    shared["height_ratios"] = [3, 2] * grid.bands
    rows = 2 * grid.bands
    return page_for(wishes, width, height, rows, grid.across, title=case, **shared)


def panels_of(page: Page, grid: Grid, count: int) -> tuple[list[Axes], list[Axes]]:
    """The panels of frequencies and those of growth rates, as many as are drawn; others are removed."""
    rows = np.array(page.axes, dtype=object).reshape(2 * grid.bands, grid.across)
    above = [*rows[0::2].flat]
    below = [*rows[1::2].flat]
    for ax in (*above[count:], *below[count:]):
        page.remove(ax)
    return above[:count], below[:count]


def say_quantities(page: Page, above: Sequence[Axes], speeds: xr.DataArray) -> None:
    """Say what panels show over a speed: frequencies in the upper ones, and growth rates in all others."""
    across, _ = label_of(speeds)
    frequencies = Quantities(across, FREQUENCY)
    rates = Quantities(across, " ".join(RATE.split()))
    page.show(*(frequencies if ax in above else rates for ax in page.axes))


def name_panels(page: Page, panels: Sequence[Axes], names: Sequence[str]) -> None:
    """Write the value of a further axis above each panel; also where the values of the case stand above the
    first one."""
    page.note = names[0]
    for ax, name in zip(panels, names, strict=True):
        if name:
            ax.set_title(name, loc="left", fontsize=large(8))


def with_name_below(title: str | bool | None, name: str) -> str | bool | None:
    """The title that a reader wants above the first panel, with the name of this panel below it."""
    if isinstance(title, str) and title and name:
        return f"{title}\n{name}"
    return title
