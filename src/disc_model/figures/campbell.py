"""Campbell diagrams: frequencies and growth rates against the speed."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from disc_model.figures.campbell_legend import entries_of
from disc_model.figures.campbell_names import name_peaks
from disc_model.figures.campbell_panels import HEIGHT, draw_panels
from disc_model.figures.campbell_peaks import Column, peaks
from disc_model.figures.drawing import PAGE, letters, panels
from disc_model.figures.kinds.motions import Campbell
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.legends import figure_legend
from disc_model.figures.selection import NORM, normalizations
from disc_model.figures.types import Axes, Figure

STACKED = 3.2  # inch, of each of several pairs below each other
LEGEND = 2.4  # inch, of the legend below these
ROOM = 1.06  # highest frequency of the axis over that of the modes


def draw(plot: Campbell, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw frequencies above growth rates, for each value of the compared dimension: beside each other on a
    page, and below each other in one column."""
    if NORM in study.dims and (plot.normalization is not None or plot.by != NORM):
        chosen = plot.normalization or normalizations(study)[0]
        study = study.sel({NORM: chosen})
    parts = parts_shown(study, plot.by, plot.names)
    figure, above, below = _panels_of(plot.inches, len(parts))
    columns = [column_of(part.data.transpose("Omega", ...)) for part in parts]
    highest = plot.highest or highest_of(columns)
    draw_panels(above, below, columns, highest, plot.multiples)
    titles = titles_of_panels(parts, study, plot.by)
    if _are_stacked(plot.inches, len(parts)):
        _letter_pairs(above, below, titles)
    else:
        letters([*above, *below], titles)
    for top, bottom, column in zip(above, below, columns, strict=True):
        name_peaks(top, bottom, column, highest, plot.multiples)
    _legend(figure, columns, highest, plot.multiples)
    return figure


def _are_stacked(width: float, count: int) -> bool:
    """Whether so many pairs of panels stand below each other, as there is no room beside each other."""
    return width < PAGE and count > 1


def _panels_of(width: float, count: int) -> tuple[Figure, list[Axes], list[Axes]]:
    """A figure with so many pairs of panels: of frequencies, and of growth rates below them."""
    heights = [3, 2]
    if not _are_stacked(width, count):
        figure, axes = panels(
            width, HEIGHT, 2, count, height_ratios=heights, sharex=True, sharey="row"
        )
        return figure, axes[:count], axes[count:]
    size = STACKED * count + LEGEND
    figure, axes = panels(width, size, 2 * count, height_ratios=heights * count, sharex=True)
    above = axes[::2]
    below = axes[1::2]
    for row in (above, below):
        for ax in row[1:]:
            ax.sharey(row[0])
    return figure, above, below


def _letter_pairs(above: Sequence[Axes], below: Sequence[Axes], titles: Sequence[str]) -> None:
    """Write the letters of pairs of panels below each other, and the subjects of the upper ones."""
    in_order = [ax for pair in zip(above, below, strict=True) for ax in pair]
    subjects = [text for title in titles for text in (title, "")]
    letters(in_order, subjects)
    for ax in in_order[:-1]:
        ax.set_xlabel("")


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
    multiples: Sequence[float] = (),
) -> None:
    """Name lines, marks and bands that are drawn."""
    figure_legend(figure, entries_of(columns, highest, multiples), columns=3)
