"""Phase portrait of the slider's motion relative to the drive point; figures A1 and A2 of the paper."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.data import inputs
from disc_model.data.variables import PHASES
from disc_model.figures import parts
from disc_model.figures.style import COLUMN, PHASE_COLOURS, new_figure, styled


@styled
def draw(cases: Mapping[str, xr.DataTree]) -> Figure:
    """psi' over psi in the window `orbit`, coloured by phase."""
    (case,) = cases.values()
    figure = new_figure(COLUMN, 2.7)
    ax = figure.subplots()
    with parts.or_say_why(ax):
        _orbit(ax, inputs.samples(case, "orbit"))
    return figure


def _orbit(ax: Axes, window: xr.Dataset) -> None:
    psi, velocity, phase = (window[name].values for name in ("psi", "psi_velocity", "phase"))
    for i, name in enumerate(PHASES):
        inside = phase == i
        if not inside.any():
            continue
        # a line broken where the phase changes, so that no chord is drawn across others
        shown = np.where(inside, velocity, np.nan)
        colour = PHASE_COLOURS[name]
        ax.plot(psi, shown, color=colour, linewidth=0.5, rasterized=True)
        ax.plot([], [], color=colour, linewidth=1.5, label=name)
    ax.margins(0.04)
    ax.set(xlabel="ψ (rad)", ylabel="dψ/dt (rad/s)")
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.2, ncols=3)
