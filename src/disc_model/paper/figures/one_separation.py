"""Slider and disc around one separation, as in figure 3 of the paper."""

from typing import Literal

import xarray as xr

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.figures import drawing
from disc_model.figures.drawing import BLACK, COLUMN, Figure, panels
from disc_model.figures.kind import CasePlot, as_samples
from disc_model.paper.figures.separations import after, complete_separations, displacements, shade


class OneSeparation(CasePlot):
    """(a) Displacements from static equilibrium around the first complete separation of a window, (b) the gap.

    The paper shows (a); the gap is a hundredth of the motion and needs an axis of its own.
    """

    shows = (("zoom", as_samples),)

    kind: Literal["paper.one_separation"] = "paper.one_separation"
    zoom: str = "zoom"

    def draw(self, *cases: xr.DataTree) -> Figure:
        [case] = cases
        figure, axes = panels(COLUMN, 3.2, 2, sharex=True, height_ratios=(2, 1))
        both, gap = axes
        window = dataset.samples(case, self.zoom)
        complete = complete_separations(window)
        if not complete:
            raise Missing(f"has no complete separation in {self.zoom}")
        start, stop = complete[0]
        margin = 0.5 * (stop - start)
        part = after(window.sel(time=slice(start - margin, stop + margin)), start)
        for ax in axes:
            shade(ax, [(0.0, (stop - start) * 1e3)])
        displacements(both, part, float(case["u_0"]))
        gap.plot(part["time"], (part["u"] - part["w"]) * 1e6, color=BLACK)
        gap.set(xlabel=f"Time after {start:.5f} s (ms)", ylabel="Gap (μm)")
        drawing.letters(axes)
        drawing.legend_above(both)
        figure.align_ylabels()
        return figure
