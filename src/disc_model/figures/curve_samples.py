"""Curves of many samples: thin lines without names, as pictures of uncertainty have them."""

from typing import Any

import numpy as np
import xarray as xr

from disc_model.display import counted
from disc_model.figures.branch_lines import Look
from disc_model.figures.class_axis import join_classes
from disc_model.figures.curve_heights import heights_of
from disc_model.figures.curve_looks import dashes_of, draw_dots
from disc_model.figures.curve_marks import measured_along, open_look, reasons_of_gaps
from disc_model.figures.curve_pieces import open_steps, pieces_of
from disc_model.figures.curve_scales import set_scales
from disc_model.figures.drawing import BLACK, GREY, wide
from disc_model.figures.gap_rows import add_row
from disc_model.figures.selection import parts_along, remaining
from disc_model.figures.types import Array, Axes, Mask

MOST_NAMED = 6  # samples whose lines have a name each
WIDTH = 0.5  # points, of a line


def draw_samples(
    ax: Axes, study: xr.Dataset, variable: str, x: str, log: bool, look: Look, marker: str
) -> list[tuple[str, Any]]:
    """Draw a thin line for each sample of a study; marks above the panel, in one row for each reason,
    say where some samples have no value. Returns the first line with the name of all.

    look : grey stands for black
    """
    names, array = join_classes(ax, *heights_of(study, variable))
    by = remaining(array, [x])
    along = measured_along(array[x]).values
    colour = GREY if look.colour == BLACK else look.colour
    line: dict[str, Any] = {"color": colour, "linewidth": wide(WIDTH), "linestyle": ""}
    if not names:
        line["linestyle"] = dashes_of(look)
    parts = parts_along(array, by)
    steps: dict[str, Mask] = {}
    if along.dtype.kind != "U":
        steps = open_steps(study, array, by, log)

    name = counted(len(parts), "sample")
    shown = sum(bool(np.isfinite(part.data.values.astype(float)).any()) for part in parts)
    if shown < len(parts):
        name = f"{shown} of {name}"
    drawn = []
    for part in parts:
        heights = part.data.values
        is_open = steps.get(part.name, np.zeros(heights.size - 1, dtype=bool))
        drawn += ax.plot(*pieces_of(along, heights, steps.get(part.name)), **line)
        alone = _stands_alone(heights, is_open)
        if names:
            alone = np.isfinite(heights)
        if alone.any():
            draw_dots(ax, along[alone], heights[alone], colour)
    drawn[0].set_label(name)
    set_scales(ax, study, names, array, x, log)
    _mark_missing(ax, study, array, x, {"color": colour, "marker": marker})
    return [(name, drawn[0])]


def _stands_alone(heights: Array, is_open: Mask) -> Mask:
    """Points that no line joins to a neighbour."""
    has_value = np.isfinite(heights)
    joins = has_value[1:] & has_value[:-1] & ~is_open
    joined = np.zeros(heights.size, dtype=bool)
    joined[1:] |= joins
    joined[:-1] |= joins
    return has_value & ~joined


def _mark_missing(
    ax: Axes, study: xr.Dataset, array: xr.DataArray, x: str, look: dict[str, Any]
) -> None:
    """Mark where samples have no value above the panel, in a row for each reason."""
    along = measured_along(array[x]).values
    for reason, gone in reasons_of_gaps(study, array).items():
        here = gone.any([dim for dim in gone.dims if dim != x]).values
        if here.any():
            add_row(ax, reason, along[here], **open_look(), **look)
