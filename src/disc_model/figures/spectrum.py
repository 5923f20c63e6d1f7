"""Spectra: the amplitude of a variable over the frequency."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import xarray as xr

from disc_model.analysis.spectra import RESOLVED, amplitude_spectrum, highest_line, lines
from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.errors import Fault, ParameterError, require
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.drawing import COLUMN, large, panels, sample, wide
from disc_model.figures.kinds.cases import Spectrum
from disc_model.figures.labels import words_of
from disc_model.figures.named_axes import Quantities
from disc_model.figures.names import Names
from disc_model.figures.overlay import Case, Lines, Style, draw_case, name_of_case
from disc_model.figures.runs import sampled, span_of, stated, told_apart, window_of
from disc_model.figures.types import Array, Artist, Axes, Figure
from disc_model.units import is_number

FREQUENCY = "Frequency (Hz)"
FLOOR = -100.0  # least amplitude shown, dB below the greatest
WEAKEST = 0.01  # amplitude over that of the strongest line, of lines that have to be on the axis
ROOM_BEYOND = 1.15  # highest frequency shown over that of the highest such line
HEADROOM = 6.0  # upper end of the axis over the greatest amplitude: room for its name,
NAME_HEIGHT = 15.0  # points, which has a low panel too,
MOST_HEADROOM = 0.4  # and at most as a share of the panel's height
MOST_NAMED = 5  # lines whose frequencies are written
BESIDE = ((3, 2), (-3, 2))  # points, of the names beside their peaks,
BELOW = ((3, -3), (-3, -3))  # where there is no room, beside their lines,
ABOVE = tuple((across, up) for up in (5, 13, 21, 29, 37) for across in (0, -2, 2))  # and else above
ROUNDING = 1e-9  # relative, of half the rate of a window; and of the decade of a resolution
SAID_FROM = 1.0  # Hz, resolution from which the axis states it
MOST_DECIMALS = 1  # of the frequency beside a peak


def draw(plot: Spectrum, case: xr.DataTree) -> Figure:
    """Draw the spectrum of a variable in the whole of a window."""
    figure, [ax] = panels(plot.inches, 2.4)
    samples = dataset.samples(case, plot.window)
    draw_spectrum(ax, samples, plot.variable, amplitudes(samples, plot.variable, plot.highest))
    return figure


def plot_spectrum(
    case: xr.DataTree,
    window: str,
    variable: str,
    highest: float | None,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | None = None,
) -> Axes:
    """Draw the spectrum of a variable of a run; returns the axes."""
    known = highest is None or (is_number(highest) and highest > 0)
    require((known, "highest", highest, "must be a number > 0, in Hz"))
    samples = window_of(case, window, ("variable", variable), samples=True)
    _check_range(samples, highest)
    name, labels = name_of_case(labels)
    try:
        wishes = Wishes(ax, legend, labels, title)
        with page_for(wishes, COLUMN, 2.6, title=stated(case)) as page:
            page.show(Quantities(FREQUENCY, _amplitude(samples, variable)))
            apart = told_apart(case, name, window=f"window {window}")
            overlaid = Case("spectrum", apart, stated(case))
            axes = page.ax
            former = words_of(axes.xaxis.label)
            found = amplitudes(samples, variable, highest)
            panels = [_beside(axes, samples, variable, found)]
            alone = draw_case(
                page, overlaid, panels, lambda: draw_spectrum(axes, samples, variable, found)
            )
            resolutions_differ = words_of(axes.xaxis.label) != former
            if not alone and resolutions_differ:
                axes.set_xlabel(FREQUENCY)
    except Missing as reason:
        raise ParameterError(Fault.of(("window",), window, str(reason))) from None
    return page.ax


def _amplitude(samples: xr.Dataset, variable: str) -> str:
    """The label of the amplitude of a variable."""
    label = sampled(variable, samples)[0]
    name, _, unit = label.rpartition(" (")
    return f"{name}, amplitude ({unit}" if name else f"{label}, amplitude"


def _check_range(samples: xr.Dataset, highest: float | None) -> None:
    """Raise `ParameterError` unless a window shows frequencies up to the highest, Hz."""
    span = span_of(samples)
    if highest is None or not span:
        return
    half_rate = (samples["time"].size - 1) / (2 * span)
    resolution = 1 / span
    rule = (
        f"must be within {resolution:.3g} Hz, the resolution, and {half_rate:.6g} Hz, half the"
        " rate of the window"
    )
    within = resolution <= highest <= half_rate * (1 + ROUNDING)
    require((within, "highest", highest, rule))


class Amplitudes(NamedTuple):
    """What is shown of a spectrum: frequencies, Hz, up to the highest, amplitudes in the unit of the
    axis, the resolution, Hz, all lines as frequencies and amplitudes, and the whole spectrum, of
    which more is seen beside another one that goes further."""

    frequency: Array
    amplitude: Array
    resolution: float
    peaks: list[tuple[float, float]]
    whole: tuple[Array, Array]

    @property
    def highest(self) -> float:
        return float(self.frequency[-1])

    @property
    def lowest(self) -> float:
        """Lower end of the axis."""
        greatest = self.amplitude.max()
        return float(max(self.amplitude.min(), 10 ** (FLOOR / 20) * greatest)) / 2

    def upper_end(self, ax: Axes) -> float:
        """Upper end of the axis, with room for the name of the greatest amplitude."""
        greatest = float(self.amplitude.max())
        return _headroom(ax, greatest / self.lowest) * greatest


def amplitudes(samples: xr.Dataset, variable: str, highest: float | None = None) -> Amplitudes:
    """The spectrum of a variable up to a frequency in Hz, or to where its lines end; raises
    `Missing` if it does not vibrate."""
    time = samples["time"].values
    values = samples[variable].values
    least = 4 * RESOLVED
    if time.size < least:
        raise Missing(
            f"recorded {time.size} samples, and a spectrum takes {least}: a line is"
            f" {least // 2} bins wide"
        )
    _, factor, _ = sampled(variable, samples)
    frequency, amplitude = amplitude_spectrum(time, values)
    resolution = 1 / span_of(samples)
    if highest is None:
        highest = min(ROOM_BEYOND * highest_line(time, values, WEAKEST), float(frequency[-1]))
        least_shown = RESOLVED * resolution
        if highest < least_shown:
            raise Missing(
                f"lasts {span_of(samples):.3g} s, too short: lines show from {least_shown:.3g} Hz"
                f" on, and what vibrates is below {highest:.3g} Hz"
            )
    shown = (frequency > 0) & (frequency <= highest)
    whole = (frequency[1:], factor * amplitude[1:])
    amplitude = factor * amplitude[shown]
    if not amplitude.any():
        raise Missing(f"did not vibrate at up to {highest:g} Hz")
    found = lines(time, values, above=RESOLVED * resolution, below=highest)
    peaks = [(line.frequency, factor * line.amplitude) for line in found]
    return Amplitudes(frequency[shown], amplitude, resolution, peaks, whole)


def draw_spectrum(ax: Axes, samples: xr.Dataset, variable: str, shown: Amplitudes) -> None:
    """Draw the amplitude of a variable over the frequency, with the names of its lines."""
    colour = sampled(variable, samples)[2]
    ax.semilogy(shown.frequency, shown.amplitude, color=colour, linewidth=wide(0.7))
    _label(ax, samples, variable, shown)
    ax.set_xlim((0, shown.highest))
    ax.set_ylim(shown.lowest, shown.upper_end(ax))
    name_lines(ax, shown.peaks, shown.resolution)


def _label(ax: Axes, samples: xr.Dataset, variable: str, shown: Amplitudes) -> None:
    """Say what both axes show, and a coarse resolution."""
    xlabel = FREQUENCY
    if shown.resolution >= SAID_FROM:
        xlabel = f"{xlabel}, resolution {shown.resolution:.2g} Hz"
    ax.set_xlabel(xlabel)
    ax.set_ylabel(_amplitude(samples, variable))


def _beside(ax: Axes, samples: xr.Dataset, variable: str, shown: Amplitudes) -> Lines:
    """How a spectrum is drawn beside others on axes: as a line, without names of its peaks."""

    def draw(ax: Axes, style: Style) -> Artist:
        ax.semilogy(*shown.whole, **style.layered())
        _label(ax, samples, variable, shown)
        return sample(**style.layered())

    limits = ((0.0, shown.highest), (shown.lowest, shown.upper_end(ax)))
    return Lines(draw, limits, sampled(variable, samples)[0].rpartition(" (")[0])


def _headroom(ax: Axes, below: float) -> float:
    """Upper end of the axis over the greatest amplitude, which is so many times the lower end."""
    figure: Any = ax.get_figure(root=True)
    height = 72 * ax.get_window_extent().height / figure.dpi
    share = min(NAME_HEIGHT / height, MOST_HEADROOM)
    return max(HEADROOM, below ** (share / (1 - share)))


def name_lines(ax: Axes, peaks: Sequence[tuple[float, float]], resolution: float = 0.1) -> None:
    """Write the frequencies, Hz, of the strongest lines beside their peaks, on the side away from
    the nearest other line if there is room, or above, with a line to the peak. The stronger
    comes first; without room for the strongest there is none. They have no more digits than the
    resolution, Hz, and a tenth at most."""
    names = Names(ax, stems=peaks, first_needed=True)
    every = [frequency for frequency, _ in peaks]
    for frequency, height in sorted(peaks, key=lambda peak: -peak[1])[:MOST_NAMED]:
        sides = (*BESIDE, *BELOW)
        if _nearest(frequency, every) > frequency:
            sides = (*BESIDE[::-1], *BELOW[::-1])
        text = frequency_text(frequency, resolution)
        names.add(text, (frequency, height), sides, ABOVE, fontsize=large(7))


def frequency_text(frequency: float, resolution: float) -> str:
    """A frequency in Hz, rounded to the place of the first digit of the resolution, or to a tenth."""
    places = min(-math.floor(math.log10(resolution) + ROUNDING), MOST_DECIMALS)
    return f"{round(frequency, places):.{max(places, 0)}f} Hz"


def _nearest(frequency: float, every: Sequence[float]) -> float:
    """The frequency of the line nearest another one; zero without any."""
    others = [other for other in every if other != frequency]
    return min(others, key=lambda other: abs(other - frequency), default=0.0)
