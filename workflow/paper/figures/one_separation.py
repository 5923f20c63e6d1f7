"""One separation: displacements of disc and slider, and the gap."""

import xarray as xr

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.figures.drawing import BLACK, letters, panels
from disc_model.figures.legends import legend_above
from disc_model.figures.runs import show_thickness
from disc_model.figures.types import Figure
from workflow.paper.figures.kinds import OneSeparation
from workflow.paper.figures.separations import after, displacements, first_complete, shade


def draw(plot: OneSeparation, case: xr.DataTree) -> Figure:
    """Draw both panels, with half the separation's length before and after it."""
    width = plot.inches
    figure, axes = panels(width, 3.2, 2, sharex=True, height_ratios=(2, 1))
    both, gap = axes
    window = dataset.samples(case, plot.zoom)
    complete = first_complete(window)
    if complete is None:
        raise Missing(f"has no complete separation in {plot.zoom}")
    start, stop = complete
    margin = 0.5 * (stop - start)
    part = after(window.sel(time=slice(start - margin, stop + margin)), start)
    for ax in axes:
        shade(ax, [(0.0, (stop - start) * 1e3)])
    displacements(both, part, float(case["u_0"]))
    show_thickness(both, case, "y")
    gap.plot(part["time"], (part["u"] - part["w"]) * 1e6, color=BLACK)
    gap.set_xlabel(f"Time after {start:.5f} s (ms)")
    gap.set_ylabel("Gap (μm)")
    letters(axes)
    legend_above(both)
    figure.align_ylabels()
    return figure
