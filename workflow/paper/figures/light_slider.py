"""Separations of a light slider: displacements, and where contact is lost."""

import xarray as xr

from disc_model.data import dataset
from disc_model.figures.drawing import SEPARATED, mark, panels
from disc_model.figures.legends import legend_above
from disc_model.figures.runs import show_thickness
from disc_model.figures.types import Figure
from workflow.paper.figures.kinds import LightSlider
from workflow.paper.figures.separations import (
    after,
    displacements,
    first_complete,
    separations,
    shade,
)

LENGTH = 0.025  # of the stretch shown, s
BEFORE = 0.1  # part of it before the first separation


def draw(plot: LightSlider, case: xr.DataTree) -> Figure:
    """Draw a stretch of the window."""
    figure, [ax] = panels(plot.inches, 2.5)
    window = dataset.samples(case, plot.zoom)
    rest = float(case["u_0"])
    complete = first_complete(window)
    start = float(window["time"][0]) if complete is None else complete[0] - BEFORE * LENGTH
    part = after(window.sel(time=slice(start, start + LENGTH)), start)
    spans = separations(part)
    shade(ax, spans)
    displacements(ax, part, rest)
    losses = part.sel(time=[first for first, _ in spans if first > 0], method="nearest")
    if losses["time"].size:
        height = (losses["w"] - rest) * 1e3
        ax.plot(
            losses["time"], height, "o", color=SEPARATED, markersize=mark(3.5), label="contact lost"
        )
    show_thickness(ax, case, "y")
    ax.set_xlabel(f"Time after {start:.4f} s (ms)")
    legend_above(ax)
    return figure
