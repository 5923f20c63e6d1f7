"""Spectra: the amplitude of a variable over the frequency."""

from typing import Any

import xarray as xr

from disc_model.data.dataset import Missing
from disc_model.errors import Fault, ParameterError, require
from disc_model.figures.amplitudes import Amplitudes, amplitudes
from disc_model.figures.canvas import Wishes, page_for
from disc_model.figures.case_lines import Lines, Style
from disc_model.figures.drawing import COLUMN, sample, wide
from disc_model.figures.labels import words_of
from disc_model.figures.named_axes import Quantities
from disc_model.figures.overlay import Case, draw_case, is_beside, name_of_case
from disc_model.figures.peak_names import name_lines
from disc_model.figures.runs import sampled, span_of, window_of
from disc_model.figures.stated_case import stated, told_apart
from disc_model.figures.types import Artist, Axes
from disc_model.units import is_number

FREQUENCY = "Frequency (Hz)"
HEADROOM = 6.0  # upper end of the axis over the greatest amplitude: room for its name,
NAME_HEIGHT = 15.0  # points, which has a low panel too,
MOST_HEADROOM = 0.4  # and at most as a share of the panel's height
ROUNDING = 1e-9  # relative, of half the rate of a window
SAID_FROM = 1.0  # Hz, resolution from which the axis states it


def plot_spectrum(
    case: xr.DataTree,
    window: str,
    variable: str,
    highest: float | None,
    *,
    ax: Any = None,
    legend: Any = True,
    labels: Any = None,
    title: str | bool | None = None,
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
            named = not is_beside(axes, "spectrum")  # peaks on other axes have the same names
            alone = draw_case(
                page, overlaid, panels, lambda: draw_spectrum(axes, samples, variable, found, named)
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
    ax.set_ylabel(_amplitude(samples, variable))


def _beside(ax: Axes, samples: xr.Dataset, variable: str, shown: Amplitudes) -> Lines:
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
