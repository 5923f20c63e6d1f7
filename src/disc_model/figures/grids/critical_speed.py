"""Critical speed against preload, and beside it how far separation persists when the speed is lowered again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from disc_model.data.variables import flag_names
from disc_model.figures import parts
from disc_model.figures.grids.kinds import CriticalSpeed
from disc_model.figures.parts import (
    BLACK,
    BLUE,
    COLUMN,
    GREEN,
    ORANGE,
    PAGE,
    SEPARATED,
    SKY,
    VERMILION,
    new_figure,
    styled,
)

COLORS = (SKY, BLUE, BLACK, GREEN, ORANGE)
MARKERS = "o^sDv"
QUIET = "#e3e3e3"
WIDTH = 20.0
"""Of what is measured at one load, N: well within the step of the sweeps."""


@styled()
def draw(study: xr.Dataset, others: Mapping[str, xr.Dataset], plot: CriticalSpeed) -> Figure:
    """(a) speeds at which separation begins within each horizon, (b) the same beside a sweep of the speed.

    Parameters
    ----------
    study : of the quantity `critical_speed`, over N
    others : ``hysteresis`` of that quantity, over N; ``cycle`` of the quantity `floquet` over N and Omega; ``basins``
        of that quantity, over Omega; if given
    """
    norm = parts.normalizations(study)[0]
    study = parts.without_failed(parts.of(study, norm), "critical_speed", "crossing")
    sweep = others.get("hysteresis")
    figure = new_figure(PAGE if sweep is not None else COLUMN, 3.2)
    axes = figure.subplots(1, 2 if sweep is not None else 1, sharey=True, squeeze=False)[0]
    if "cycle" in others:
        _stable_cycle(axes[0], parts.of(others["cycle"], norm), study)
    _horizons(axes[0], study)
    if plot.claim:
        points = np.array(list(plot.claim.values()))
        axes[0].plot(
            *points.T, "*", color=VERMILION, markersize=8, label="what the paper says", zorder=5, clip_on=False
        )
    if sweep is not None:
        cycle = parts.of(others["cycle"], norm) if "cycle" in others else None
        sweep = parts.without_failed(parts.of(sweep, norm), "onset", "persists_to")
        if "basins" in others:
            _measured(axes[1], parts.of(others["basins"], norm))
        elif cycle is not None:
            _both(axes[1], cycle, sweep)
        _sweep(axes[1], sweep, study)
    scan = study["scan_Omega"].values
    for ax, letter in zip(axes, "ab", strict=False):
        ax.set(xlabel="Preload N (N)", xlim=(0, 1.03 * float(study["N"].max())), ylim=(scan[0] - 0.5, 1.02 * scan[-1]))
        ax.set_title(f"({letter})" if len(axes) > 1 else "", loc="left")
        ax.legend(loc="upper left", bbox_to_anchor=(0, -0.2), ncols=2, borderaxespad=0)
    axes[0].set_ylabel("Speed Ω (rad/s)")
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
    parts.shade_cells(ax, loads, speeds, there, ORANGE, "quiet or separating,\nnot measured", 0.25)


def _measured(ax: Axes, basins: xr.Dataset) -> None:
    """Speeds at which of many starts some come to the quiet cycle, and some to lasting separation.

    Both shares are above zero with their intervals. Each speed stands for half the way to the next ones.
    """
    load = json.loads(basins.attrs["base"])["N"]
    speeds = basins["Omega"].values
    both = (basins["share_low"].sel(fate=["quiet", "separating"]) > 0).all("fate").values
    halves = np.diff(speeds) / 2
    below, above = np.append(halves[:1], halves), np.append(halves, halves[-1:])
    heights = (below + above)[both]
    ax.bar(
        np.full(both.sum(), load), heights, WIDTH, (speeds - below)[both], color=ORANGE, alpha=0.6, linewidth=0,
        label=f"quiet or separating,\nmeasured at {load:g} N",
    )  # fmt: skip


def _stable_cycle(ax: Axes, cycle: xr.Dataset, study: xr.Dataset) -> None:
    """Shade where the stick-slip cycle exists and is stable, within the speeds that were scanned."""
    scan = study["scan_Omega"].values
    rate = cycle["growth_rate"].transpose("Omega", "N").sel(Omega=slice(scan[0], scan[-1]))
    loads, speeds = rate["N"].values, rate["Omega"].values
    parts.shade_cells(ax, loads, speeds, (rate < 0).values, QUIET, "stick-slip cycle stable")
    if "outcome" in cycle:
        _region(ax, cycle, float(scan[0]), float(scan[-1]))


def _region(ax: Axes, regions: xr.Dataset, lowest: float, highest: float) -> None:
    """Cells of a map in which the published start separates: no scan can step over them."""
    outcome = regions["outcome"].transpose("Omega", "N").sel(Omega=slice(lowest, highest))
    apart = flag_names(outcome) == "separation"
    horizon = json.loads(regions.attrs["options"])["horizon"]
    loads, speeds = outcome["N"].values, outcome["Omega"].values
    parts.shade_cells(ax, loads, speeds, apart, SEPARATED, f"separation, {horizon:g} s", 0.25)


def _horizons(ax: Axes, study: xr.Dataset) -> None:
    """The lowest separating speed as a line, further crossings as marks: full begins, open ends."""
    N = study["N"].values
    horizons = study["horizon"].values
    for i, horizon in enumerate(horizons):
        color, marker = COLORS[i % len(COLORS)], MARKERS[i % len(MARKERS)]
        one = study.sel(horizon=horizon)
        style: dict[str, Any] = {"color": color, "marker": marker, "markersize": 3.5}
        ax.plot(N, one["critical_speed"].values, label=f"within {horizon:g} s", zorder=3, **style)
        speeds, kinds = (
            one["crossing"].transpose("N", "crossing_number").values,
            flag_names(one["crossing_kind"].transpose("N", "crossing_number")),
        )
        lowest = one["critical_speed"].values[:, None]
        for kind, face in (("begins", color), ("ends", "white")):
            there = (kinds == kind) & (speeds != lowest)
            where = np.broadcast_to(N[:, None], speeds.shape)[there]
            ax.plot(where, speeds[there], linestyle="", markerfacecolor=face, markeredgewidth=0.7, zorder=4, **style)
    if (study["n_crossings"] > 1).any():
        ax.plot([], [], "o", color=BLACK, markerfacecolor="white", markersize=3.5, label="open: separation ends again")
    parts.mark_failed(ax, N[parts.failed(study).values])


def _sweep(ax: Axes, sweep: xr.Dataset, study: xr.Dataset) -> None:
    """Where separation is found on the way up and on the way down."""
    N = sweep["N"].values
    onset, last = sweep["onset"].values, sweep["persists_to"].values
    ax.plot(N, onset, color=BLUE, marker="^", markersize=3.5, label="sweep up: separation begins", clip_on=False)
    ax.plot(N, last, color=VERMILION, marker="v", markersize=3.5, label="sweep down: persists to", clip_on=False)
    longest = float(study["horizon"].max())
    ax.plot(
        study["N"].values,
        study["critical_speed"].sel(horizon=longest).values,
        color=BLACK,
        marker="s",
        markersize=3,
        linestyle=(0, (2, 1.5)),
        label=f"from rest, within {longest:g} s",
    )
    parts.mark_failed(ax, N[parts.failed(sweep).values])
    parts.letter(ax, "b")
