"""Figure 3 of the paper: the slider leaves the rising disc, flies, and meets it again."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.data import inputs
from disc_model.data.inputs import Missing
from disc_model.figures import parts
from disc_model.figures.style import BLACK, COLUMN, DISC, SLIDER, new_figure, styled

MARGIN = 0.5
"""Time shown before and after, as a share of the separation."""


@styled
def draw(cases: Mapping[str, xr.DataTree]) -> Figure:
    """Slider and disc around one separation: (a) displacements from static equilibrium, (b) the gap.

    The paper shows (a); the gap is a hundredth of the motion, so that it needs an axis of its own to be seen.
    """
    case = cases["F02"]
    figure = new_figure(COLUMN, 3.2)
    both, gap = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    with parts.or_say_why(both, gap):
        _around_a_separation(both, gap, case)
    figure.align_ylabels()
    return figure


def _around_a_separation(both: Axes, gap: Axes, case: xr.DataTree) -> None:
    window = inputs.samples(case, "zoom")
    found = parts.complete_separations(window)
    if not found:
        raise Missing("has no complete separation in zoom")
    start, stop = found[0]
    margin = MARGIN * (stop - start)
    part = window.sel(time=slice(start - margin, stop + margin))
    time = (part["time"].values - start) * 1e3
    u, w, rest = part["u"].values, part["w"].values, float(case["u_0"])
    for ax in (both, gap):
        parts.shade(ax, [(0.0, (stop - start) * 1e3)], "separation")
    both.plot(time, (w - rest) * 1e3, color=DISC, label="disc")
    both.plot(time, (u - rest) * 1e3, color=SLIDER, linestyle=(0, (4, 1.5)), label="slider")
    gap.plot(time, (u - w) * 1e6, color=BLACK)
    both.set(ylabel="From equilibrium (mm)")
    gap.set(xlabel=f"Time after {start:.5f} s (ms)", ylabel="Gap (μm)")
    parts.letter(both, "a")
    parts.letter(gap, "b")
    parts.legend_above(both)
