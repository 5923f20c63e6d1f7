"""Onset of separation on the way up and its end on the way down, against the ramp rate of the speed."""

import json
from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.figures import parts
from disc_model.figures.grids.growth_map import Curve, crossings, curves_of
from disc_model.figures.kinds import RampedSpeeds
from disc_model.figures.parts import COLUMN, END, ONSET, new_figure

BEYOND = "none up to the highest speed"


def draw(study: xr.Dataset, overlays: Mapping[str, xr.Dataset], plot: RampedSpeeds) -> Figure:
    """Draw one point; with the further study ``curves``, also the speed at which the cycle ends."""
    study = study.squeeze()
    options, load = json.loads(study.attrs["options"]), float(json.loads(study.attrs["base"])["N"])
    rates, onset, end = (study[name].values for name in ("rate", "onset_speed", "offset_speed"))
    gone = study["rate_status"].values != 0
    figure = new_figure(COLUMN, 3.4)
    ax = figure.subplots()
    ax.plot(rates, onset, "^-", color=ONSET, markersize=4, linewidth=0.8, label="onset, rising ramp")
    ax.plot(rates, end, "v-", color=END, markersize=4, linewidth=0.8, label="end, falling ramp")
    late = rates[np.isnan(onset) & ~gone]
    if late.size:
        top = np.full(late.size, options["high"])
        ax.plot(late, top, "^", color=ONSET, markersize=4, markerfacecolor="white", clip_on=False, label=BEYOND)
    if "curves" in overlays:
        _fold(ax, curves_of(overlays["curves"]), load, onset)
    parts.mark_failed(ax, rates[gone])
    ax.set_xscale("log")
    ax.margins(x=0.04)
    ax.set(xlabel="Ramp rate (rad/s²)", ylabel=parts.axis_of("Omega")[0], ylim=(options["low"], options["high"]))
    figure.legend(loc="outside lower center", ncols=1)
    return figure


def _fold(ax: Axes, curves: list[Curve], load: float, onset: np.ndarray) -> None:
    """Draw the speed at which the stick-slip cycle ends at this load: the limit of the onset for slow ramps.

    It is the highest such speed below all onsets; other ends belong to other cycles.
    """
    folds = np.concatenate([[], *(crossings(curve, load) for curve in curves if curve.kind == "fold")])
    below = folds[folds <= np.nanmin(onset, initial=np.inf)]
    if below.size and np.isfinite(onset).any():
        ax.axhline(below.max(), **parts.BORDERS["fold"], zorder=0)
        parts.say_beside(ax, below.max(), f"{below.max():.2f}")
