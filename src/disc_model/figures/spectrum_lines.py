"""How spectra are drawn on axes: alone, with the names of peaks, and beside others."""

from typing import Any

import xarray as xr

from disc_model.figures.amplitudes import Amplitudes
from disc_model.figures.case_lines import Lines, Style
from disc_model.figures.drawing import sample, wide
from disc_model.figures.peak_names import name_lines
from disc_model.figures.runs import sampled
from disc_model.figures.types import Artist, Axes

FREQUENCY = "Frequency (Hz)"
HEADROOM = 6.0  # upper end of the axis over the greatest amplitude: room for its name,
NAME_HEIGHT = 15.0  # points, which has a low panel too,
MOST_HEADROOM = 0.4  # and at most as a share of the panel's height
SAID_FROM = 1.0  # Hz, resolution from which the axis states it


def amplitude_label(samples: xr.Dataset, variable: str) -> str:
    """The label of the amplitude of a variable."""
    label = sampled(variable, samples)[0]
    name, _, unit = label.rpartition(" (")
    return f"{name}, amplitude ({unit}" if name else f"{label}, amplitude"


def draw_spectrum(
    ax: Axes, samples: xr.Dataset, variable: str, shown: Amplitudes, named: bool = True
) -> None:
    """Draw the amplitude of a variable over the frequency, with the names of its lines if `named`."""
    colour = sampled(variable, samples)[2]
    ax.semilogy(shown.frequency, shown.amplitude, color=colour, linewidth=wide(0.7))
    _label(ax, samples, variable, shown)
    ax.set_xlim((0, shown.highest))
    ax.set_ylim(shown.lowest, _upper_end(ax, shown))
    if named:
        name_lines(ax, shown.peaks, shown.resolution)


def _label(ax: Axes, samples: xr.Dataset, variable: str, shown: Amplitudes) -> None:
    """Say what both axes show, and a coarse resolution."""
    xlabel = FREQUENCY
    if shown.resolution >= SAID_FROM:
        xlabel = f"{xlabel}, resolution {shown.resolution:.2g} Hz"
    ax.set_xlabel(xlabel)
    ax.set_ylabel(amplitude_label(samples, variable))


def lines_beside(ax: Axes, samples: xr.Dataset, variable: str, shown: Amplitudes) -> Lines:
    """How a spectrum is drawn beside others on axes: as a line, without names of its peaks."""

    def draw(ax: Axes, style: Style) -> Artist:
        ax.semilogy(*shown.whole, **style.layered())
        _label(ax, samples, variable, shown)
        return sample(**style.layered())

    limits = ((0.0, shown.highest), (shown.lowest, _upper_end(ax, shown)))
    return Lines(draw, limits, sampled(variable, samples)[0].rpartition(" (")[0])


def _upper_end(ax: Axes, shown: Amplitudes) -> float:
    """Upper end of the axis of amplitudes, with room for the name of the greatest."""
    greatest = float(shown.amplitude.max())
    return _headroom(ax, greatest / shown.lowest) * greatest


def _headroom(ax: Axes, below: float) -> float:
    """Upper end of the axis over the greatest amplitude, which is so many times the lower end."""
    figure: Any = ax.get_figure(root=True)
    height = 72 * ax.get_window_extent().height / figure.dpi
    share = min(NAME_HEIGHT / height, MOST_HEADROOM)
    return max(HEADROOM, below ** (share / (1 - share)))
