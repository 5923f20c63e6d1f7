"""Campbell diagrams: frequencies and growth rates against the speed."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from disc_model.figures.campbell_legend import entries_of
from disc_model.figures.campbell_names import name_peaks
from disc_model.figures.campbell_panels import draw_panels
from disc_model.figures.campbell_peaks import Column, peaks
from disc_model.figures.drawing import letters, panels
from disc_model.figures.kinds.motions import Campbell
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.legends import figure_legend
from disc_model.figures.selection import NORM, normalizations
from disc_model.figures.types import Figure

ROOM = 1.06  # highest frequency of the axis over that of the modes


def draw(plot: Campbell, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw frequencies above growth rates, a column for each value of the compared dimension."""
    if NORM in study.dims and (plot.normalization is not None or plot.by != NORM):
        chosen = plot.normalization or normalizations(study)[0]
        study = study.sel({NORM: chosen})
    parts = parts_shown(study, plot.by, plot.names)
    width = plot.inches
    figure, axes = panels(
        width, 5.4, 2, len(parts), height_ratios=[3, 2], sharex=True, sharey="row"
    )
    above = axes[: len(parts)]
    below = axes[len(parts) :]
    columns = [column_of(part.data.transpose("Omega", ...)) for part in parts]
    highest = plot.highest or highest_of(columns)
    draw_panels(above, below, columns, highest, plot.multiples)
    letters(axes, titles_of_panels(parts, study, plot.by))
    for top, bottom, column in zip(above, below, columns, strict=True):
        name_peaks(top, bottom, column, highest)
    _legend(figure, columns, highest, plot.multiples)
    return figure


def column_of(study: xr.Dataset) -> Column:
    """The column of a study, whose peaks are found here for all that is drawn and said of them."""
    return Column(study, [*peaks(study)])


def highest_of(columns: Sequence[Column]) -> float:
    """The upper end of an axis that shows all frequencies, Hz."""
    return ROOM * max(float(column.study["sliding_frequency"].max()) for column in columns)


def _legend(
    figure: Figure,
    columns: Sequence[Column],
    highest: float = np.inf,
    multiples: Sequence[int] = (),
) -> None:
    """Name lines, marks and bands that are drawn."""
    figure_legend(figure, entries_of(columns, highest, multiples), columns=3)
