"""What several figures share: envelopes of long histories, shading of separations, panel letters."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from disc_model.figures.style import SEPARATED, VERMILION
from disc_model.result import PHASES

SEPARATION = PHASES.index("separation")


def envelope(
    ax: Axes,
    history: xr.Dataset,
    name: str,
    *,
    scale: float = 1.0,
    offset: float = 0.0,
    color: str,
    label: str = "",
) -> None:
    """The range of a variable against time, as a band that stays visible where it is thin."""
    time = history["time"].values
    low = (history[f"{name}_min"].values - offset) * scale
    high = (history[f"{name}_max"].values - offset) * scale
    ax.fill_between(time, low, high, facecolor=color, edgecolor=color, linewidth=0.5, label=label)
    ax.set_xlim(0, round(time[-1] + (time[-1] - time[-2]) / 2, 2))


def mark_first_separation(ax: Axes, time: float) -> None:
    """A line at the first separation, with its time above it; nothing if there was none."""
    if not np.isfinite(time):
        return
    ax.axvline(time, color=VERMILION, linewidth=0.8, linestyle=(0, (4, 2)))
    ax.annotate(
        f"first separation {time:.2f} s",
        (time, 1),
        xycoords=("data", "axes fraction"),
        xytext=(0, 2),
        textcoords="offset points",
        ha="center",
        va="bottom",
        fontsize=7,
        color=VERMILION,
    )


def shade(ax: Axes, spans: list[tuple[float, float]], label: str) -> None:
    """Shade stretches of the horizontal axis; the label stands in the legend once."""
    for i, (start, stop) in enumerate(spans):
        ax.axvspan(start, stop, color=SEPARATED, alpha=0.25, label=label if i == 0 else "_nolegend_")


def separations(window: xr.Dataset) -> list[tuple[float, float]]:
    """Stretches of separation in a window of samples, s; those that the window cuts off included."""
    apart = np.concatenate([[False], window["phase"].values == SEPARATION, [False]])
    edges = np.flatnonzero(np.diff(apart.astype(int)))
    time = window["time"].values
    return [(float(time[a]), float(time[b - 1])) for a, b in edges.reshape(-1, 2)]


def complete_separations(window: xr.Dataset) -> list[tuple[float, float]]:
    """Those separations that begin and end inside the window."""
    time = window["time"].values
    return [(a, b) for a, b in separations(window) if a > time[0] and b < time[-1]]


def legend_above(ax: Axes) -> None:
    """A legend in one row above the right end of the axes, where it hides nothing."""
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.2, ncols=4)


def letter(ax: Axes, text: str) -> None:
    """A panel's letter above its upper left corner."""
    ax.set_title(f"({text})", loc="left")
