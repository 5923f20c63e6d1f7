"""Parts of a study of several values at each point, such as a bifurcation diagram over two parameters, that
are drawn beside each other as several sweeps are."""

from typing import Any

import xarray as xr

from disc_model.figures.family import LOOKS
from disc_model.figures.selection import without_single
from disc_model.figures.sweep_dimensions import only_counts


def parts_beside(study: xr.Dataset, variable: Any, x: str, lines: Any) -> list[xr.Dataset]:
    """The parts of a study at each value of the second of two dimensions, beside which a third one counts
    the values of a variable; none if the variable varies otherwise.

    x, lines : dimensions along the horizontal axis, and of the parts; "" for the other one, or that of
        fewer values
    """
    if not isinstance(variable, str) or variable not in study:
        return []
    dims = [str(dim) for dim in without_single(study)[variable].dims]
    points = [dim for dim in dims if not only_counts(study, dim)]
    if len(dims) != 3 or len(points) != 2:
        return []
    by = _dimension_of_parts(study, points, x, lines)
    if not by:
        return []
    return [study.isel({by: place}) for place in range(study.sizes[by])]


def _dimension_of_parts(study: xr.Dataset, points: list[str], x: str, lines: Any) -> str:
    """The one of two dimensions along which the parts lie: the one asked for, or else the one that is
    not `x`, or that of fewer values; "" if it is not one of these, or has more values than there are
    looks."""
    by = lines or min(points, key=lambda dim: study.sizes[dim])
    if not lines and x in points:
        [by] = [dim for dim in points if dim != x]
    if by not in points or by == x or study.sizes[by] > len(LOOKS):
        return ""
    return str(by)
