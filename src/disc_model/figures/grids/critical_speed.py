"""Critical speed against preload, and beside it how far separation persists when the speed is lowered again."""

from __future__ import annotations

import itertools
import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from disc_model.figures import parts
from disc_model.figures.grids.separating import draw_behind, draw_ends, draw_onsets, ends_handle, map_horizon
from disc_model.figures.kinds import CriticalSpeed
from disc_model.figures.parts import (
    BLACK,
    BLUE,
    COLUMN,
    END,
    GREEN,
    ONSET,
    ORANGE,
    PAGE,
    PURPLE,
    SKY,
    new_figure,
)

COLORS = (SKY, BLUE, BLACK, GREEN, PURPLE)
MARKERS = "o^sDv"
LARGEST, SMALLEST = 5.5, 2.5
"""Of the marks of the shortest and of the longest horizon, points."""
WIDTH = 20.0
"""Of what is measured at one load, N: well within the step of the sweeps."""


def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: CriticalSpeed) -> Figure:
    """(a) speeds at which separation begins within each horizon, (b) the same beside a sweep of the speed."""
    norm, study, others = parts.of_one(study, others)
    study = parts.without_failed(study, "critical_speed", "crossing")
    sweep, cycle = others.get("hysteresis"), others.get("cycle")
    figure = new_figure(PAGE if sweep is not None else COLUMN, 3.4)
    axes = figure.subplots(1, 2 if sweep is not None else 1, sharey=True, squeeze=False)[0]
    scan = study["scan_Omega"].values
    behind: list[Patch] = []
    if cycle is not None:
        behind = draw_behind(axes[0], cycle.sel(Omega=slice(scan[0], scan[-1])), "N", "Omega")
        if "outcome" in cycle:
            behind.append(Patch(alpha=0, label=f"areas: within {map_horizon(cycle):g} s"))
    _horizons(axes[0], study)
    if plot.claim:
        points = np.array(list(plot.claim.values()))
        axes[0].plot(*points.T, linestyle="", label="what the paper says", zorder=5, clip_on=False, **parts.PAPER_SAYS)
    if sweep is not None:
        sweep = parts.without_failed(sweep, "onset", "persists_to")
        if "basins" in others:
            _measured(axes[1], others["basins"])
        elif cycle is not None:
            _both(axes[1], cycle, sweep)
        _sweep(axes[1], sweep, study)
    parts.letters(axes, [parts.MODES[norm]] * len(axes))
    for ax in axes:
        ax.set(xlabel="Preload N (N)", xlim=(0, 1.03 * float(study["N"].max())), ylim=(scan[0] - 0.5, 1.02 * scan[-1]))
        below: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (0, -0.22), "borderaxespad": 0}
        handles, columns = (behind, 2) if ax is axes[0] else ([], 1)
        ax.legend(handles=ax.get_legend_handles_labels()[0] + handles, ncols=columns, columnspacing=1.0, **below)
    axes[0].set_ylabel("Speed Ω (rad/s)")
    parts.head(figure, study, plot.title, modes_said=True)
    return figure


def _both(ax: Axes, cycle: xr.Dataset, sweep: xr.Dataset) -> None:
    """Cells in which the quiet cycle is stable by its multipliers, and a motion that separates goes on doing so.

    That a sweep up is late, since its stay at a speed is short, does not make a cycle stable. A load between two of the
    sweep is left out if the sweep has found no separation at one of them.
    """
    rate = cycle["growth_rate"].transpose("Omega", "N")
    speeds, loads = rate["Omega"].values, rate["N"].values
    lowest = np.interp(loads, sweep["N"].values, sweep["persists_to"].values, left=np.nan, right=np.nan)
    highest = float(sweep["sweep_Omega"].max())
    there = (rate.values < 0) & (speeds[:, None] >= lowest[None, :]) & (speeds[:, None] <= highest)
    if min(there.shape) > 1:
        cells = np.ma.masked_where(~there, np.ones(there.shape))
        flat = ListedColormap([ORANGE])
        ax.pcolormesh(loads, speeds, cells, cmap=flat, alpha=0.25, shading="nearest", rasterized=True)
        ax.fill_between([], [], [], color=ORANGE, alpha=0.25, label="quiet or separating,\nnot measured")


def _measured(ax: Axes, basins: xr.Dataset) -> None:
    """Speeds at which of many starts some come to the quiet cycle, and some to lasting separation.

    Both shares are above zero with their intervals. A bar goes from the first to the last of neighbouring speeds; one
    alone is a line.
    """
    load = json.loads(basins.attrs["base"])["N"]
    speeds = basins["Omega"].values
    both = ((basins["share_low"].sel(fate="quiet") > 0) & (basins["separating_share_low"] > 0)).values
    for i, (first, after) in enumerate(parts.stretches(both)):
        low, high = speeds[first], speeds[after - 1]
        ax.bar(
            load, high - low, WIDTH, low, color=ORANGE, alpha=0.6, linewidth=0.8, edgecolor=ORANGE,
            label="_nolegend_" if i else f"quiet or separating,\nmeasured at {load:g} N",
        )  # fmt: skip


def _horizons(ax: Axes, study: xr.Dataset) -> None:
    """Speeds at which separation begins, as full marks along lines, and at which it ends, as open ones.

    Marks of longer horizons are smaller, and lie on those of shorter ones.
    """
    horizons, ended = study["horizon"].values, False
    for i, (horizon, color, marker) in enumerate(zip(horizons, itertools.cycle(COLORS), itertools.cycle(MARKERS))):
        size = LARGEST - (LARGEST - SMALLEST) * i / max(1, len(horizons) - 1)
        style: dict[str, Any] = {"color": color, "marker": marker, "markersize": size, "zorder": 3 + 0.1 * i}
        draw_onsets(ax, study, horizon, load_along="x", label=f"begins within {horizon:g} s", **style)
        ended |= draw_ends(ax, study, horizon, load_along="x", **style)
    if ended:
        ax.add_line(ends_handle(marker))
    parts.mark_failed(ax, study["N"].values[parts.failed(study).values])


def _sweep(ax: Axes, sweep: xr.Dataset, study: xr.Dataset) -> None:
    N = sweep["N"].values
    onset, last = sweep["onset"].values, sweep["persists_to"].values
    ax.plot(N, onset, color=ONSET, marker="^", markersize=3.5, label="sweep up: separation begins", clip_on=False)
    ax.plot(N, last, color=END, marker="v", markersize=3.5, label="sweep down: separation ends", clip_on=False)
    longest = float(study["horizon"].max())
    draw_onsets(
        ax, study, longest, load_along="x", label=f"published start, within {longest:g} s", color=BLACK, marker="s",
        markersize=3, linestyle=(0, (2, 1.5)),
    )  # fmt: skip
    parts.mark_failed(ax, N[parts.failed(sweep).values])
