"""Colours of numbers on a map: of counts, of values of one sign or two, and on a logarithmic scale."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from cmcrameri import cm
from matplotlib.colors import Colormap, ListedColormap, LogNorm, Normalize, from_levels_and_colors

from disc_model.figures.growth import is_growth

FEW = 12  # counts below which each has a colour of its own


@dataclass(frozen=True)
class Scale:
    """Colours of numbers: a map and a scale of matplotlib, and the ticks of its bar if each number
    has a colour of its own."""

    cmap: Colormap
    norm: Normalize
    ticks: Sequence[str] = ()


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
    """Colours of positive numbers; growth rates have the red half of the scale of their maps."""
    above = values[values > 0]
    low, high = (above.min(), above.max()) if above.size else (1.0, 10.0)
    cmap: Any = ListedColormap(cm.vik(np.linspace(0.55, 1, 256))) if growth else cm.batlow
    return Scale(cmap, LogNorm(low, high if high > low else 10 * low))


def within_a_decade(norm: Normalize) -> bool:
    """Whether a logarithmic scale has no two powers of ten, and needs further ticks."""
    return norm.vmin is not None and norm.vmax is not None and norm.vmax < 10 * norm.vmin
