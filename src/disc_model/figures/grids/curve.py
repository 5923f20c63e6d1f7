"""Curves: any variable of a grid study against any one of its dimensions."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.figure import Figure

from disc_model.figures import parts
from disc_model.figures.grids.kinds import CurvePlot
from disc_model.figures.parts import BLACK, COLUMN, new_figure, styled


@styled()
def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: CurvePlot) -> Figure:
    """A line, or one for each value of a second dimension; crosses at the axis where there is no value."""
    found = parts.picked(study, plot.variable, plot.at)
    by = next((str(name) for name in found.dims if name != plot.x), None)
    lines = parts.slices(found, by)
    figure = new_figure(COLUMN, 2.6)
    ax = figure.subplots()
    label, factor = parts.label_of(found[plot.x])
    along = found[plot.x].values * factor
    words = parts.flags_of(found)
    for i, (said, line) in enumerate(lines):
        colour = BLACK if len(lines) == 1 else cm.batlow(i / len(lines))
        mark = "." if words else ".-"
        ax.plot(along, line.values, mark, color=colour, markersize=3, linewidth=0.8, label=said or None)
    if plot.log:
        ax.set_yscale("log")
    if parts.spaced_by_factor(along):
        ax.set_xscale("log")
    ax.margins(0.03)
    ax.set(xlabel=label, ylabel=parts.label_of(found)[0])
    if words:
        ax.set_yticks(range(len(words)), labels=words)
    elif found.dtype.kind == "f":
        parts.mark_failed(ax, along[np.isnan(found.transpose(plot.x, ...).values.reshape(len(along), -1)).any(axis=1)])
    if by is not None:
        figure.legend(loc="outside right upper")
    parts.head(figure, study, plot.title, found)
    return figure
