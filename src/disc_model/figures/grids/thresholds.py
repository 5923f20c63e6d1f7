"""The chart of thresholds: where the stick-slip cycle becomes unstable, and where separation follows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from numpy.typing import NDArray

from disc_model.figures import parts
from disc_model.figures.grids.growth_map import (
    DASHED,
    LOAD,
    SPEED,
    Curve,
    curves_of,
    draw_curve,
    joined,
    number_handles,
    numbers_of,
    span,
)
from disc_model.figures.grids.kinds import Thresholds
from disc_model.figures.parts import BLACK, BLUE, COLUMN, ORANGE, VERMILION, new_figure, styled

Array = NDArray[np.float64]


def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: Thresholds) -> Figure:
    """The chart of a study of the quantity `critical_speed`.

    Parameters
    ----------
    others : ``curves`` of the quantity `stability_curves` over Omega and N; ``cycle`` of the quantity `floquet` over
        the same, if given
    """
    norm = parts.normalizations(study)[0]
    study = parts.of(study, norm)
    horizon = float(study["horizon"].max())
    found = curves_of(parts.of(others["curves"], norm))
    # beyond the scan nothing is known of separation
    scan = study["scan_Omega"].values
    cycle = parts.of(others["cycle"], norm).sel(Omega=slice(scan[0], scan[-1])) if "cycle" in others else None
    if cycle is not None and min(cycle["growth_rate"].shape) < 2:
        cycle = None
    return threshold_chart(
        study["N"].values,
        study["critical_speed"].sel(horizon=horizon).values,
        horizon,
        joined([curve for curve in found if curve.kind == "neutral"]),
        [curve for curve in found if curve.kind == "fold"],
        dict(plot.claim.values()),
        cycle,
        parts.failed(study).values,
    )


@styled
def threshold_chart(
    N: Array,
    separation: Array,
    horizon: float,
    neutral: Curve,
    folds: Sequence[Curve] = (),
    printed: Mapping[float, float] | None = None,
    cycle: xr.Dataset | None = None,
    failed: NDArray[np.bool_] | None = None,
) -> Figure:
    """Where the cycle becomes unstable, and where separation follows within a stated time, on one chart.

    N, separation : shape (n,), load (N) and the lowest speed (rad/s) with separation within `horizon` (s), nan if none
    neutral : curve on which the cycle loses stability; the band from it to `separation` is shaded and named. The
        cycle may be stable again beyond: then give `cycle`
    folds : where the cycle ceases to exist
    printed : critical speeds of the paper by load
    cycle : `growth_rate` (1/s, nan without a cycle) over N and Omega: what is shaded is where no cycle is stable
    failed : shape (n,), loads at which separation is not known; they are marked
    """
    figure = new_figure(COLUMN, 3.4)
    ax = figure.subplots()
    ax.set_ylim(0.95 * N.min(), 1.02 * N.max())
    lost = np.zeros(len(N), bool) if failed is None else failed
    parts.mark_failed(ax, N[lost], on="y")
    order = np.argsort(N[~lost])
    N, separation = N[~lost][order], separation[~lost][order]
    ax.plot(separation, N, "o-", color=VERMILION, markersize=3, label=f"separation within {horizon:g} s")
    ax.plot(neutral.Omega, neutral.N, color=BLUE, label="cycle loses stability")
    band = f"no stable cycle, no separation within {horizon:g} s"
    if cycle is None:
        lowest = _lowest_speed(neutral, N)
        both = np.isfinite(lowest) & np.isfinite(separation) & (lowest < separation)
        ax.fill_betweenx(N, lowest, separation, where=both, color=BLUE, alpha=0.15, linewidth=0, label=band)
    elif N.size:
        _unstable_before(ax, cycle, N, separation, band)
    numbers = numbers_of(folds)
    for i, fold in enumerate(folds):
        label = "fold: the cycle ends" if i == 0 else "_nolegend_"
        ax.plot(fold.Omega, fold.N, color=BLACK, linestyle=DASHED, label=label)
        if fold.label:
            draw_curve(ax, fold, numbers[fold.label])
    if printed:
        ax.plot(list(printed.values()), list(printed), "s", color=ORANGE, markersize=4, label="paper")
    ax.set(xlabel=SPEED, ylabel=LOAD)
    if cycle is not None:
        ax.set_xlim(*span(cycle["Omega"].values))
    figure.legend(
        handles=[*ax.get_legend_handles_labels()[0], *number_handles(numbers)], loc="outside upper center", ncols=1
    )
    return figure


def _unstable_before(ax: Axes, cycle: xr.Dataset, N: Array, separation: Array, label: str) -> None:
    """Shade where no cycle is stable, at speeds below those of separation."""
    rate = cycle["growth_rate"].transpose("N", "Omega")
    loads, speeds = rate["N"].values, rate["Omega"].values
    known = np.isfinite(separation)
    until = np.interp(loads, N[known], separation[known]) if known.any() else np.full(len(loads), np.inf)
    # none found at the loads on both sides
    until[np.interp(loads, N, known.astype(float)) == 0] = np.inf
    here = ~(rate.values < 0) & (speeds[None, :] < until[:, None])
    cells = np.ma.masked_where(~here, np.ones(here.shape))
    ax.pcolormesh(speeds, loads, cells, cmap=ListedColormap([BLUE]), alpha=0.18, shading="nearest", rasterized=True)
    ax.fill_between([], [], [], color=BLUE, alpha=0.18, linewidth=0, label=label)


def _lowest_speed(curve: Curve, N: Array) -> Array:
    """Lowest speed at which the curve passes each load: (len(N),), nan where it does not."""
    lowest = np.full(len(N), np.nan)
    for i, load in enumerate(N):
        side = curve.N - load
        at = np.flatnonzero(side[:-1] * side[1:] <= 0)
        if len(at):
            share = side[at] / np.where(side[at] == side[at + 1], 1.0, side[at] - side[at + 1])
            lowest[i] = np.min(curve.Omega[at] + share * (curve.Omega[at + 1] - curve.Omega[at]))
    return lowest
