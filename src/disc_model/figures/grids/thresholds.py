"""The chart of thresholds: where the stick-slip cycle becomes unstable, and where separation follows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from disc_model.figures import parts
from disc_model.figures.grids.cells import edges_of, fill, patch
from disc_model.figures.grids.growth_map import LOAD, SPEED, curves_of, draw_curves, parted, span, unfollowed_handle
from disc_model.figures.grids.separating import (
    BEHIND,
    draw_behind,
    draw_ends,
    draw_onsets,
    ends_handle,
    horizon_of,
    separates,
)
from disc_model.figures.kinds import Thresholds
from disc_model.figures.parts import COLUMN, ONSET, new_figure

MARKS: dict[str, Any] = {"color": ONSET, "marker": "o", "markersize": 3, "linewidth": 1.0}


def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: Thresholds) -> Figure:
    """Where the cycle becomes unstable or ends, and where separation follows within a stated time, on one chart.

    The further study ``cycle``, if given, says what is behind, and which curves are of the cycle that it shows.
    """
    norm, study, others = parts.of_one(study, others)
    lost = parts.failed(study).values
    if (cycle := others.get("cycle")) is not None:
        # beyond the scan nothing is known of separation
        cycle = cycle.sel(Omega=slice(*span(study["scan_Omega"].values)))
        cycle = cycle if min(cycle["growth_rate"].shape) > 1 else None
    horizon = horizon_of(study, cycle)
    figure = new_figure(COLUMN, 3.8)
    ax = figure.subplots()
    loads = study["N"].values
    ax.set_ylim(0.95 * loads.min(), 1.02 * loads.max())
    parts.mark_failed(ax, loads[lost], on="y")
    study = study.isel(N=~lost).sortby("N")
    behind: list[Patch] = []
    if cycle is not None:
        ax.set_xlim(*span(cycle["Omega"].values))
        behind = draw_behind(ax, cycle, "Omega", "N") if "outcome" in cycle else _growing(ax, cycle, study, horizon)
    curves = curves_of(others["curves"])
    shown = curves if cycle is None else parted(curves, cycle)[0]
    numbered = draw_curves([ax], [shown])
    for kind in parts.BORDERS:
        if any(curve.kind == kind for curve in shown):
            ax.plot([], [], **parts.border(kind))
    draw_onsets(ax, study, horizon, load_along="y", label="separation begins", zorder=1.9, **MARKS)
    handles = [*ax.get_legend_handles_labels()[0], *behind]
    if draw_ends(ax, study, horizon, load_along="y", **MARKS):
        handles.append(ends_handle("o", ONSET))
    if plot.claim:
        load, speed = np.transpose([*plot.claim.values()])
        handles += ax.plot(speed, load, **parts.PAPER_SAYS, linestyle="", zorder=5, label="what the paper says")
    handles += numbered + unfollowed_handle([others["curves"]])
    ax.set(xlabel=SPEED, ylabel=LOAD)
    ax.set_title(f"{parts.MODES[norm]}, within {horizon:g} s", loc="left", pad=9)
    figure.legend(handles=handles, loc="outside lower center", ncols=2, columnspacing=1.0)
    parts.head(figure, study, plot.title, modes_said=True)
    return figure


def _growing(ax: Axes, cycle: xr.Dataset, study: xr.Dataset, horizon: float) -> list[Patch]:
    """Shade where no cycle is stable, and none of the nearest loads of the scan separates within the horizon.

    Between a load that separates at a speed and one that does not nothing is said.
    """
    rate = cycle["growth_rate"].transpose("N", "Omega")
    apart = separates(study, horizon, rate["N"].values, rate["Omega"].values)
    words = np.where(~(rate.values < 0) & ~apart, "growing", "")
    fill(ax, edges_of(cycle, "Omega", "N"), words, BEHIND)
    said = "no stable cycle, no separation;\nwhite: all else, or not known"
    return [patch(BEHIND["growing"]._replace(label=said))]
