"""Spectrograms: the power of a variable over time and frequency."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from cmcrameri import cm

from disc_model.analysis.spectra import TimeFrequency, time_frequency
from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.figures.drawing import panels, wide
from disc_model.figures.kinds.cases import Spectrogram
from disc_model.figures.runs import mark_first_separation, sampled
from disc_model.figures.types import Axes, Figure, FigureBase

FLOOR = -100.0  # least power shown, dB below the reference


def draw(plot: Spectrogram, case: xr.DataTree) -> Figure:
    """Draw the spectrogram of a variable in a window."""
    figure, [ax] = panels(plot.inches, 2.7)
    spectrum = spectrum_of(case, plot.window, plot.variable)
    mesh = draw_power(ax, case, spectrum, float(spectrum.power.max()), plot.highest)
    draw_scale(figure, mesh, ax)
    ax.set_xlabel("Time (s)")
    ax.set_ylabel("Frequency (Hz)")
    label, *_ = sampled(plot.variable, dataset.group(case, plot.window))
    name, _, _ = label.rpartition(" (")  # every sampled variable has a unit
    ax.set_title(name)
    return figure


def spectrum_of(case: xr.DataTree, window: str, variable: str) -> TimeFrequency:
    """Short-time Fourier transform of a window's variable, see `disc_model.analysis.spectra`;
    raises `Missing`."""
    samples = dataset.samples(case, window)
    try:
        spectrum = time_frequency(samples["time"].values, samples[variable].values)
    except ValueError as error:
        raise Missing(f"recorded too little in {window}: {error}") from None
    if not spectrum.power.any():
        raise Missing(f"did not vibrate in {window}")
    return spectrum


def draw_power(
    ax: Axes, case: xr.DataTree, spectrum: TimeFrequency, reference: float, highest: float
) -> Any:
    """Draw power in dB relative to a reference, up to a frequency in Hz; the first separation is
    marked."""
    shown = spectrum.frequency <= highest
    least = 10 ** (FLOOR / 10 - 2)  # drawn as nothing
    power = 10 * np.log10(np.maximum(spectrum.power[shown] / reference, least))
    mesh = ax.pcolormesh(
        spectrum.time,
        spectrum.frequency[shown],
        power,
        cmap=cm.lipari,
        vmin=FLOOR,
        vmax=0,
        shading="nearest",
        rasterized=True,
    )
    ax.set_facecolor(cm.lipari(0.0))
    start, stop = span_of(spectrum)
    half_step = 0.5 * float(np.diff(spectrum.time[:2]).sum())
    first = float(spectrum.time[0]) - half_step
    if start < first:  # half a window has no spectrum, which is not one without power
        ax.axvspan(start, first, color="white", linewidth=0)
    ax.set_xlim(start, stop)
    ax.set_ylim((0, highest))
    mark_first_separation(ax, case, named=False, color="white", linewidth=wide(0.9))
    return mesh


def span_of(spectrum: TimeFrequency) -> tuple[float, float]:
    """The span of time that a panel represents, s; one at the start of a run begins at 0."""
    start = round(float(spectrum.time[0]), 1)
    stop = round(float(spectrum.time[-1]), 1)
    return (0.0 if start < 1 else start), stop


def draw_scale(figure: FigureBase, mesh: Any, axes: Axes | Sequence[Axes]) -> None:
    """Draw the colour scale of power beside the panels that share it."""
    label = "Power (dB re strongest line)"
    bar = figure.colorbar(mesh, ax=axes, label=label, pad=0.02, aspect=30, fraction=0.06)
    bar.outline.set_visible(False)
