"""The return map: flights between points of the section "stick is about to be released forwards".

A point is given by coordinates of the disc, and of u, u' on a compliant contact: f is 0, and psi
follows from the release condition.
"""

from typing import NamedTuple

import numpy as np

from .columns import Tangent, column_entry, has_inputs, now_at, put_entry
from .jit import helper, inlined, kernel
from .jit.packing import packed
from .jit.simd import WIDTH
from .laws import PSI_ENTRY, TINY, stepped
from .loop import FlightLimits, fly
from .model import Model
from .saltation import count_event, event_gradient, event_times, put_changes, rates, slider_rows
from .series import Series
from .state import PHASE, PSI, SEPARATION, STICK, EngineState, slider_place
from .transitions import (
    CONSISTENT,
    NO_SOLUTION,
    NOTHING,
    OFF_SECTION,
    RELEASE_FORWARD,
    STOPPED,
    change_phase,
    event_function,
    friction_drops,
    instant,
    stick_force,
)


@packed()
class Section(NamedTuple):
    """Points of the section, n coordinates each, and the map's Jacobian."""

    rows: np.ndarray  # (n,), where each coordinate stands in a column
    scale: np.ndarray  # (n,), coordinate over the state's entry
    end: np.ndarray  # (n,)
    jacobian: np.ndarray  # (n, columns)


_NOWHERE = Section(np.zeros(0, np.int64), np.zeros(0), np.zeros(0), np.zeros((0, 0)))


def integrate(
    model: Model,
    series: Series,
    state: EngineState,
    tangent: Tangent,
    limits: FlightLimits,
    section: Section = _NOWHERE,
    start: np.ndarray = _NOWHERE.end,
) -> int:
    """Advance ``state`` and, if requested, the columns to the end of a flight; return its exit
    code.

    At the last release, not at ``t_max``, the columns are projected onto the section: their event
    time is ``Tangent.tau``, the state still in stick. ``Tangent.log`` is incremented, or set from a
    point ``start`` of a section on, where this is its return map, with its Jacobian if ``limits``
    ask for it. ``Tangent.inputs`` may change parameters in the columns from n on.
    """
    return _flight(model, series, state, tangent, limits, section, start)


@kernel
def _flight(model, series, state, tangent, limits, section, start):
    """See `integrate`."""
    if len(start) > 0:
        outcome = _leave(model, state, tangent, limits, section, start)
        if outcome != CONSISTENT:
            return outcome
    outcome = fly(model, series, state, tangent, limits)
    for i in range(len(section.rows)):
        row = section.rows[i]
        scale = section.scale[i]
        entries, at = _state_entry(model, state, row)
        section.end[i] = entries[at] * scale
        if limits.tangent:
            for column in range(tangent.columns):
                change = tangent.now[column_entry(tangent, column, row)]
                section.jacobian[i, column] = change * scale
    return outcome


@inlined
def release_angle(model, state):
    """Return psi at a forward release, rad; the event function is linear in it."""
    i, _ = instant(model, state)
    margin = event_function(model, stepped(i, PSI_ENTRY), RELEASE_FORWARD, False)
    return i.psi - margin.real / (margin.imag / TINY)


@inlined
def _state_entry(model, state, row):
    """Array and place of the entry of a state that stands at ``row`` of a column."""
    scalar = row - slider_place(model, PSI)
    if scalar < 0:
        return state.disc, row
    return state.x, PSI + scalar


@helper
def _leave(model, state, tangent, limits, section, start):
    """Put state and, if requested, columns just after the release at the point ``start``.  Returns
    an exit code."""
    tangent.log[:] = 0.0
    put_point(model, state, section, start)
    if not stick_force(model, state) > 0.0:
        return OFF_SECTION
    if limits.tangent:
        _put_unit_columns(model, state, tangent, section)
    if not friction_drops(model):
        # then slip begins only where the friction limit falls below the pull, and does not just
        # touch it
        rates(model, state, tangent.before)
        if not event_times(model, state, tangent, RELEASE_FORWARD, False) < 0.0:
            return OFF_SECTION
    if change_phase(model, state, RELEASE_FORWARD, False) == NO_SOLUTION:
        return NO_SOLUTION
    # the release itself belongs to the flight that ended here
    count_event(state, NOTHING, tangent.log)
    if state.x[PHASE] == SEPARATION and not limits.may_separate:
        return STOPPED
    if limits.tangent:
        slider_rows(model, state, tangent)
    return CONSISTENT


@kernel
def put_point(model, state, section, point):
    """Put a state at a point of the section, in stick at time 0."""
    state.x[:] = 0.0
    for i in range(len(section.rows)):
        entries, at = _state_entry(model, state, section.rows[i])
        entries[at] = point[i] / section.scale[i]
    state.x[PHASE] = STICK
    state.x[PSI] = release_angle(model, state)


@inlined
def _put_unit_columns(model, state, tangent, section):
    """Set the columns to unit changes of the coordinates, and psi in them by the release."""
    tangent.now[:] = 0.0
    for i in range(len(section.rows)):
        tangent.now[column_entry(tangent, i, section.rows[i])] = 1.0 / section.scale[i]
    event_gradient(model, state, tangent, RELEASE_FORWARD)
    by_psi = -1.0 / tangent.gradient[PSI_ENTRY]
    for block in range(tangent.columns // WIDTH):
        changes = has_inputs(tangent, block)
        margin = put_changes(model, state, tangent, tangent.now, block, changes)
        at = now_at(tangent, block)
        put_entry(tangent.now, at, slider_place(model, PSI), by_psi * margin)
