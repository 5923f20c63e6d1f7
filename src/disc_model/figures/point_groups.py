"""Points of several values at each place, in groups of one look: those of an event, and those in doubt."""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.display import counted
from disc_model.figures.bifurcation_samples import MARKS, UNDECIDED, rings_of
from disc_model.figures.branch_lines import Look
from disc_model.figures.classes import NOT_CONVERGED
from disc_model.figures.curve_looks import DOT, MARK, WIDEST
from disc_model.figures.drawing import BLACK, mark, wide
from disc_model.figures.sections import names_of_events
from disc_model.figures.selection import not_converged
from disc_model.figures.types import Mask, Words

MANY = 300  # points, which are small marks
ABOVE = 2.0  # drawing order of the first sweep, as matplotlib has it for all lines,
LOWER = 0.01  # and by so much lower for each further one
LARGER = 1.5  # points, by which samples at events are larger for each sweep above them
EDGE = 0.6  # points, of their edges: wider ones leave no room inside open marks


class Points(NamedTuple):
    """Points of one look: their name, "" without one, and which values they are."""

    name: str
    mask: Mask
    look: dict[str, Any]


def points_of(
    study: xr.Dataset, array: xr.DataArray, look: Look, marker: str, sweep: int = 0
) -> list[Points]:
    """All points of a variable: those of each event, and then those of motions that had not settled, and of
    averages that have not converged.

    sweep : number of sweeps that were drawn there before
    """
    known = np.isfinite(array.values.astype(float))
    doubtful = _not_settled(study, array)
    unsure = _not_converged(study, array)
    events = names_of_events(study)
    rings = rings_of(array.values.astype(float), doubtful & known, _phases_of(study, array), events)
    return [
        *_parts_of(study, array, ~doubtful & ~unsure, look, marker, sweep),
        *(Points(name, mask, _ring_of(look, ring, sweep)) for name, mask, ring in rings),
        Points(NOT_CONVERGED.label, unsure & known, _ring_of(look, UNDECIDED, sweep)),
    ]


def _ring_of(look: Look, ring: dict[str, Any], sweep: int) -> dict[str, Any]:
    """The look of rings about values in doubt: grey, or beside black dots the colour of their sweep. They are
    larger than those of sweeps before, so that grey print tells them apart."""
    size = min(ring["markersize"] + LARGER * sweep, WIDEST)
    ring = {**ring, "markersize": mark(size)}
    return ring if look.colour == BLACK else {**ring, "color": look.colour}


def _parts_of(
    study: xr.Dataset, array: xr.DataArray, shown: Mask, look: Look, marker: str, sweep: int
) -> list[Points]:
    """The points that are shown of each event at which values were sampled, with its name and look; all
    of them together if they were not sampled at events."""
    size = DOT if array.size > MANY else MARK
    dots: dict[str, Any] = {"color": look.colour, "marker": marker, "markersize": mark(size)}
    if marker != ".":
        dots |= {"markerfacecolor": "none", "markersize": mark(MARK)}
        dots |= {"markeredgewidth": wide(EDGE), "zorder": ABOVE - LOWER * sweep}
    parts = []
    for phase, name in names_of_events(study).items():
        mask = (_phases_of(study, array) == phase) & shown
        if mask.any():
            parts.append(Points(name, mask, {**dots, **_look_at(phase, look, marker, sweep)}))
    return parts or [Points(_number_of_modes(array), shown, dots)]


def _number_of_modes(array: xr.DataArray) -> str:
    """How many modes the points are of, as a name; "" if they are of anything else."""
    if "mode" not in array.dims:
        return ""
    along = [dim for dim in array.dims if dim != "mode"]
    return counted(int(array.notnull().any(along).sum()), "mode")


def _look_at(phase: str, look: Look, marker: str, sweep: int) -> dict[str, Any]:
    """What tells samples in a phase from others of a sweep, whose colour they have: the marks of a bifurcation
    diagram, or beside other sweeps full marks of separations, as of the kind of motion that separates,
    and open ones of releases. They are larger than those of sweeps before, which lie above them."""
    if marker == ".":
        own = MARKS[phase]
        return {**own, "markersize": mark(own["markersize"])}
    size = min(MARK + LARGER * sweep, WIDEST)
    larger: dict[str, Any] = {"markersize": mark(size)}
    return {**larger, "markerfacecolor": look.colour} if phase == "separation" else larger


def _phases_of(study: xr.Dataset, array: xr.DataArray) -> Words:
    """The phase of the motion at each value, "" where a study does not know it."""
    phases = study.get("phase")
    if phases is None or {*phases.dims} != {*array.dims}:
        return np.full(array.shape, "")
    return np.asarray(flag_names(phases.transpose(*array.dims)))


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
