"""Integration with derivatives: a motion and its small changes, from phase to phase and back to a section."""

from typing import NamedTuple

import numpy as np

from . import transitions
from .event_loop import follow
from .exit_codes import CONSISTENT, NO_SOLUTION, OFF_SECTION, STOPPED
from .jit import helper, inlined, kernel
from .jit.packing import packed
from .jit.simd import WIDTH, mul, splat, store
from .laws import PSI_ENTRY, TINY, stepped
from .layout import PHASE, PSI, SEPARATION, STICK
from .saltation import count_event, event_change, event_gradient, event_times, rates, slider_rows
from .tangent import slider_row


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


@inlined
def _entry_at(model, state, row):
    """Array and index of the entry of a state that stands at ``row`` of a column."""
    slider = row - slider_row(model, PSI)
    return (state.disc, row) if slider < 0 else (state.x, PSI + slider)


@kernel
def release_angle(model, state):
    """psi at a forward release; the event function is linear in it."""
    i, _ = transitions.instant(model, state)
    margin = transitions.event_function(model, stepped(i, PSI_ENTRY), transitions.RELEASE_FORWARD, False)
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
        by_psi = splat(-1.0 / t.gradient[PSI_ENTRY])
        for c in range(0, t.columns, WIDTH):
            dpsi = mul(by_psi, event_change(model, state, t, t.now, c, c >= t.plain))
            store(t.now, c * t.rows + slider_row(model, PSI) * WIDTH, dpsi)
    if not transitions.friction_drops(model):
        # then slip begins only where the friction limit falls below the pull, and does not just touch it
        rates(model, state, t.before)
        if not event_times(model, state, t, transitions.RELEASE_FORWARD, False) < 0.0:
            return OFF_SECTION
    if transitions.change_phase(model, state, transitions.RELEASE_FORWARD, False) == NO_SOLUTION:
        return NO_SOLUTION
    # the release itself belongs to the integration that ended here
    count_event(state, transitions.NOTHING, t.log)
    if state.x[PHASE] == SEPARATION and not course.may_separate:
        return STOPPED
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
    outcome = follow(model, s, state, state, course, None, (t,))
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
