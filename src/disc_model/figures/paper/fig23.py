"""Figure 23 of the paper: a light slider leaves the disc near the lowest point of its swing."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.data import inputs
from disc_model.figures import parts
from disc_model.figures.style import COLUMN, DISC, SEPARATED, SLIDER, new_figure, styled

SHOWN = 0.025
"""Length of the stretch shown, s."""


@styled
def draw(cases: Mapping[str, xr.DataTree]) -> Figure:
    """Slider and disc from static equilibrium; losses of contact are marked."""
    figure = new_figure(COLUMN, 2.5)
    ax = figure.subplots()
    with parts.or_say_why(ax):
        _motion(ax, cases["F23"])
    return figure


def _motion(ax: Axes, case: xr.DataTree) -> None:
    window = inputs.samples(case, "zoom")
    start = float(window["time"][0])
    found = parts.complete_separations(window)
    if found:
        start = found[0][0] - 0.1 * SHOWN
    part = window.sel(time=slice(start, start + SHOWN))
    time = (part["time"].values - start) * 1e3
    rest = float(case["u_0"])
    parts.shade(ax, [((a - start) * 1e3, (b - start) * 1e3) for a, b in parts.separations(part)], "separation")
    ax.plot(time, (part["w"].values - rest) * 1e3, color=DISC, label="disc")
    ax.plot(time, (part["u"].values - rest) * 1e3, color=SLIDER, linestyle=(0, (4, 1.5)), label="slider")
    losses = np.array([a for a, _ in parts.separations(part) if a > start])
    if losses.size:
        height = part["w"].sel(time=losses, method="nearest").values
        ax.plot(
            (losses - start) * 1e3, (height - rest) * 1e3, "o", color=SEPARATED, markersize=3.5, label="contact lost"
        )
    ax.set(xlabel=f"Time after {start:.4f} s (ms)", ylabel="From equilibrium (mm)")
    parts.legend_above(ax)
