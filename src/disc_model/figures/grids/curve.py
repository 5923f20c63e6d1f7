"""Curves: any variable of a grid study against any one of its dimensions."""

from collections.abc import Mapping, Sequence
from itertools import cycle
from textwrap import fill
from typing import Any

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from disc_model.figures import parts
from disc_model.figures.kinds import CurvePlot
from disc_model.figures.parts import BLACK, COLUMN, GREY, new_figure

WIDEST = 25
"""Greatest length of a name that fits beside the panel, letters."""
LINEAR = 0.1
"""Growth rate up to which its scale is linear, 1/s; a greater step leads to another cycle and breaks the line."""
MARKS = "os^Dv<>"
"""Marks of the lines; they are open, so that lines on top of each other show."""


def draw(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: CurvePlot) -> Figure:
    """Draw a line, or one for each value of a second dimension; marks at the axis stand for missing values.

    A second dimension of numbers has a colour scale, one of words or pairs a legend.
    """
    found = parts.picked(study, plot.variable, plot.at)
    by = next((str(name) for name in found.dims if name != plot.x), None)
    lines = parts.slices(found, by)
    numbers = found[by] if by in found.coords and found[by].dtype.kind in "fi" else None
    figure = new_figure(COLUMN, 2.9)
    ax = figure.subplots()
    label, factor = parts.label_of(found[plot.x])
    along = found[plot.x].values * factor
    words = parts.flags_of(found)
    colours = [cm.batlow(i / len(lines)) for i in range(len(lines))] if by else [BLACK]
    jump = np.inf if plot.log or plot.variable != "growth_rate" else LINEAR
    for colour, (text, line), mark in zip(colours, lines, cycle(MARKS), strict=False):
        name = text if numbers is None else ""
        x, y = parts.broken(along, line.values, jump)
        ax.plot(
            x, y, mark + "-" * (not words), color=colour, label=name or None,
            markersize=3, markerfacecolor="none", markeredgewidth=0.6, linewidth=0.7,
        )  # fmt: skip
    if plot.limits is not None:
        ax.set_ylim(plot.limits)
    if plot.log:
        ax.set_yscale("log")
    elif plot.variable == "growth_rate":  # peaks of tens occur beside hundredths
        ax.set_yscale("symlog", linthresh=LINEAR)
        ax.yaxis.set_major_formatter("{x:g}")
        ax.axhline(0, color=GREY, linewidth=0.6, zorder=0)
    if parts.spaced_by_factor(along):
        ax.set_xscale("log")
    ax.margins(0.03)
    ax.set(xlabel=label, ylabel=fill(parts.label_of(found)[0], 32))
    if words:
        ax.set_yticks(range(len(words)), labels=words)
    for (name, gone), mark in zip(parts.gaps(study, found, plot.at).items(), "x+|12", strict=False):
        there = gone.any([dim for dim in gone.dims if dim != plot.x]).values
        parts.mark_failed(ax, along[there], name=name, mark=mark)
    if numbers is not None:
        _scale(figure, ax, numbers, colours)
    if ax.get_legend_handles_labels()[0]:
        beside = by is not None and numbers is None and max(len(text) for text, _ in lines) < WIDEST
        figure.legend(loc="outside right upper" if beside else "outside lower right", ncols=1 if beside or by else 2)
    return figure


def _scale(figure: Figure, ax: Axes, values: xr.DataArray, colours: Sequence[Any]) -> None:
    """Draw a scale beside the panel: the value of each line in its colour."""
    label, factor = parts.label_of(values)
    norm = BoundaryNorm(np.arange(len(colours) + 1) - 0.5, len(colours))
    bar = figure.colorbar(ScalarMappable(norm, ListedColormap(list(colours))), ax=ax, pad=0.01, aspect=30)
    bar.set_label(label)
    bar.set_ticks(list(range(len(colours))), labels=[f"{value * factor:g}" for value in values.values])
    bar.minorticks_off()
