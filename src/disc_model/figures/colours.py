"""Colours of numbers on a map: of counts, of values of one sign or two, and on a logarithmic scale."""

from collections.abc import Sequence
from dataclasses import dataclass
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
from matplotlib.ticker import FixedLocator, Formatter

from disc_model.errors import require
from disc_model.figures.growth import is_growth
from disc_model.figures.types import Axes

FEW = 12  # counts below which each has a colour of its own
SPAN = 1e3  # of a logarithmic scale on each side of zero, from where it is linear to its end
MOST_TICKS = 3  # on each side of zero


@dataclass(frozen=True)
class Scale:
    """Colours of numbers: a map and a scale of matplotlib, and the ticks of its bar: words if each
    number has a colour of its own, or places on a logarithmic scale through zero."""

    cmap: Colormap
    norm: Normalize
    ticks: Sequence[str] = ()
    places: Sequence[float] = ()


def colours_of(numbers: np.ndarray, array: xr.DataArray, log: bool) -> Scale:
    """Colours of all numbers of a figure: each of few counts, logarithmic, around zero, or between
    the least and the greatest."""
    if array.dtype.kind == "i" and numbers.max() < FEW:
        return counted(int(numbers.max()) + 1)
    values = numbers[np.isfinite(numbers)]
    if log:
        return _logarithmic(values, is_growth(array.name))
    if not values.size:
        return Scale(cm.batlow, Normalize(0.0, 1.0))
    low = float(values.min())
    high = float(values.max())
    if low < 0 < high:
        most = max(-low, high)
        return Scale(cm.vik, Normalize(-most, most))
    return Scale(cm.batlow, Normalize(low, high))


def counted(count: int) -> Scale:
    """A colour for each of the numbers 0, 1, ... below a count."""
    colours = [cm.batlow(i / count) for i in range(count)]
    cmap, norm = from_levels_and_colors((np.arange(count + 1) - 0.5).tolist(), colours)
    return Scale(cmap, norm, [str(i) for i in range(count)])


def _logarithmic(values: np.ndarray, growth: bool) -> Scale:
    """Colours of numbers on a logarithmic scale, on both sides of zero if not all are positive;
    positive growth rates have the red half of the scale of their maps."""
    if needs_zero(values):
        return _through_zero(values)
    low, high = (values.min(), values.max()) if values.size else (1.0, 10.0)
    cmap: Any = ListedColormap(cm.vik(np.linspace(0.55, 1, 256))) if growth else cm.batlow
    return Scale(cmap, LogNorm(low, high if high > low else 10 * low))


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


def _through_zero(values: np.ndarray) -> Scale:
    """Colours on a scale that is logarithmic on both sides of zero, around zero if there are
    numbers on both."""
    linear = linear_to(values)
    low = float(values.min())
    high = float(values.max())
    cmap: Any = cm.batlow
    if low < 0 < high:
        high = max(-low, high)
        low = -high
        cmap = cm.vik
    elif low == high == 0:
        high = linear
    norm = AsinhNorm(linear_width=linear, vmin=low, vmax=high)
    return Scale(cmap, norm, places=decades_through_zero(linear, low, high))


def decades_through_zero(linear: float, low: float, high: float) -> list[float]:
    """Ticks between two numbers: zero and powers of ten beyond where the scale is linear, or the
    numbers if there are less than two of these."""
    first = np.ceil(np.log10(linear))
    last = np.floor(np.log10(max(-low, high)))
    every = max(1.0, np.ceil((last - first + 1) / MOST_TICKS))
    sizes = 10.0 ** np.arange(last, first - 0.5, -every)
    ticks = [tick for tick in sorted([*(-sizes), 0.0, *sizes]) if low <= tick <= high]
    if len(ticks) < 2:
        return sorted({low, *ticks, high})
    return ticks


def texts_of(places: Sequence[float]) -> list[str]:
    """The texts of ticks, with the sign that other axes have below zero."""
    return [Formatter.fix_minus(f"{place:g}") for place in places]


def within_a_decade(norm: Normalize) -> bool:
    """Whether a logarithmic scale has no two powers of ten, and needs further ticks."""
    return norm.vmin is not None and norm.vmax is not None and norm.vmax < 10 * norm.vmin


def is_colormap(cmap: object) -> bool:
    """Whether this is a colour map, its name, or nothing."""
    if isinstance(cmap, str):
        return cmap in colormaps
    return cmap is None or isinstance(cmap, Colormap)


def recolour(ax: Axes, cmap: str | Colormap) -> None:
    """Give the numbers of a map other colours; raises `ParameterError` where there are none."""
    of_numbers = []
    for mesh in ax.collections:
        array = mesh.get_array()
        if array is not None and array.ndim == 2:
            of_numbers.append(mesh)
    rule = "is for maps of numbers: classes and lines have colours of their own"
    require((bool(of_numbers), "cmap", cmap, rule))
    for mesh in of_numbers:
        bar = mesh.colorbar
        if bar is None:
            mesh.set_cmap(cmap)
            continue
        ticks = bar.get_ticks().tolist()
        names = [text.get_text() for text in bar.ax.get_yticklabels()]
        fixed = isinstance(bar.locator, FixedLocator)
        mesh.set_cmap(cmap)
        if fixed:  # which a bar of other colours forgets
            bar.set_ticks(ticks, labels=names)
            bar.minorticks_off()
