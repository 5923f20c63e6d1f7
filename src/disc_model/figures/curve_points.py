"""Curves of a variable that has several values at each point, such as a bifurcation diagram: all are
drawn as points."""

from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.branch_lines import Look
from disc_model.figures.class_axis import join_classes
from disc_model.figures.curve_heights import heights_of
from disc_model.figures.curve_marks import measured_along, open_look, reasons_of_gaps
from disc_model.figures.curve_scales import set_scales
from disc_model.figures.error_bars import draw_bars, errors_of
from disc_model.figures.gap_rows import add_row
from disc_model.figures.kind_rows import add_kinds, has_kinds
from disc_model.figures.point_groups import points_of
from disc_model.figures.types import Axes


def draw_points(
    ax: Axes,
    study: xr.Dataset,
    variable: str,
    x: str,
    log: bool,
    look: Look,
    marker: str,
    sweep: int | None = None,
) -> list[tuple[str, Any]]:
    """Draw all values of a variable at each place along a dimension; rings are of motions that had not
    settled, or of averages that have not converged, and marks above the panel of what kind of motion
    samples are of, and of places without any value. Returns the points with the names of the events at
    which they were sampled, or all of them, with the number of modes that they are of, and the rings
    with their names.

    sweep : number of sweeps and variables that were drawn there before
    """
    names, array = join_classes(ax, *heights_of(study, variable))
    array = array.transpose(x, ...)
    along = measured_along(array[x]).values
    places = np.broadcast_to(along[:, None], array.shape)
    heights = array.values.astype(float)

    parts = points_of(study, array, look, marker, sweep or 0)
    shown = [part for part in parts if part.mask.any()] or parts[:1]
    drawn = []
    for part in shown:
        named = {"label": part.name} if part.name else {}
        dots = {"linestyle": "", **part.look, **named}
        [points] = ax.plot(places[part.mask], heights[part.mask], **dots)
        drawn.append((part.name, points))
    errors = errors_of(study, array)
    if errors is not None:
        each = (places.ravel(), heights.ravel(), errors.values.ravel())
        draw_bars(ax, *each, look.colour)
    set_scales(ax, study, names, array, x, log)

    if "sample" in array.dims and has_kinds(study, x):
        known = np.isfinite(heights).any(axis=1)  # others have a row of their reason
        add_kinds(ax, study.isel({x: known}), along[known], look.colour, sweep)
    row: dict[str, Any] = {"color": look.colour, "marker": "o" if marker == "." else marker}
    for reason, gone in reasons_of_gaps(study, array).items():
        here = gone.transpose(x, ...).values.all(axis=1)
        if here.any():
            reason = reason.replace("no further ", "no ")  # there is none at all
            add_row(ax, reason, along[here], **open_look(), **row)
    return drawn
