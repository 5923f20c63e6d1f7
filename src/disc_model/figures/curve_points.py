"""Curves of a variable that has several values at each point, such as a bifurcation diagram: all are
drawn as points."""

from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.bifurcation import UNDECIDED, UNDECIDED_NAME, apart
from disc_model.figures.branch_lines import Look
from disc_model.figures.curve import DOT, heights_of, set_scales
from disc_model.figures.curve_marks import MARK, measured_along, open_look, reasons_of_gaps
from disc_model.figures.drawing import mark
from disc_model.figures.gap_rows import add_row
from disc_model.figures.types import Axes, Mask

MANY = 300  # points, which are small marks


def draw_points(
    ax: Axes, study: xr.Dataset, variable: str, x: str, log: bool, look: Look, marker: str
) -> list[tuple[str, Any]]:
    """Draw all values of a variable at each place along a dimension; rings are of motions that had not
    settled, and marks above the panel of places without any value. Returns the points, which have
    no name."""
    names, array = heights_of(study, variable)
    array = array.transpose(x, ...)
    along = measured_along(array[x]).values
    places = np.broadcast_to(along[:, None], array.shape)
    heights = array.values.astype(float)

    doubtful = _not_settled(study, array)
    size = DOT if heights.size > MANY else MARK
    dots: dict[str, Any] = {"color": look.colour, "marker": marker, "markersize": mark(size)}
    if marker != ".":
        dots |= {"markerfacecolor": "none", "markersize": mark(MARK)}
    [points] = ax.plot(places[~doubtful], heights[~doubtful], linestyle="", **dots)
    rings = apart(heights, doubtful & np.isfinite(heights))
    if rings.any():
        sized = {**UNDECIDED, "markersize": mark(UNDECIDED["markersize"])}
        ax.plot(places[rings], heights[rings], linestyle="", label=UNDECIDED_NAME, **sized)
    set_scales(ax, study, names, array, x, log)

    row: dict[str, Any] = {"color": look.colour, "marker": "o" if marker == "." else marker}
    for reason, gone in reasons_of_gaps(study, array).items():
        here = gone.transpose(x, ...).values.all(axis=1)
        if here.any():
            add_row(ax, reason, along[here], **open_look(), **row)
    return [("", points)]


def _not_settled(study: xr.Dataset, array: xr.DataArray) -> Mask:
    """Values of motions that are not shown to have settled, which a bifurcation diagram tells."""
    settled = study.get("settled")
    if settled is None or settled.dims != array.dims[:1]:
        return np.zeros(array.shape, dtype=bool)
    late = flag_names(settled) == "settled"
    return np.broadcast_to(~late[:, None], array.shape)
