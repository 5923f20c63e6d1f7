"""Integration with derivatives: a motion and its small changes, from phase to phase and back to a section."""

from typing import NamedTuple

import numpy as np

from . import transitions
from .dense_output import state_at
from .exit_codes import CONSISTENT, LOST_CONTACT, NO_SOLUTION, NON_FINITE, OFF_SECTION, RETURNED, STALLED, TIME_OVER
from .jit import helper, inlined, kernel
from .jit.packing import packed
from .jit.simd import WIDTH, mul, splat, store
from .laws import PSI as ANGLE
from .laws import TINY, stepped
from .layout import DIRECTION, KNOWN, PHASE, PSI, SEPARATION, SLIP, SPEED, STICK, TIME
from .saltation import event_change, event_gradient, event_times, impact_change, rates, shift, slider_rows
from .stepping import advance_time, expand, first_event, step_size
from .tangent import PSI_ROW, slider_row, tangent_at, tangent_series

# Counts of an integration, entries of ``Tangent.log``.
DURATION, STICK_TIME, SLIP_TIME, SEPARATION_TIME, RELEASES, BACK_RELEASES, REVERSALS, SEPARATIONS, STICKS, N_STEPS = (
    range(10)
)


class IntegrationLimits(NamedTuple):
    """End and accuracy of an integration."""

    order: int  # of the series
    tolerance: float  # of the series
    longest: float  # step, time units: columns are rougher than the motion that sizes the steps; see ``longest_step``
    t_max: float  # s, of the flight
    releases: int  # it ends where stick is released forwards for that time; 0: at ``t_max``
    may_separate: bool  # if not, a loss of contact ends it
    tangent: bool  # whether the columns travel along


@packed
class Section(NamedTuple):
    """Points of the section "stick is about to be released forwards", n coordinates each, and the map's Jacobian."""

    rows: np.ndarray  # (n,), where each coordinate stands in a column
    scale: np.ndarray  # (n,), coordinate over the state's entry
    end: np.ndarray  # (n,)
    jacobian: np.ndarray  # (n, columns)


@helper
def _step(model, s, state, order, tolerance, left):
    """Expand and find the first event within ``left`` time units: (length, cause); nan or -1 is failure."""
    if expand(model, s, state, order) <= transitions.PAINLEVE_MARGIN:
        return -1.0, transitions.NOTHING
    x_end = step_size(model, s, order, tolerance, state.x[PHASE])
    if not x_end > 0.0:
        return np.nan, transitions.NOTHING
    return first_event(model, s, state, order, min(x_end, left))


@helper
def _count(state, cause, log):
    """Count an event that was carried out."""
    phase = state.x[PHASE]
    if cause == transitions.RELEASE_FORWARD:
        log[RELEASES] += 1.0
    elif cause == transitions.RELEASE_BACKWARD:
        log[BACK_RELEASES] += 1.0
    elif cause == transitions.AT_REST and phase == SLIP:
        log[REVERSALS] += 1.0
    if phase == SEPARATION:
        log[SEPARATIONS] += 1.0
    elif phase == STICK:
        log[STICKS] += 1.0


@helper
def _integrate(model, s, state, t, course):
    """See ``integrate``."""
    order, tangent = course.order, course.tangent
    x, log = state.x, t.log
    in_a_row, found, start = 0, 0, x[TIME]
    while True:
        phase, direction = x[PHASE], x[DIRECTION]
        left = (course.t_max - (x[TIME] - start)) / model.unit
        x_end, cause = _step(model, s, state, order, course.tolerance, min(left, course.longest))
        if not x_end >= 0.0:
            return NO_SOLUTION if x_end < 0.0 else NON_FINITE
        if tangent:
            tangent_series(model, s, t, order, phase, direction)
            tangent_at(t, order, x_end)
        state_at(model, s, order, x_end, phase, state)
        before = x[TIME]
        advance_time(x, x_end * model.unit)
        log[DURATION] += x_end * model.unit
        log[STICK_TIME + int(phase)] += x_end * model.unit
        log[N_STEPS] += 1.0
        if cause == transitions.NOTHING:
            x[KNOWN] = 0.0
            if x_end >= left:
                return TIME_OVER
            continue
        in_a_row = in_a_row + 1 if x[TIME] == before else 0
        if in_a_row > transitions.MAX_EVENTS_IN_A_ROW:
            return STALLED
        if cause == transitions.RELEASE_FORWARD:
            found += 1
        last = cause == transitions.RELEASE_FORWARD and found == course.releases
        if cause == transitions.AT_REST:
            x[SPEED] = 0.0
        if tangent:
            rates(model, state, t.before)
            event_times(model, state, t, cause, x_end == 0.0)
            shift(t, t.before, 1.0)
            if cause == transitions.GAP_CLOSED and not model.compliant:
                impact_change(model, state, t)
        if last:
            log[RELEASES] += 1.0
            return RETURNED
        x[KNOWN] = 0.0
        if transitions.change_phase(model, state, cause, x_end == 0.0) == NO_SOLUTION:
            return NO_SOLUTION
        _count(state, cause, log)
        if tangent:
            if x[PHASE] == SEPARATION:
                slider_rows(model, state, t)
            rates(model, state, t.after)
            shift(t, t.after, -1.0)
            if x[PHASE] != SEPARATION:
                slider_rows(model, state, t)
        if x[PHASE] == SEPARATION and not course.may_separate:
            return LOST_CONTACT
        if x_end >= left:
            return TIME_OVER


@inlined
def _entry_at(model, state, row):
    """Array and index of the entry of a state that stands at ``row`` of a column."""
    slider = row - slider_row(model, PSI_ROW)
    return (state.disc, row) if slider < 0 else (state.x, PSI + slider)


@kernel
def release_angle(model, state):
    """psi at a forward release; the event function is linear in it."""
    i, _ = transitions.instant(model, state)
    margin = transitions.event_function(model, stepped(i, ANGLE), transitions.RELEASE_FORWARD, False)
    return i.psi - margin.real / (margin.imag / TINY)


@helper
def _leave_section(model, s, state, t, course, section, start):
    """Put state and, if requested, columns just after the release at ``start``.  Returns CONSISTENT or an exit code."""
    rows, scale = section.rows, section.scale
    t.log[:] = 0.0
    state.x[:] = 0.0
    for i in range(len(rows)):
        entries, at = _entry_at(model, state, rows[i])
        entries[at] = start[i] / scale[i]
    state.x[PHASE] = STICK
    if not transitions.stick_force(model, state) > 0.0:
        return OFF_SECTION
    state.x[PSI] = release_angle(model, state)
    if course.tangent:
        t.now[:] = 0.0
        for i in range(len(rows)):
            t.now[((i // WIDTH) * t.rows + rows[i]) * WIDTH + i % WIDTH] = 1.0 / scale[i]
        event_gradient(model, state, t, transitions.RELEASE_FORWARD)
        by_psi = splat(-1.0 / t.gradient[ANGLE])
        for c in range(0, t.columns, WIDTH):
            dpsi = mul(by_psi, event_change(model, state, t, t.now, c, c >= t.plain))
            store(t.now, c * t.rows + slider_row(model, PSI_ROW) * WIDTH, dpsi)
    if transitions.change_phase(model, state, transitions.RELEASE_FORWARD, False) == NO_SOLUTION:
        return NO_SOLUTION
    # the release itself belongs to the integration that ended here
    _count(state, transitions.NOTHING, t.log)
    if state.x[PHASE] == SEPARATION and not course.may_separate:
        return LOST_CONTACT
    if course.tangent:
        slider_rows(model, state, t)
    return CONSISTENT


@kernel
def _flight(model, s, state, t, course, section, start, from_section):
    """Common part of ``integrate`` and ``section_map``: separately, each would compile nearly the whole engine."""
    if from_section:
        outcome = _leave_section(model, s, state, t, course, section, start)
        if outcome != CONSISTENT:
            return outcome
    outcome = _integrate(model, s, state, t, course)
    for i in range(len(section.rows)):
        entries, place = _entry_at(model, state, section.rows[i])
        section.end[i] = entries[place] * section.scale[i]
        if course.tangent:
            for c in range(t.columns):
                at = ((c // WIDTH) * t.rows + section.rows[i]) * WIDTH + c % WIDTH
                section.jacobian[i, c] = t.now[at] * section.scale[i]
    return outcome


_NOWHERE = Section(np.zeros(0, np.int64), np.zeros(0), np.zeros(0), np.zeros((0, 0)))


def integrate(model, s, state, t, course):
    """Advance ``state`` and, if requested, the columns ``t.now`` to the end of an integration; returns its exit code.

    At the last release the columns are projected onto the section (their event time is t.tau, the state still in
    stick). An integration that ends at ``t_max`` is not projected.  ``t.log`` is incremented.
    """
    return _flight(model, s, state, t, course, _NOWHERE, _NOWHERE.end, False)


def section_map(model, s, state, t, course, section, start):
    """The return map of a section, from the point ``start``, and its Jacobian if the course asks for it.

    A point of the section is given by its modal coordinates; f is 0 and psi follows from the release condition.
    ``t.parameters`` may hold changes of parameters in the columns from n on.  Returns the exit code; ``t.log`` is set.
    """
    return _flight(model, s, state, t, course, section, start, True)
