"""Ranges of the contact force and of the disc over runs, a column for each case."""

import json

import numpy as np
import xarray as xr

from disc_model.figures.drawing import PAGE, large, letters, mark_printed, panels
from disc_model.figures.runs import envelope, show, show_thickness
from disc_model.figures.selection import history
from disc_model.figures.types import Axes, Figure
from workflow.paper.figures.kinds import Histories

SMALL = 0.05  # share of the axis below which a range of the force is drawn once more
SECOND_LINE = 14.0  # points above a panel, over the time of the first separation
INSET = (0.3, 0.74, 0.66, 0.26)


def draw(plot: Histories, *cases: xr.DataTree) -> Figure:
    """Draw forces above displacements, on common axes."""
    width = plot.inches
    count = len(cases)
    if width == PAGE:
        figure, axes = panels(width, 3.2, 2, count, sharex=True, sharey="row")
        forces = axes[:count]
        discs = axes[count:]
    else:  # all below each other
        figure, axes = panels(width, 2.6 * count, 2 * count, sharex=True)
        forces = axes[::2]
        discs = axes[1::2]
    windows = [history(case, plot.history, plot.until) for case in cases]
    for force, disc, case, window in zip(forces, discs, cases, windows, strict=True):
        for ax, name in ((force, "P"), (disc, "w_point")):
            show(ax, case, window, name, named=name == "P")
            ax.label_outer()
    # now the axes are known
    for force, disc, case, window in zip(forces, discs, cases, windows, strict=True):
        _draw_inset(force, window)
        show_thickness(disc, case, "y")
    if plot.printed is not None:
        mark_printed(forces[-1], plot.printed)
    letters(axes)
    for force, case in zip(forces, cases, strict=True):
        p = json.loads(case.attrs["parameters"])
        force.set_title(f"{p['N']:g} N, {p['Omega']:g} rad/s", loc="right", pad=SECOND_LINE)
    figure.align_ylabels()
    return figure


def _draw_inset(ax: Axes, window: xr.Dataset) -> None:
    """Draw a small range of the force once more, on an axis of its own."""
    low = float(window["P_min"].min())
    high = float(window["P_max"].max())
    if high - low >= SMALL * np.ptp(ax.get_ylim()):
        return
    inset = ax.inset_axes(INSET)
    envelope(inset, window, "P")
    inset.set_ylim(low - 1, high + 1)
    inset.tick_params(labelsize=large(6))
    inset.xaxis.set_major_formatter("{x:g} s")
    inset.yaxis.set_major_formatter("{x:g} N")
