"""Errors of the values of a curve, where a study has them."""

from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.drawing import GREY, mark, wide
from disc_model.figures.selection import parts_along
from disc_model.figures.types import Array, Axes
from disc_model.figures.words import measured

OF_VARIABLES = {"exponent": "exponent_error", "exponents": "errors"}
"""Variables that have an error, and its name."""
MOST_BARS = 30  # points of a line beyond which a band shows the errors
STRENGTH = 0.25  # of the colour of a band


def errors_by_part(study: xr.Dataset, variable: str, by: str | None) -> dict[str, Array]:
    """The errors of the values of each line, in the unit of the figure; none if the study has none."""
    name = OF_VARIABLES.get(variable)
    if name is None or name not in study:
        return {}
    errors = study[name].transpose(*study[variable].dims)
    errors = errors.copy(data=measured(errors).values)
    return {part.name: part.data.values for part in parts_along(errors, by)}


def name_errors(ax: Axes, study: xr.Dataset, variable: str) -> bool:
    """Name the bars or bands of errors in the legend of a panel; returns whether a study has errors."""
    if OF_VARIABLES.get(variable) not in study:
        return False
    ax.plot([], [], label="bar or band: one error", marker="|", linestyle="", color=GREY)
    return True


def draw_errors(ax: Axes, along: Array, heights: Array, errors: Array | None, colour: Any) -> None:
    """Draw a bar of one error above and below each value of a line, or a band along many; nothing where
    an error is not known."""
    if errors is None:
        return
    known = np.isfinite(heights) & np.isfinite(errors)
    if not known.any():
        return
    if heights.size > MOST_BARS:
        low = np.where(known, heights - errors, np.nan)
        high = np.where(known, heights + errors, np.nan)
        ax.fill_between(along, low, high, color=colour, alpha=STRENGTH, linewidth=0)
        return
    look: dict[str, Any] = {"ecolor": colour, "elinewidth": wide(0.7), "capsize": mark(2)}
    ax.errorbar(along[known], heights[known], errors[known], fmt="none", label="_nolegend_", **look)
