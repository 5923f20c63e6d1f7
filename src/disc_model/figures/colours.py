"""Colours of numbers on a map: of counts, of values of one sign or two, of growth rates, and on a
logarithmic scale."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib import colormaps
from matplotlib.colors import (
    AsinhNorm,
    Colormap,
    ListedColormap,
    LogNorm,
    Normalize,
    from_levels_and_colors,
)
from matplotlib.ticker import Formatter, LogLocator, MaxNLocator

from disc_model.figures.colour_wishes import USUAL, ColourWishes
from disc_model.figures.drawing import parents_of_bar
from disc_model.figures.least_span import equal_but_for_rounding
from disc_model.figures.types import Array, Axes, FigureBase

ROUNDING = 1e-9  # 1/s, growth rates of undamped modes by rounding
FEW = 12  # counts below which each has a colour of its own
SPAN = 1e3  # of a logarithmic scale on each side of zero, from where it is linear to its end
MOST_TICKS = 3  # on each side of zero
NEAR = 0.2  # of the larger end of a scale, where another number would meet that of an end
GREATEST = 0.3  # growth rate at which the colours end, 1/s, unless most rates are larger
COMMON = 0.98  # share of rates within the scale then, since a few large ones would pale the others
LINEAR_SHARE = 1 / 30  # of the greatest rate, up to which the scale is nearly linear
LINEAR_OF_MEDIAN = 0.2  # of the median rate, up to which it is nearly linear at most
MOST_POWERS = 9  # of ten beside a bar of a logarithmic scale
LEAST_POWERS = 3  # of ten, which alone let a logarithmic scale be read
STEPS_WITHIN = 5  # between numbers beside a bar that spans less than a factor of ten
DIGITS = range(3, 10)  # of numbers beside a bar
COLOURS = 256  # of a part of a map of colours
NEAR_END = 0.06  # of a bar of growth rates, within which a number would meet that of its end
EXTENDS = {
    (False, False): "neither",
    (True, False): "min",
    (False, True): "max",
    (True, True): "both",
}
"""What matplotlib calls the ends of a bar beyond which there are numbers, below and above."""


@dataclass(frozen=True)
class Scale:
    """Colours of numbers: a map and a scale of matplotlib, and the ticks of its bar: words if each
    number has a colour of its own, or places on a logarithmic scale through zero.

    open_ends : whether numbers lie beyond the scale, below and above
    """

    cmap: Colormap
    norm: Normalize
    ticks: Sequence[str] = ()
    places: Sequence[float] = ()
    open_ends: tuple[bool, bool] = (False, False)


def colours_of(numbers: Array, array: xr.DataArray, wishes: ColourWishes = USUAL) -> Scale:
    """Colours of all numbers of a figure: each of few counts, logarithmic, around zero, or between
    the least and the greatest, or what a reader sets as limits."""
    if array.dtype.kind == "i" and numbers.max() < FEW and wishes.limits is None:
        return counted(int(numbers.max()) + 1, wishes.cmap)
    values = numbers[np.isfinite(numbers)]
    low, high = wishes.limits or _ends_of(values, wishes.log)

    # colours that have a middle have it at zero
    around_zero = low < 0 < high and not wishes.has_no_middle
    if around_zero:
        high = max(-low, high)
        low = -high
    usual: Any = cm.batlow
    if around_zero:
        usual = cm.vik

    scale = Scale(usual, Normalize(low, high))
    if wishes.log and (low <= 0 or needs_zero(values)):
        scale = _through_zero(usual, values, low, high)
    elif wishes.log:
        scale = _positive(usual, low, high, is_growth(array.name))
    elif wishes.limits is None and equal_but_for_rounding(low, high):
        scale = _constant(usual, low)
    beyond = (bool((values < low).any()), bool((values > high).any()))
    return replace(scale, cmap=_chosen(wishes, scale.cmap), open_ends=beyond)


def _ends_of(values: Array, log: bool) -> tuple[float, float]:
    """The least and the greatest of some numbers; the ends of an empty scale without any."""
    if values.size:
        return float(values.min()), float(values.max())
    return (1.0, 10.0) if log else (0.0, 1.0)


def _chosen(wishes: ColourWishes, usual: Colormap) -> Colormap:
    """The colour map that a reader asks for, or else the usual one."""
    return usual if wishes.cmap is None else colormaps.get_cmap(wishes.cmap)


def counted(count: int, cmap: str | Colormap | None = None) -> Scale:
    """A colour for each of the numbers 0, 1, ... below a count."""
    of_all = colormaps.get_cmap(cmap) if cmap is not None else cm.batlow
    colours = [of_all(i / count) for i in range(count)]
    own, norm = from_levels_and_colors((np.arange(count + 1) - 0.5).tolist(), colours)
    return Scale(own, norm, [str(i) for i in range(count)])


def _constant(usual: Colormap, number: float) -> Scale:
    """The colour of a map of one number, in the middle of a bar that names that alone."""
    margin = abs(number) / 2 or 1.0
    return Scale(usual, Normalize(number - margin, number + margin), places=[number])


def _positive(usual: Colormap, low: float, high: float, growth: bool) -> Scale:
    """Colours of positive numbers on a logarithmic scale; growth rates have the red half of the
    scale of their maps."""
    if growth:
        usual = ListedColormap(cm.vik(np.linspace(0.55, 1, 256)))
    norm = LogNorm(low, high if high > low else 10 * low)
    return Scale(usual, norm, places=_places_of_few_decades(norm))


def _places_of_few_decades(norm: LogNorm) -> list[float]:
    """Ticks of a logarithmic scale with less than three powers of ten: both ends, and steps that are not near
    one; none of its own with more of them, which say the ends well enough."""
    low, high = float(norm.vmin or 1.0), float(norm.vmax or 1.0)
    first, last = np.ceil(np.log10(low)), np.floor(np.log10(high))
    if last - first >= LEAST_POWERS - 1:
        return []
    if within_a_decade(norm):
        even = MaxNLocator(STEPS_WITHIN, steps=[1, 2, 5, 10])
        return _with_ends([step for step in even.tick_values(low, high) if step > 0], norm)
    return _with_ends(_steps_of_decades(low, high), norm)


def _steps_of_decades(low: float, high: float) -> list[float]:
    """One, two and five times powers of ten between two numbers."""
    first, last = np.ceil(np.log10(low)), np.floor(np.log10(high))
    powers = 10.0 ** np.arange(first - 1, last + 1)
    steps = np.outer(powers, [1, 2, 5]).ravel()
    return [float(step) for step in steps if low <= step <= high]


# ---- Growth rates


def is_growth(name: object) -> bool:
    """Whether a variable is a growth rate, by its name."""
    return str(name).endswith("growth_rate")


def growth_norm(rates: Array) -> AsinhNorm:
    """A colour scale that is nearly linear near 0 and nearly logarithmic beyond a thirtieth of its
    end, or beyond a part of the median size where a few rates are much larger."""
    sizes = np.abs(rates[np.isfinite(rates)])
    # the zeros of undamped modes say nothing of the others
    sizes = sizes[sizes > ROUNDING]
    if not sizes.size or np.median(sizes) <= GREATEST:
        return _growth_norm_to(GREATEST)
    greatest = float(np.quantile(sizes, COMMON, method="higher"))
    return _growth_norm_to(greatest, LINEAR_OF_MEDIAN * float(np.median(sizes)))


def _growth_norm_to(greatest: float, linear: float = np.inf) -> AsinhNorm:
    """The scale of growth rates that ends at one of them, in 1/s, and is nearly linear up to a
    thirtieth of it, or less."""
    width = min(linear, LINEAR_SHARE * greatest)
    return AsinhNorm(linear_width=width, vmin=-greatest, vmax=greatest)


def growth_colours(rates: Array, wishes: ColourWishes = USUAL) -> Scale:
    """Colours of growth rates (1/s): those of all figures, around zero, whose scale is nearly
    logarithmic on both sides. Rates of one sign have the half of it from zero on.

    Colours without a middle, limits that leave out zero, a linear scale, and a logarithmic one of rates
    of one sign have the scale of any other number.
    """
    if not _has_scale_of_rates(rates, wishes):
        return colours_of(rates, xr.DataArray(0.0, name="growth_rate"), wishes)
    norm = growth_norm(rates)
    if wishes.limits is not None:
        norm = _growth_norm_to(max(map(abs, wishes.limits)))
    end = float(norm.vmax or GREATEST)
    low, high = _ends_of_bar(rates, end, wishes)
    below = rates < low - ROUNDING
    above = rates > high + ROUNDING
    open_ends = (bool(below.any()), bool(above.any()))
    shown = AsinhNorm(linear_width=norm.linear_width, vmin=low, vmax=high)
    part = np.linspace(float(norm(low)), float(norm(high)), COLOURS)
    cmap = _chosen(wishes, cm.vik)
    if low == 0 or high == 0:
        cmap = ListedColormap(cmap(part))
    return Scale(cmap, shown, places=_places_of_rates(shown), open_ends=open_ends)


def _ends_of_bar(rates: Array, end: float, wishes: ColourWishes) -> tuple[float, float]:
    """The rates at the ends of the bar: zero at one end where no rate has that sign, but for
    rounding, unless a reader has set limits on both sides."""
    low, high = wishes.limits or _ends_of(rates[np.isfinite(rates)], log=False)
    if low >= -ROUNDING and high > ROUNDING:
        return 0.0, end
    if high <= ROUNDING and low < -ROUNDING:
        return -end, 0.0
    return -end, end


def _places_of_rates(norm: AsinhNorm) -> list[float]:
    """Ticks of the bar of growth rates: both ends, zero, and one and three times two powers of ten on
    each side that are not near an end."""
    low, high = float(norm.vmin or 0.0), float(norm.vmax or 0.0)
    largest = float(10.0 ** np.floor(np.log10(max(-low, high))))
    sizes = [largest / 10, 3 * largest / 10, largest, 3 * largest]
    below = [-size for size in reversed(sizes)]
    return _with_ends([*below, 0.0, *sizes], norm)


def _with_ends(places: Sequence[float], norm: Normalize) -> list[float]:
    """The ends of a scale, and those of some places between them that are not near one."""
    inside = [float(place) for place in places if NEAR_END < float(norm(place)) < 1 - NEAR_END]
    return [float(norm.vmin or 0.0), *inside, float(norm.vmax or 0.0)]


def _has_scale_of_rates(rates: Array, wishes: ColourWishes) -> bool:
    """Whether the scale of growth rates is that of all figures, with a neutral zero."""
    if wishes.limits is not None and not wishes.limits[0] <= 0 <= wishes.limits[1]:
        return False
    if wishes.has_no_middle or wishes.linear:
        return False
    both = (rates < 0).any() and (rates > 0).any()
    return bool(both) or not wishes.log


# ---- Scales through zero


def needs_zero(values: np.ndarray) -> bool:
    """Whether a logarithmic scale of numbers has to pass through zero."""
    return bool((values <= 0).any())


def linear_to(values: np.ndarray) -> float:
    """The size up to which a logarithmic scale through zero is linear: the least of the numbers
    but zero, at most `SPAN` below the greatest."""
    sizes = np.abs(values[np.isfinite(values) & (values != 0)])
    if not sizes.size:
        return 1.0
    return float(max(sizes.min(), sizes.max() / SPAN))


def _through_zero(cmap: Colormap, values: Array, low: float, high: float) -> Scale:
    """Colours of numbers between two ends, on a scale that is logarithmic on both sides of zero."""
    linear = linear_to(values)
    if low == high == 0:
        high = linear
    norm = AsinhNorm(linear_width=linear, vmin=low, vmax=high)
    return Scale(cmap, norm, places=_with_ends(decades_through_zero(linear, low, high), norm))


def decades_through_zero(linear: float, low: float, high: float) -> list[float]:
    """Ticks between two numbers: zero and powers of ten beyond where the scale is linear, or the
    numbers if there are less than two of these."""
    size = max(-low, high, linear)
    first = np.ceil(np.log10(linear))
    last = np.floor(np.log10(size))
    every = max(1.0, np.ceil((last - first + 1) / MOST_TICKS))
    sizes = 10.0 ** np.arange(last, first - 0.5, -every)
    ticks = [tick for tick in sorted([*(-sizes), 0.0, *sizes]) if low <= tick <= high]
    if len(ticks) < 2:
        apart = [tick for tick in ticks if min(abs(tick - low), abs(tick - high)) > NEAR * size]
        return sorted({low, *apart, high})
    return ticks


def texts_of(places: Sequence[float]) -> list[str]:
    """The texts of ticks, with the sign that other axes have below zero, and as many digits as tell them
    apart."""
    rounded: list[float] = []
    for digits in DIGITS:
        rounded = [float(f"{place:.{digits}g}") for place in places]
        if len({*rounded}) == len(places):
            break
    return [Formatter.fix_minus(f"{place:.{DIGITS[-1]}g}") for place in rounded]


def within_a_decade(norm: Normalize) -> bool:
    """Whether a logarithmic scale spans less than a factor of ten, and has even steps."""
    return norm.vmin is not None and norm.vmax is not None and norm.vmax < 10 * norm.vmin


# ---- Bars


def draw_bar(figure: FigureBase, axes: Sequence[Axes], mesh: Any, scale: Scale, label: str) -> None:
    """Draw the bar of the colours of a map, beside its panels."""
    extend = EXTENDS[scale.open_ends]
    shared = parents_of_bar(axes)
    bar = figure.colorbar(mesh, ax=shared, extend=extend, pad=0.01, aspect=30, label=label)
    if scale.places:
        bar.set_ticks(scale.places, labels=texts_of(scale.places))
        bar.minorticks_off()
    elif scale.ticks:
        bar.set_ticks(range(len(scale.ticks)), labels=list(scale.ticks))
        bar.minorticks_off()
    elif isinstance(scale.norm, LogNorm):
        # else their count depends on the height, and may leave two of five
        bar.locator = LogLocator(numticks=MOST_POWERS)


def bars_of(ax: Axes) -> list[Axes]:
    """The axes of the bars of colours that belong to a panel alone."""
    bars = [mesh.colorbar for mesh in ax.collections]
    return [bar.ax for bar in bars if bar is not None]
