"""Spectra that change with time: a panel of power over time and frequency, and its colour bar."""

from __future__ import annotations

from collections.abc import Sequence

import cmcrameri.cm as cmc
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import FigureBase

from disc_model.analysis.spectra import TimeFrequency

FLOOR = -100.0
"""Least power shown, dB below the reference."""
COLOURS = cmc.lipari


def decibel(power: np.ndarray, reference: float) -> np.ndarray:
    """Power relative to a reference, dB, no less than `FLOOR` - 20."""
    return np.asarray(10 * np.log10(np.maximum(power / reference, 10 ** (FLOOR / 10 - 2))))


def spectrogram(ax: Axes, found: TimeFrequency, reference: float, highest: float) -> QuadMesh:
    """Draw power in dB relative to a reference, up to a frequency in Hz."""
    shown = found.frequency <= highest
    mesh = ax.pcolormesh(
        found.time,
        found.frequency[shown],
        decibel(found.power[shown], reference),
        cmap=COLOURS,
        vmin=FLOOR,
        vmax=0,
        shading="nearest",
        rasterized=True,
    )
    ax.set_facecolor(COLOURS(0.0))
    ax.set_xlim(*stretch(found))
    ax.set_ylim(0, highest)
    return mesh


def stretch(found: TimeFrequency) -> tuple[float, float]:
    """The stretch of time that a panel stands for, s; one at the start of a run begins at 0."""
    start, stop = round(float(found.time[0]), 1), round(float(found.time[-1]), 1)
    return (0.0 if start < 1 else start), stop


def mark_time(ax: Axes, time: float) -> None:
    """A dashed line at a time, if the panel shows it."""
    low, high = ax.get_xlim()
    if np.isfinite(time) and low < time < high:
        ax.axvline(time, color="white", linewidth=0.9, linestyle=(0, (4, 2)))


def colour_bar(figure: FigureBase, mesh: QuadMesh, axes: Axes | Sequence[Axes]) -> None:
    """The scale of power beside panels that share it."""
    bar = figure.colorbar(mesh, ax=axes, pad=0.02, aspect=30, fraction=0.06)
    bar.set_label("Power (dB re strongest line)")
    bar.outline.set_visible(False)
