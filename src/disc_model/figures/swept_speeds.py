"""Sweeps of the speed over the preload: where separation begins and ends, and what lies between."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap, to_rgba

from disc_model.data.swept_speeds import swept_speeds
from disc_model.data.variables import stated_in
from disc_model.figures.arrows import draw_arrows
from disc_model.figures.classes import FILLED_MARK, UNSETTLED
from disc_model.figures.drawing import BLACK, BLUE, GREY, ORANGE, SEPARATED, mark, mark_failed, wide
from disc_model.figures.selection import failed, stretches
from disc_model.figures.types import Axes

ONSET = SEPARATED  # colour of speeds at which separation begins,
END = BLUE  # and at which it ends
ARROW = 5.0  # pt, length of an arrow to lower speeds, and its distance from the mark
COEXISTENCE = "////"  # hatch of that mark, whose grey is that of a class beside it
BAR = 20.0  # N, height of the mark of coexistence, well within a step of the sweeps


def draw_sweeps(
    ax: Axes, sweep: xr.Dataset, cycle: xr.Dataset | None, basins: xr.Dataset | None
) -> str:
    """Draw sweeps of the speed, and shade where some motions stay quiet and others separate;
    returns a title."""
    loads = sweep["N"].values
    lost = failed(sweep).values
    swept = swept_speeds(sweep)
    onset = np.where(lost, np.nan, swept.onset.values)
    end = np.where(lost, np.nan, swept.end.values)
    doubtful = False
    for speeds, shape, colour, label, unsettled in (
        (onset, "^", ONSET, "sweep up: separation begins", swept.onset_unsettled.values),
        (end, "v", END, "sweep down: separation ends", swept.end_unsettled.values),
    ):
        look: dict[str, Any] = {"color": colour, "markersize": mark(4), "clip_on": False}
        ax.plot(speeds, loads, shape, markerfacecolor="none", label=label, **look)
        filled = unsettled & np.isfinite(speeds)
        if filled.any():
            ax.plot(speeds[filled], loads[filled], shape, label="_nolegend_", **look)
            doubtful = True
    if doubtful:
        label = FILLED_MARK.format(UNSETTLED.label)
        ax.plot([], [], "o", color=GREY, markersize=mark(4), label=label)
    _point_to_less(ax, loads, onset, swept.onset_at_bound.values & ~lost, ONSET)
    _point_to_less(ax, loads, end, swept.end_at_bound.values & ~lost, END)
    mark_failed(ax, loads[lost], on="y")
    if basins is not None:
        _coexistence(ax, basins)
    elif cycle is not None:
        _stable_cycles(ax, sweep, cycle)
    step = float(np.diff(sweep["sweep_Omega"].values[:2])[0])
    return f"sweeps in steps of {step:g} rad/s"


def _point_to_less(
    ax: Axes, loads: np.ndarray, speeds: np.ndarray, at_bound: np.ndarray, colour: str
) -> None:
    """Set an arrow beside each speed that is the lowest of its sweep, and may be less."""
    if at_bound.any():
        draw_arrows(ax, speeds[at_bound], loads[at_bound], colour, "left", ARROW)


def _coexistence(ax: Axes, basins: xr.Dataset) -> None:
    """Mark speeds at which some starts stay quiet and others separate: both fractions exceed zero
    with their intervals. A single speed is a line."""
    load = stated_in(basins, "base")["N"]
    speeds = basins["Omega"].values
    quiet = basins["basin_fraction_low"].sel(attractor_class="quiet")
    apart = basins["separating_fraction_low"]
    both = ((quiet > 0) & (apart > 0)).values
    label = f"quiet or separating,\ncomputed at {load:g} N"
    for first, after in stretches(both):
        width = speeds[after - 1] - speeds[first]
        ax.barh(
            load,
            width,
            BAR,
            speeds[first],
            label=label,
            fc=to_rgba(ORANGE, 0.6),
            ec=BLACK,
            hatch=COEXISTENCE,
            lw=wide(0.4),
        )
        label = "_nolegend_"


def _stable_cycles(ax: Axes, sweep: xr.Dataset, cycle: xr.Dataset) -> None:
    """Shade where the cycle is stable by its multipliers, as short stays only delay a sweep up, and
    the sweep down still separates; not between loads of which one never does."""
    speeds = cycle["Omega"].values
    loads = cycle["N"].values
    ends = swept_speeds(sweep).end.values
    lowest = np.interp(loads, sweep["N"].values, ends, left=np.nan, right=np.nan)
    highest = float(sweep["sweep_Omega"].max())
    within = (speeds >= lowest[:, None]) & (speeds <= highest)
    stable = (cycle["growth_rate"].values < 0) & within
    shown = np.ma.masked_where(~stable, stable)
    ax.pcolormesh(
        speeds,
        loads,
        shown,
        cmap=ListedColormap([ORANGE]),
        alpha=0.25,
        shading="nearest",
        rasterized=True,
    )
    label = "the cycle is stable where the\nsweep down still separates"
    ax.fill_between([], [], [], color=ORANGE, alpha=0.25, label=label)
