"""Heat maps: any variable in colour over two dimensions."""

import math
from collections.abc import Mapping

import xarray as xr

from disc_model.figures.colour_maps import draw_maps
from disc_model.figures.colour_wishes import ColourWishes
from disc_model.figures.drawing import COLUMN, letters, panels
from disc_model.figures.kinds.base import NORM
from disc_model.figures.kinds.general import General, HeatMap
from disc_model.figures.left_out import parts_shown, titles_of_panels
from disc_model.figures.legends import figure_legend
from disc_model.figures.selection import Part, picked, remaining
from disc_model.figures.settled_motions import without_zeros
from disc_model.figures.types import Figure

IN_A_ROW = 4  # panels on a page


def draw(plot: HeatMap, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw a panel for each value of a third dimension, on one scale of colours."""
    parts = parts_of(plot, study)
    width = plot.inches_of(len(parts))
    columns = 1
    if width != COLUMN:
        lines = math.ceil(len(parts) / IN_A_ROW)
        columns = math.ceil(len(parts) / lines)
    rows = math.ceil(len(parts) / columns)
    figure, axes = panels(width, 2.9 * rows, rows, columns, sharex=True, sharey=True)
    for ax in axes[len(parts) :]:
        ax.remove()
    axes = axes[: len(parts)]
    planes = [part.data.transpose(plot.y, plot.x, ...) for part in parts]
    wishes = ColourWishes(log=plot.log, limits=plot.limits)
    key = draw_maps(figure, axes, planes, plot.variable, wishes)

    titles = titles_of_panels(parts, study, plot.by or NORM)
    # a value stays beside its name
    letters(axes, [title.replace(" = ", "\u00a0=\u00a0") for title in titles])
    for ax in axes:
        ax.label_outer()
    for ax in axes[-columns:]:  # below some of them there is none
        ax.set_xlabel(axes[-1].get_xlabel())
        ax.tick_params(labelbottom=True)
    figure_legend(figure, key.handles, title=key.title)
    return figure


def parts_of(plot: General, study: xr.Dataset) -> list[Part[xr.Dataset]]:
    """The parts of a study in the panels of a general figure."""
    chosen = picked(without_zeros(study), plot.at, *plot.axes.values())
    by = remaining(chosen[plot.variable], [*plot.axes.values()])
    return parts_shown(chosen, by, plot.names)
