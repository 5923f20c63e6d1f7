"""What curves show beside their values, by the rules of the figures: the steps at which they are open,
and points whose value may be another one."""

import numpy as np
import xarray as xr

from disc_model.figures.classes import AT_BOUND, Look
from disc_model.figures.curve_heights import heights_of
from disc_model.figures.curve_pieces import open_steps
from disc_model.figures.rate_scale import RATE
from disc_model.figures.selection import OF_CYCLES, at_lower_bound, border_alone, doubts
from disc_model.figures.tongues import has_ranges
from disc_model.figures.types import Mask


def open_along(study: xr.Dataset, name: str) -> dict[str, Mask]:
    """The steps at which curves of a variable along each of its dimensions are open, in the shape of
    the variable: at the points where they begin. Only dimensions with such steps, and those of
    numbers, as points along words are not joined."""
    is_open = name in OF_CYCLES or has_ranges(study, name)
    if not is_open and border_alone(study, name) is None:
        return {}
    needed = (name, RATE, "border", "at_lower_bound", "crossing", "crossing_kind")
    part = study[[other for other in needed if other in study]]
    _, heights = heights_of(part, name)
    found = {}
    for dim in map(str, heights.dims):
        if dim in study.coords and study[dim].dtype.kind in "fiu":
            steps = _open_lines(part, heights, dim)
            if steps.any():
                found[dim] = steps
    return found


def _open_lines(part: xr.Dataset, heights: xr.DataArray, along: str) -> Mask:
    """The open steps of all lines of a variable along a dimension."""
    found = np.zeros(heights.shape, dtype=bool)
    at = heights.dims.index(along)
    lines = np.moveaxis(found, at, -1)[..., :-1]
    others = [str(dim) for dim in heights.dims if dim != along]
    for place in np.ndindex(lines.shape[:-1]):
        chosen = dict(zip(others, place, strict=True))
        steps = open_steps(_at(part, chosen), heights.isel(chosen), by=None, log=False)
        for of_line in steps.values():
            lines[place] = of_line
    return found


def _at(part: xr.Dataset, chosen: dict[str, int]) -> xr.Dataset:
    """A part of a study at a place along those of its dimensions that it has."""
    return part.isel(chosen, missing_dims="ignore")


def bounds_and_doubts(study: xr.Dataset, name: str) -> dict[Look, Mask]:
    """Points whose value is the bound of its search, or may be another than that of a settled motion
    from the static start, by the look that says so, in the shape of the variable."""
    variable = study[name]
    marked = {AT_BOUND: at_lower_bound(study, name), **doubts(study, name)}
    found = {}
    for look, mask in marked.items():
        if mask is None or not {*mask.dims} <= {*variable.dims}:
            continue
        points = mask.broadcast_like(variable).transpose(*variable.dims)
        shown = (points & variable.notnull()).values
        if shown.any():
            found[look] = shown
    return found
