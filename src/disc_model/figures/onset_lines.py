"""Onsets of separation from the static start, over speed and preload."""

import numpy as np
import xarray as xr

from disc_model.figures.drawing import BLACK, halo, mark
from disc_model.figures.durations import duration_of
from disc_model.figures.gap_rows import add_column
from disc_model.figures.missing_texts import missing_text
from disc_model.figures.onsets import branches, speeds_of
from disc_model.figures.types import Axes


def draw_without_onset(ax: Axes, study: xr.Dataset, horizon: float) -> None:
    """Mark loads at which no speed of the scan separates, beside the panel."""
    found = speeds_of(study, horizon)
    without = np.array([row.size == 0 for row in found], dtype=bool)
    if not without.any():
        return
    reason = missing_text(study, "critical_speed").replace(" in steps", "\nin steps")
    if not duration_of(study, "critical_speed"):
        reason += f" within {horizon:g} s"
    look = {"marker": "o", "ms": mark(2.4), "mec": BLACK, "mew": 0.5, "c": "white"}
    add_column(ax, study["N"].values[without], label=reason, **look)


def draw_onsets(ax: Axes, study: xr.Dataset, horizon: float, label: str) -> None:
    """Draw onsets of separation, joined along their branches, seen on any area by black edges and
    below the curves."""
    loads = study["N"].values
    speeds = speeds_of(study, horizon)
    ends = speeds_of(study, horizon, "ends")
    points: list[tuple[float, float]] = []
    gap = (np.nan, np.nan)
    for link in branches(speeds, ends):
        points += [(link.speed, loads[link.load]), (link.ahead, loads[link.load + 1]), gap]
    for load, row in zip(loads, speeds, strict=True):
        for speed in row:
            points += [(speed, load), gap]
    outline = halo(1.3, BLACK)
    across, up = np.reshape(points, (-1, 2)).T
    low, high = ax.get_xlim()
    ax.plot(
        across,
        up,
        clip_on=bool(np.any((across < low) | (across > high))),  # marks at the edge stay whole
        path_effects=outline,
        zorder=1.9,
        label=label,
        c="white",
        marker="o",
        ms=mark(2.4),
        mec=BLACK,
        mew=0.5,
    )
