"""Where separation begins and ends on ramps of the speed."""

from collections.abc import Mapping
from itertools import chain
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import stated_in
from disc_model.figures.borders import crossings, curves_of
from disc_model.figures.drawing import (
    GREY,
    border,
    large,
    mark,
    mark_failed,
    panels,
    say_beside,
    wide,
)
from disc_model.figures.kinds.maps import RampedSpeeds
from disc_model.figures.legends import figure_legend
from disc_model.figures.swept_speeds import END, ONSET
from disc_model.figures.types import Axes, Figure
from disc_model.figures.words import SPEED


def draw(plot: RampedSpeeds, study: xr.Dataset, overlays: Mapping[str, xr.Dataset]) -> Figure:
    """Draw one point; by ``curves``, the highest end of the cycle below all onsets, their limit
    for slow ramps."""
    study = study.squeeze()
    options = stated_in(study, "options")
    low, high = options["low"], options["high"]
    rates, onset, end = (study[name].values for name in ("rate", "onset_speed", "offset_speed"))
    gone = study["rate_status"].values != 0
    going_on = np.isnan(end) & (study["top_separation_rate"].values > 0) & ~gone
    figure, [ax] = panels(plot.inches, 3.4)
    for speeds, shape, colour, label in (
        (onset, "^-", ONSET, "onset, rising ramp"),
        (end, "v-", END, "end, falling ramp"),
    ):
        if np.isfinite(speeds).any():
            look: dict[str, Any] = {"markersize": mark(4), "linewidth": wide(0.8), "label": label}
            ax.plot(rates, speeds, shape, color=colour, **look)
    _mark_at_bound(
        ax,
        rates[np.isnan(onset) & ~gone],
        high,
        "^",
        ONSET,
        f"none up to the highest speed, {high:g} rad/s",
    )
    goes_on = f"separation goes on at the lowest speed, {low:g} rad/s"
    _mark_at_bound(ax, rates[going_on], low, "v", END, goes_on)

    limit = _end_of_cycle(study, overlays, onset)
    if limit is not None:
        ax.axhline(limit, zorder=0, **border("fold"))
        say_beside(ax, limit, f"{limit:.2f}", fontsize=large(6), color=GREY)
    mark_failed(ax, rates[gone])
    ax.set_xscale("log")
    ax.margins(x=0.04)
    ax.set_xlabel("Ramp rate (rad/s²)")
    ax.set_ylabel(SPEED)
    ax.set_ylim(low, high)
    handles = ax.get_legend_handles_labels()[0]
    figure_legend(figure, handles, loc="outside lower center", columns=1)
    return figure


def _mark_at_bound(
    ax: Axes, rates: np.ndarray, bound: float, shape: str, colour: str, label: str
) -> None:
    """Mark rates of ramps that have no speed by hollow marks at a bound of the speed; nothing if
    there are none."""
    if not rates.size:
        return
    look: dict[str, Any] = {
        "markersize": mark(4),
        "markerfacecolor": "white",
        "clip_on": False,
        "zorder": 3,
    }
    ax.plot(rates, np.full(rates.size, bound), shape, color=colour, label=label, **look)


def _end_of_cycle(
    study: xr.Dataset, overlays: Mapping[str, xr.Dataset], onset: np.ndarray
) -> float | None:
    """The highest speed below all onsets at which the stable cycle ends, rad/s; None without."""
    if "curves" not in overlays:
        return None
    load = float(stated_in(study, "base")["N"])
    folds = [curve for curve in curves_of(overlays["curves"]) if curve.kind == "fold"]
    speeds = chain.from_iterable(crossings(curve, load) for curve in folds)
    below = [float(speed) for speed in speeds if speed <= np.fmin.reduce(onset)]
    return max(below, default=None)
