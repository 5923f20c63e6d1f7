"""The chart of thresholds: where the stick-slip cycle becomes unstable, and where separation follows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from disc_model.figures import parts
from disc_model.figures.grids.growth_map import (
    DASHED,
    LOAD,
    SPEED,
    crossings,
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


@styled()
def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: Thresholds) -> Figure:
    """Where the cycle becomes unstable, and where separation follows within the longest horizon.

    What is shaded is where no cycle is stable below the speeds of separation; as far as is known, if the growth rates
    of cycles are not given: from the curve on which the cycle loses its stability.

    Parameters
    ----------
    study : of the quantity `critical_speed`
    others : ``curves`` of the quantity `stability_curves` over Omega and N; ``cycle`` of the quantity `floquet` over
        the same, if given
    """
    norm = parts.normalizations(study)[0]
    study = parts.of(study, norm)
    found = curves_of(parts.of(others["curves"], norm))
    neutral = joined([curve for curve in found if curve.kind == "neutral"])
    folds = [curve for curve in found if curve.kind == "fold"]
    figure = new_figure(COLUMN, 3.4)
    ax = figure.subplots()
    loads = study["N"].values
    ax.set_ylim(0.95 * loads.min(), 1.02 * loads.max())
    lost = parts.failed(study).values
    parts.mark_failed(ax, loads[lost], on="y")
    horizon = float(study["horizon"].max())
    known = study["critical_speed"].sel(horizon=horizon)[~lost].sortby("N")
    N, separation = known["N"].values, known.values
    ax.plot(separation, N, "o-", color=VERMILION, markersize=3, label=f"separation within {horizon:g} s")
    ax.plot(neutral.Omega, neutral.N, color=BLUE, label="cycle loses stability")
    # beyond the scan nothing is known of separation
    scan = study["scan_Omega"].values
    cycle = parts.of(others["cycle"], norm).sel(Omega=slice(scan[0], scan[-1])) if "cycle" in others else None
    band = f"no stable cycle, no separation within {horizon:g} s"
    if cycle is None or min(cycle["growth_rate"].shape) < 2:
        lowest = np.array([min(crossings(neutral, load), default=np.nan) for load in N])
        ax.fill_betweenx(
            N, lowest, separation, where=lowest < separation, color=BLUE, alpha=0.15, linewidth=0, label=band
        )
    else:
        ax.set_xlim(*span(cycle["Omega"].values))
        if N.size:
            _unstable_before(ax, cycle, N, separation, band)
    numbers = numbers_of(folds)
    for i, fold in enumerate(folds):
        label = "fold: the cycle ends" if i == 0 else "_nolegend_"
        ax.plot(fold.Omega, fold.N, color=BLACK, linestyle=DASHED, label=label)
        if fold.label:
            draw_curve(ax, fold, numbers[fold.label])
    if plot.claim:
        printed = np.array(list(plot.claim.values()))
        ax.plot(printed[:, 1], printed[:, 0], "s", color=ORANGE, markersize=4, label="paper")
    ax.set(xlabel=SPEED, ylabel=LOAD)
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
    parts.shade_cells(ax, speeds, loads, here, BLUE, label, 0.18)
