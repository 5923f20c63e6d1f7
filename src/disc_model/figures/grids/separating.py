"""Speeds at which separation begins and ends, of the quantity `critical_speed`, and what lies behind them in charts."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from disc_model.data.variables import flag_names
from disc_model.figures.grids.cells import OUTCOMES, Look, edges_of, fill, paler, patch, words_of
from disc_model.figures.parts import BLACK

Array = NDArray[np.float64]

BEHIND = {
    **OUTCOMES,
    "other_cycle": paler(OUTCOMES["other_cycle"], 0.35),
    "growing": paler(OUTCOMES["growing"], 0.35),
    "separation": paler(OUTCOMES["separation"], 0.75),
}
"""What becomes of the published start, behind curves and marks."""
STABLE = Look("stick-slip cycle stable; white: none is", OUTCOMES["quiet"].face)


def speeds_of(study: xr.Dataset, horizon: float, kind: str) -> list[Array]:
    """Speeds at which separation within a horizon "begins" or "ends" as the speed rises, for each load, rad/s."""
    one = study.sel(horizon=horizon).transpose("N", ..., "crossing_number")
    kinds = flag_names(one["crossing_kind"])
    there = (kinds == kind) & np.isfinite(one["crossing"].values)
    return [speeds[here] for speeds, here in zip(one["crossing"].values, there, strict=True)]


def onsets(study: xr.Dataset, horizon: float) -> list[Array]:
    """Speeds at which separation begins, the lowest of the scan included where it separates there already."""
    lowest = study["critical_speed"].sel(horizon=horizon).values
    found = speeds_of(study, horizon, "begins")
    return [
        np.unique(np.append(speeds, speed)) if np.isfinite(speed) else speeds
        for speeds, speed in zip(found, lowest, strict=True)
    ]


def branches(speeds: list[Array]) -> list[tuple[int, float, float]]:
    """Which crossings at neighbouring loads belong together: index of the lower load, speed there, speed at the next.

    Each is the nearest to the other; what has no such partner is the end of a branch.
    """
    links = []
    for i, (here, ahead) in enumerate(pairwise(speeds)):
        if here.size and ahead.size:
            apart = np.abs(here[:, None] - ahead[None, :])
            # speeds are rounded, so that two may be as near
            nearest = np.isclose(apart, apart.min(0), rtol=1e-9) & np.isclose(apart, apart.min(1)[:, None], rtol=1e-9)
            links += [(i, float(here[j]), float(ahead[k])) for j, k in np.argwhere(nearest)]
    return links


def separates(study: xr.Dataset, horizon: float, loads: Array, speeds: Array) -> NDArray[np.bool_]:
    """Whether one of the scanned loads beside a load separates at a speed, or none is beside: (loads, speeds)."""
    scanned = study["N"].values
    if not scanned.size:
        return np.ones((len(loads), len(speeds)), bool)
    changes = zip(onsets(study, horizon), speeds_of(study, horizon, "ends"), strict=True)
    passed = [[np.searchsorted(np.sort(at), speeds, "right") for at in pair] for pair in changes]
    at_scan = np.array([begun > ended for begun, ended in passed])
    below, above = (np.searchsorted(scanned, loads, side) for side in ("right", "left"))
    beyond = (below == 0) | (above == len(scanned))
    below, above = np.clip(below - 1, 0, None), np.clip(above, None, len(scanned) - 1)
    return at_scan[below] | at_scan[above] | beyond[:, None]


def draw_onsets(ax: Axes, study: xr.Dataset, horizon: float, *, load_along: str, **style: Any) -> None:
    """Speeds at which separation begins, joined along their branches; the load lies along "x" or "y"."""
    loads, speeds = study["N"].values, onsets(study, horizon)
    alone = [(load, at, np.nan, np.nan) for load, found in zip(loads, speeds, strict=True) for at in found]
    pairs = [(loads[i], one, loads[i + 1], two) for i, one, two in branches(speeds)]
    # a gap after each pair
    points = np.array([(*pair, np.nan, np.nan) for pair in pairs + alone]).reshape(-1, 2)
    ax.plot(*_placed(points[:, 0], points[:, 1], load_along), **style)


def draw_ends(ax: Axes, study: xr.Dataset, horizon: float, *, load_along: str, **style: Any) -> bool:
    """Open marks at speeds at which separation ends again; whether there are any."""
    speeds = speeds_of(study, horizon, "ends")
    there = np.repeat(study["N"].values, [found.size for found in speeds])
    open_marks = {"linestyle": "", "markerfacecolor": "white", "markeredgewidth": 0.7}
    ax.plot(*_placed(there, np.concatenate([[], *speeds]), load_along), **style | open_marks)
    return bool(there.size)


def _placed(loads: Array, speeds: Array, load_along: str) -> tuple[Array, Array]:
    return (loads, speeds) if load_along == "x" else (speeds, loads)


def horizon_of(study: xr.Dataset, cycle: xr.Dataset | None) -> float:
    """The horizon that a chart of one shows: that of the map behind it if there is one, else the longest, s."""
    horizons = study["horizon"].values
    if cycle is not None and "outcome" in cycle and (own := map_horizon(cycle)) in horizons:
        return own
    return float(horizons.max())


def map_horizon(regions: xr.Dataset) -> float:
    """Of a study of the quantity `regions`, s."""
    return float(json.loads(regions.attrs["options"])["horizon"])


def draw_behind(ax: Axes, cycle: xr.Dataset, x: str, y: str) -> list[Patch]:
    """Fill what becomes of the published start, or at least where the cycle is stable; handles of the legend.

    cycle : over N and Omega, of the quantity `regions` or `floquet`
    """
    if min(cycle["growth_rate"].shape) < 2:
        return []
    edges = edges_of(cycle, x, y)
    if "outcome" not in cycle:
        stable = cycle["growth_rate"].transpose(y, x).values < 0
        fill(ax, edges, np.where(stable, "quiet", ""), BEHIND)
        return [patch(STABLE)]
    words = words_of(cycle, "outcome", x, y)
    fill(ax, edges, words, BEHIND)
    return [patch(look) for name, look in BEHIND.items() if name in words]


def ends_handle(marker: str, color: str = BLACK) -> Line2D:
    """For legends."""
    return Line2D(
        [], [], linestyle="", marker=marker, color=color, markerfacecolor="white", markersize=3.5, markeredgewidth=0.7,
        label="open: separation ends again",
    )  # fmt: skip
