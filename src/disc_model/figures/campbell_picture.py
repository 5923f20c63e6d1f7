"""A Campbell diagram of a study on a reader's axes."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.campbell import column_of, highest_of
from disc_model.figures.campbell_arguments import checked_study, dims_of_columns
from disc_model.figures.campbell_grid import (
    grid_for,
    name_panels,
    page_of,
    panels_of,
    say_quantities,
    with_name_below,
)
from disc_model.figures.campbell_legend import entries_of
from disc_model.figures.campbell_names import name_peaks
from disc_model.figures.campbell_panels import FREQUENCY, draw_panels
from disc_model.figures.canvas import Wishes
from disc_model.figures.drawn_units import in_readers_units
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.named_axes import check_free


@in_readers_units
def plot_campbell(
    study: xr.Dataset,
    *,
    highest: float | str | None = None,
    multiples: Sequence[float] | None = None,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
) -> np.ndarray:
    """Draw frequencies, multiples and growth rates over the speed, as `disc_model.plot_campbell`
    describes."""
    drawn, limit = checked_study(study, highest, multiples)
    asked_for = () if multiples is None else tuple(multiples)
    by = next(iter(dims_of_columns(drawn)), None)
    parts = parts_shown(drawn, by)
    columns = [column_of(part.data.transpose("Omega", ...)) for part in parts]
    shown = limit or highest_of(columns)
    names = titles_of_panels(parts, drawn, by)
    if ax is not None:
        title = with_name_below(title, names[0])
    wishes = Wishes(ax, legend, labels, title)
    grid = grid_for(len(parts), is_own=ax is None)
    with page_of(wishes, grid, drawn) as page:
        check_free(page.axes, FREQUENCY, "a Campbell diagram")
        above, below = panels_of(page, grid, len(parts))
        say_quantities(page, above, drawn["Omega"])
        draw_panels(above, below, columns, shown, asked_for)
        name_panels(page, above, names)
        for top, bottom, column in zip(above, below, columns, strict=True):
            name_peaks(top, bottom, column, shown, asked_for)
        page.is_small = True
        page.explain(entries_of(columns, shown, asked_for), beside="below")
    return np.array([above, below] if by else [*above, *below], dtype=object)
