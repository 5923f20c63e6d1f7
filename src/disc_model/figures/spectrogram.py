"""Spectrograms: power of a variable of a case over time and frequency."""

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Annotated, Literal

import numpy as np
import xarray as xr

from disc_model.analysis.spectra import TimeFrequency, time_frequency
from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.figures import drawing
from disc_model.figures.drawing import PAGE, Axes, Figure, FigureBase, QuadMesh, panels
from disc_model.figures.kind import HIGHEST, CasePlot, Need, Sampled, as_spectrum
from disc_model.units import Positive, Unit

FLOOR = -100.0
"""Least power shown, dB below the reference."""


class Spectrogram(CasePlot):
    """Power of a variable over time and frequency, in dB below its strongest line.

    highest : Hz, frequency up to which it is shown
    """

    kind: Literal["spectrogram"] = "spectrogram"
    window: str
    variable: Sampled = "w_point"
    highest: Annotated[Positive, Unit("Hz")] = HIGHEST

    def needs(self) -> Iterator[Need]:
        yield Need("window", self.case, self.window, [partial(as_spectrum, highest=self.highest)])

    def draw(self, *cases: xr.DataTree) -> Figure:
        figure, [ax] = panels(PAGE / 2, 2.7)
        draw_spectrum(figure, ax, cases[0], spectrum_of(cases[0], self.window, self.variable), self.highest)
        ax.set_title(drawing.sampled(self.variable, dataset.group(cases[0], self.window))[0].partition(" (")[0])
        return figure


def spectrum_of(case: xr.DataTree, window: str, variable: str, **options: float) -> TimeFrequency:
    """Short-time Fourier transform of a window's variable, see `disc_model.analysis.spectra`; raises `Missing`."""
    samples = dataset.samples(case, window)
    try:
        spectrum = time_frequency(samples["time"].values, samples[variable].values, **options)
    except ValueError as error:
        raise Missing(f"recorded too little in {window}: {error}") from None
    if not spectrum.power.any():
        raise Missing(f"did not vibrate in {window}")
    return spectrum


def draw_power(ax: Axes, case: xr.DataTree, spectrum: TimeFrequency, reference: float, highest: float) -> QuadMesh:
    """Draw power in dB relative to a reference, up to a frequency in Hz; the first separation is marked."""
    from cmcrameri.cm import lipari

    shown = spectrum.frequency <= highest
    power = 10 * np.log10(np.maximum(spectrum.power[shown] / reference, 10 ** (FLOOR / 10 - 2)))
    look = {"cmap": lipari, "vmin": FLOOR, "vmax": 0, "shading": "nearest", "rasterized": True}
    mesh = ax.pcolormesh(spectrum.time, spectrum.frequency[shown], power, **look)
    ax.set_facecolor(lipari(0.0))
    ax.set(xlim=span_of(spectrum), ylim=(0, highest))
    drawing.mark_first_separation(ax, case, named=False, color="white", linewidth=0.9)
    return mesh


def span_of(spectrum: TimeFrequency) -> tuple[float, float]:
    """The span of time that a panel represents, s; one at the start of a run begins at 0."""
    start, stop = round(float(spectrum.time[0]), 1), round(float(spectrum.time[-1]), 1)
    return (0.0 if start < 1 else start), stop


def draw_scale(figure: FigureBase, mesh: QuadMesh, axes: Axes | Sequence[Axes]) -> None:
    """Draw the colour scale of power beside the panels that share it."""
    label = "Power (dB re strongest line)"
    bar = figure.colorbar(mesh, ax=axes, pad=0.02, aspect=30, fraction=0.06, label=label)
    bar.outline.set_visible(False)


def draw_spectrum(figure: FigureBase, ax: Axes, case: xr.DataTree, spectrum: TimeFrequency, highest: float) -> None:
    """Draw power in dB below the strongest line, up to a frequency in Hz, with its scale."""
    mesh = draw_power(ax, case, spectrum, float(spectrum.power.max()), highest)
    ax.set(xlabel="Time (s)", ylabel="Frequency (Hz)")
    draw_scale(figure, mesh, ax)
