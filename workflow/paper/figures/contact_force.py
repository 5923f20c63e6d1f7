"""The contact force: its range over a run, and a closer look."""

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.variables import axis_of
from disc_model.figures.drawing import FORCE, PAGE, letters, panels
from disc_model.figures.legends import legend_above
from disc_model.figures.runs import show
from disc_model.figures.selection import history
from disc_model.figures.types import Figure
from workflow.paper.figures.kinds import ContactForce
from workflow.paper.figures.separations import after, separations, shade


def draw(plot: ContactForce, case: xr.DataTree) -> Figure:
    """Draw both panels."""
    width = plot.inches
    columns = 2 if width == PAGE else 1
    rows = 2 // columns
    figure, axes = panels(width, 2.3 * rows, rows, columns)
    whole, close = axes
    show(whole, case, history(case, plot.history), "P")
    window = dataset.samples(case, plot.zoom)
    start = float(window["time"][0])
    window = after(window, start)
    spans = separations(window)
    shade(close, spans)
    close.plot(window["time"], window["P"], color=FORCE)
    close.set_xlabel(f"Time after {start:.5f} s (ms)")
    close.set_ylabel(axis_of("P")[0])
    if spans:
        legend_above(close)
    letters(axes)
    if np.isfinite(float(case["first_separation"])):
        # with zero if contact is lost; a force that hardly changes is shown in detail
        for ax in axes:
            ax.set_ylim(bottom=-0.03 * ax.get_ylim()[1])
    return figure
