"""Error bars of numbers that are averages over a time, such as Lyapunov exponents."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.curve_marks import measured_along
from disc_model.figures.drawing import GREY, mark, wide
from disc_model.figures.selection import companion_of, parts_along, remaining
from disc_model.figures.separating_share import INTERVAL
from disc_model.figures.types import Array, Axes
from disc_model.figures.words import label_of

STANDARD_ERRORS = {"exponent": "exponent_error", "exponents": "errors"}
"""Variables of standard errors, by those whose errors they are."""
NAME = "± standard error"
MOST_BARS = 30  # points of a line beyond which a band shows the errors
STRENGTH = 0.25  # of the colour of a band


def errors_of(study: xr.Dataset, array: xr.DataArray) -> xr.DataArray | None:
    """The standard errors of a variable along its dimensions; None if the study does not have them."""
    name = str(array.name)
    found = companion_of(study, name, STANDARD_ERRORS.get(name, ""))
    if found is None:
        return None
    factor = label_of(study[name])[1]
    return (factor * found).transpose(*array.dims)


def draw_errors(
    ax: Axes, study: xr.Dataset, array: xr.DataArray, x: str, colours: Mapping[str, Any]
) -> None:
    """Draw the standard errors of a variable as bars about its points, in the colours of its lines."""
    errors = errors_of(study, array)
    if errors is None:
        return
    by = remaining(array, [x])
    along = measured_along(array[x]).values
    lines = zip(parts_along(array, by), parts_along(errors, by), strict=True)
    for heights, error in lines:
        draw_bars(ax, along, heights.data.values, error.data.values, colours[heights.name])


def names_errors(ax: Axes) -> bool:
    """Whether the legend of a panel names errors."""
    return NAME in ax.get_legend_handles_labels()[1]


def draw_bars(ax: Axes, along: Array, heights: Array, errors: Array, colour: Any) -> None:
    """Draw bars of errors about points, or a band along many, with one entry of the legend for all."""
    known = np.isfinite(heights) & np.isfinite(errors)
    if not known.any():
        return
    if not names_errors(ax):
        look: dict[str, Any] = {"marker": INTERVAL, "markersize": mark(8), "color": GREY}
        ax.plot([], [], linestyle="", label=NAME, **look)
    if heights.size > MOST_BARS:
        low = np.where(known, heights - errors, np.nan)
        high = np.where(known, heights + errors, np.nan)
        ax.fill_between(along, low, high, color=colour, alpha=STRENGTH, linewidth=0)
        return
    bars: dict[str, Any] = {"fmt": "none", "ecolor": colour, "capsize": mark(2)}
    ax.errorbar(along[known], heights[known], errors[known], elinewidth=wide(0.6), **bars)
