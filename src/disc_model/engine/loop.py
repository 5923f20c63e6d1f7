"""The two loops of the engine, which expand the series, find the first event, move there and change
the phase, until the end.

`run` records the motion, and returns when a buffer is full; pauses have no influence on results.
`fly` takes small changes along with the motion instead, to a time or back to a section, and records
nothing but counts.
"""

import math
from typing import NamedTuple

from .dense_output import CLOSED_FORM
from .jit import inlined, kernel
from .model import set_course
from .record import STEPS, pass_recorded_event, reason_to_pause, record_step
from .saltation import pass_event
from .state import PHASE, SEPARATION, TIME, TIME_LOW
from .step import (
    Step,
    advance_clock,
    closed_form_length_within,
    series_step,
    settle,
    stalls,
    sufficient_order,
)
from .tangent import take_step
from .transitions import CONSISTENT, NOTHING, RELEASE_FORWARD, STALLED, STOPPED, TIME_OVER


class Limits(NamedTuple):
    """How a run is followed, and when it ends."""

    order: int  # of the series
    tolerance: float  # of the series
    t_end: float  # s
    may_separate: bool  # if not, a loss of contact ends the run
    max_steps: int
    pause_after: int  # steps
    audit_every: int  # steps


class FlightLimits(NamedTuple):
    """How a motion is followed with small changes, and when it ends."""

    order: int  # of the series
    tolerance: float  # of the series
    longest: float  # step, time units: see `tangent.longest_step`
    t_max: float  # s, of the flight
    releases: int  # it ends where stick is released forwards for that time; 0: at ``t_max``
    may_separate: bool  # if not, a loss of contact ends it
    tangent: bool  # whether the columns travel along


# ---- A recorded run


@kernel
def run(model, series, state, probe, limits, buffers):
    """Advance ``state`` and record the motion, until there is a reason to return.

    model : constants of the case
    series : work space
    state : at the start; at the end, that of the end
    probe : a work state
    limits : `Limits`
    buffers : `record.RunBuffers`

    Returns an exit code of `transitions`.
    """
    pause_at = buffers.counters[STEPS] + limits.pause_after
    set_course(model, state)
    while True:
        code = reason_to_pause(limits, pause_at, buffers)
        if code != CONSISTENT:
            return code
        left = ((limits.t_end - state.x[TIME]) - state.x[TIME_LOW]) / model.unit
        step = _recorded_step(model, series, state, limits, left)
        if step.code != CONSISTENT:
            return step.code
        record_step(model, series, state, probe, step, limits, buffers)
        clock_moved = advance_clock(model, state, step)
        if step.cause != NOTHING:
            if stalls(state, clock_moved):
                return STALLED
            code = pass_recorded_event(model, state, step, buffers)
            if code != CONSISTENT:
                return code
            if state.x[PHASE] == SEPARATION and not limits.may_separate:
                return STOPPED
        if step.length >= left:
            settle(state)
            return TIME_OVER


@inlined
def _recorded_step(model, series, state, limits, left):
    """Return the next `Step` of a run, in closed form if possible; left: time units to the end."""
    length = closed_form_length_within(model, series, state, left)
    if length > 0.0:
        return Step(CONSISTENT, CLOSED_FORM, length, NOTHING)
    order = sufficient_order(model, state, limits.order)
    return series_step(model, series, state, order, limits.tolerance, math.inf, left)


# ---- A flight: a motion with small changes


@inlined
def fly(model, series, state, tangent, limits):
    """Advance ``state`` and, if requested, small changes along with it, to the end of a flight.

    model : constants of the case
    series : work space
    state : at the start; at the end, that of the end, at the last release still in stick
    tangent : `columns.Tangent`; counts are added to its log
    limits : `FlightLimits`

    Returns an exit code of `transitions`.
    """
    start = state.x[TIME]
    releases = 0
    set_course(model, state)
    while True:
        left = (limits.t_max - (state.x[TIME] - start)) / model.unit
        step = series_step(
            model, series, state, limits.order, limits.tolerance, limits.longest, left
        )
        if step.code != CONSISTENT:
            return step.code
        take_step(model, series, tangent, step, state, limits.tangent)
        clock_moved = advance_clock(model, state, step)
        if step.cause != NOTHING:
            if stalls(state, clock_moved):
                return STALLED
            if step.cause == RELEASE_FORWARD:
                releases += 1
            returns = step.cause == RELEASE_FORWARD and releases == limits.releases
            code = pass_event(model, state, tangent, step, returns, limits.tangent)
            if code != CONSISTENT:
                return code
            if state.x[PHASE] == SEPARATION and not limits.may_separate:
                return STOPPED
        if step.length >= left:
            return TIME_OVER
