"""Pieces of lines: none leads to the lower bound of a search, or over a step that may join different
cycles."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.rate_scale import RATE, are_of_cycles, are_rates, opens
from disc_model.figures.selection import at_lower_bound, border_alone, opened, parts_along
from disc_model.figures.tongues import has_ranges, steps_between_ranges
from disc_model.figures.types import Array, Axes, Mask


def at_bound_by_line(study: xr.Dataset, array: xr.DataArray, by: str | None) -> dict[str, Mask]:
    """Points of each line whose value is the lower bound of its search."""
    bound = at_lower_bound(study, str(array.name))
    if bound is None:
        bound = array.copy(data=np.zeros(array.shape, dtype=bool))
    return {part.name: part.data.values for part in parts_along(bound, by)}


def draw_at_bound(
    ax: Axes, along: Array, heights: Array, at_bound: Mask, look: Mapping[str, Any]
) -> Array:
    """Draw the points of a line that are at the bound of a search, and return the heights of the others:
    the value may lie anywhere below, so that no line leads there."""
    if at_bound.any():
        alone = {**look, "linestyle": "", "label": "_nolegend_"}
        ax.plot(along[at_bound], heights[at_bound], **alone)
    return np.where(at_bound, np.nan, heights)


def open_steps(
    study: xr.Dataset, array: xr.DataArray, by: str | None, log: bool
) -> dict[str, Mask]:
    """The steps at which each line of a variable is open: of critical values, those to or from the main
    border of stability; of critical speeds, those to another range of separation; of a variable of
    cycles, those at which the growth rate says that they may lead to another cycle; none of other
    variables."""
    on_border = border_alone(study, str(array.name))
    if on_border is not None:
        parts = parts_along(on_border, by)
        return {part.name: np.abs(np.diff(part.data.values)) > 0 for part in parts}
    if has_ranges(study, str(array.name)):
        return steps_between_ranges(study, by)
    rates = array if array.name == RATE else study.get(RATE, array)
    if not are_of_cycles(array, rates) or (array.name == RATE and not are_rates(array, log)):
        return {}
    return {part.name: opens(part.data.values) for part in parts_along(rates, by)}


def pieces_of(along: Array, heights: Array, is_open: Mask | None) -> list[Array]:
    """What is plotted of a line, which ends at its open steps and begins again, if it has any."""
    if is_open is None:
        return [along, heights]
    return opened(along, heights, is_open)
