"""Disc and a light slider around their separations, as in figure 23 of the paper."""

from typing import Literal

import xarray as xr

from disc_model.data import dataset
from disc_model.figures import drawing
from disc_model.figures.drawing import COLUMN, SEPARATED, Figure, panels
from disc_model.figures.kind import CasePlot, as_samples
from disc_model.paper.figures.separations import after, complete_separations, displacements, separations, shade


class LightSlider(CasePlot):
    """Displacements from static equilibrium in a part of a window, with the losses of contact."""

    shows = (("zoom", as_samples),)

    kind: Literal["paper.light_slider"] = "paper.light_slider"
    zoom: str = "zoom"

    def draw(self, *cases: xr.DataTree) -> Figure:
        [case] = cases
        figure, [ax] = panels(COLUMN, 2.5)
        window, rest = dataset.samples(case, self.zoom), float(case["u_0"])
        complete = complete_separations(window)
        length = 0.025  # of the stretch shown, s
        start = complete[0][0] - 0.1 * length if complete else float(window["time"][0])
        part = after(window.sel(time=slice(start, start + length)), start)
        spans = separations(part)
        shade(ax, spans)
        displacements(ax, part, rest)
        losses = part.sel(time=[first for first, _ in spans if first > 0], method="nearest")
        if losses["time"].size:
            height = (losses["w"] - rest) * 1e3
            ax.plot(losses["time"], height, "o", color=SEPARATED, markersize=3.5, label="contact lost")
        ax.set_xlabel(f"Time after {start:.4f} s (ms)")
        drawing.legend_above(ax)
        return figure
