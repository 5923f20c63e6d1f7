"""Curves of a variable that has several values at each point, such as a bifurcation diagram: all are
drawn as points."""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.display import counted
from disc_model.figures.bifurcation import MARKS, UNDECIDED, UNDECIDED_NAME, apart
from disc_model.figures.branch_lines import Look
from disc_model.figures.class_axis import join_classes
from disc_model.figures.classes import NOT_CONVERGED
from disc_model.figures.curve import DOT, heights_of, set_scales
from disc_model.figures.curve_marks import MARK, measured_along, open_look, reasons_of_gaps
from disc_model.figures.drawing import BLACK, mark
from disc_model.figures.error_bars import draw_bars, errors_of
from disc_model.figures.gap_rows import add_row
from disc_model.figures.sections import names_of_events
from disc_model.figures.selection import not_converged
from disc_model.figures.types import Axes, Mask

MANY = 300  # points, which are small marks


class Points(NamedTuple):
    """Points of one look: their name, "" without one, and which values they are."""

    name: str
    mask: Mask
    look: dict[str, Any]


def draw_points(
    ax: Axes, study: xr.Dataset, variable: str, x: str, log: bool, look: Look, marker: str
) -> list[tuple[str, Any]]:
    """Draw all values of a variable at each place along a dimension; rings are of motions that had not
    settled, or of averages that have not converged, and marks above the panel of places without any
    value. Returns the points with the names of the events at which they were sampled, or all of them,
    with the number of modes that they are of, and the rings with their names."""
    names, array = join_classes(ax, *heights_of(study, variable))
    array = array.transpose(x, ...)
    along = measured_along(array[x]).values
    places = np.broadcast_to(along[:, None], array.shape)
    heights = array.values.astype(float)

    doubtful = _not_settled(study, array)
    unsure = _not_converged(study, array)
    parts = [
        *_parts_of(study, array, ~doubtful & ~unsure, look, marker),
        Points(UNDECIDED_NAME, apart(heights, doubtful & np.isfinite(heights)), ring_of(look)),
        Points(NOT_CONVERGED.label, unsure & np.isfinite(heights), ring_of(look)),
    ]
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

    row: dict[str, Any] = {"color": look.colour, "marker": "o" if marker == "." else marker}
    for reason, gone in reasons_of_gaps(study, array).items():
        here = gone.transpose(x, ...).values.all(axis=1)
        if here.any():
            reason = reason.replace("no further ", "no ")  # there is none at all
            add_row(ax, reason, along[here], **open_look(), **row)
    return drawn


def ring_of(look: Look) -> dict[str, Any]:
    """The look of rings about values in doubt: grey, or beside black dots the colour of their sweep."""
    ring = {**UNDECIDED, "markersize": mark(UNDECIDED["markersize"])}
    return ring if look.colour == BLACK else {**ring, "color": look.colour}


def _parts_of(
    study: xr.Dataset, array: xr.DataArray, shown: Mask, look: Look, marker: str
) -> list[Points]:
    """The points that are shown of each event at which values were sampled, with its name and look; all
    of them together if they were not sampled at events."""
    size = DOT if array.size > MANY else MARK
    dots: dict[str, Any] = {"color": look.colour, "marker": marker, "markersize": mark(size)}
    if marker != ".":
        dots |= {"markerfacecolor": "none", "markersize": mark(MARK)}
    parts = []
    for phase, name in names_of_events(study).items():
        mask = _in_phase(study, array, phase) & shown
        if mask.any():
            parts.append(Points(name, mask, {**dots, **_look_at(phase, look, marker)}))
    return parts or [Points(_number_of_modes(array), shown, dots)]


def _number_of_modes(array: xr.DataArray) -> str:
    """How many modes the points are of, as a name; "" if they are of anything else."""
    if "mode" not in array.dims:
        return ""
    along = [dim for dim in array.dims if dim != "mode"]
    return counted(int(array.notnull().any(along).sum()), "mode")


def _look_at(phase: str, look: Look, marker: str) -> dict[str, Any]:
    """What tells samples in a phase from others of a sweep, whose colour they have: the marks of a bifurcation
    diagram, or beside other sweeps full marks of releases, and open ones of separations."""
    if marker == ".":
        return {"marker": MARKS[phase]["marker"]}
    return {"markerfacecolor": look.colour} if phase == "stick" else {}


def _in_phase(study: xr.Dataset, array: xr.DataArray, phase: str) -> Mask:
    """Values that were sampled in a phase of the motion."""
    phases = study.get("phase")
    if phases is None or {*phases.dims} != {*array.dims}:
        return np.zeros(array.shape, dtype=bool)
    return np.asarray(flag_names(phases.transpose(*array.dims)) == phase)


def _not_converged(study: xr.Dataset, array: xr.DataArray) -> Mask:
    """Values that are averages over too short a time."""
    found = not_converged(study, str(array.name))
    if found is None:
        return np.zeros(array.shape, dtype=bool)
    return np.asarray(found.transpose(*array.dims).values)


def _not_settled(study: xr.Dataset, array: xr.DataArray) -> Mask:
    """Values of motions that are not shown to have settled, which a bifurcation diagram tells."""
    settled = study.get("settled")
    if settled is None or settled.dims != array.dims[:1]:
        return np.zeros(array.shape, dtype=bool)
    late = flag_names(settled) == "settled"
    return np.broadcast_to(~late[:, None], array.shape)
