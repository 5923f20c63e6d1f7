"""Flights with their derivatives: a motion and small changes of it, from phase to phase and back to a section."""

from __future__ import annotations

import numpy as np

from .compile import kernel
from .dense_output import state_at
from .lanes import WIDTH, mul, splat, store
from .layout import DIRECTION, KNOWN, PHASE, PSI, SEPARATION, SLIP, SPEED, STICK, TIME
from .outcomes import LOST_CONTACT, NO_SOLUTION, NON_FINITE, OFF_SECTION, RETURNED, STALLED, TIME_OVER
from .saltation import impact_change, rates, rest, shift, slider_rows, switch_change, switch_times
from .stepping import advance_time, expand, first_switch, step_size
from .switches import (
    AT_REST,
    GAP_CLOSED,
    MAX_EVENTS_IN_A_ROW,
    NOTHING,
    PAINLEVE_MARGIN,
    RELEASE_BACKWARD,
    RELEASE_FORWARD,
    change_phase,
    disc_point,
    stick_force,
)
from .tangent import n_inputs, n_rows_of, tangent_at, tangent_series

# What a flight counts, entries of ``Tangent.log``.
DURATION, STICK_TIME, SLIP_TIME, SEPARATION_TIME, RELEASES, BACK_RELEASES, REVERSALS, SEPARATIONS, STICKS, N_STEPS = (
    range(10)
)


@kernel
def _step(model, s, state, order, tolerance, left):
    """Expand and find the first switch within ``left`` time units: (length, cause); nan or -1 is failure."""
    if expand(model, s, state, order) <= PAINLEVE_MARGIN:
        return -1.0, NOTHING
    x_end = step_size(model, s, order, tolerance, state.x[PHASE])
    if not x_end > 0.0:
        return np.nan, NOTHING
    return first_switch(model, s, state, order, min(x_end, left))


@kernel
def _count(state, cause, log):
    """Count a switch that was carried out."""
    phase = state.x[PHASE]
    if cause == RELEASE_FORWARD:
        log[RELEASES] += 1.0
    elif cause == RELEASE_BACKWARD:
        log[BACK_RELEASES] += 1.0
    elif cause == AT_REST and phase == SLIP:
        log[REVERSALS] += 1.0
    if phase == SEPARATION:
        log[SEPARATIONS] += 1.0
    elif phase == STICK:
        log[STICKS] += 1.0


@kernel
def divergence(model, state):
    """Trace of the Jacobian of the rates in the state's phase, 1/s (rows z, e, y, g, psi, f; f fixed in stick)."""
    phase, trace = state.x[PHASE], 0.0
    for j in range(len(model.force)):
        trace -= model.damping[j]
    for j in range(len(model.force0)):
        trace -= model.damping0[j]
    if phase == SEPARATION:
        return trace - model.c_p / model.m
    direction = state.x[DIRECTION] if phase == SLIP else 0.0
    _, _, B = disc_point(model, state)
    D = 1.0 + model.m * model.compliance + direction * model.mu_k * B / model.r_0
    # -sum psi dP/dalpha
    trace -= (model.c * model.compliance - model.m * model.damped_compliance) / D
    if phase == SLIP:
        f, by_f = state.x[SPEED], 0.0
        for j in range(len(model.force)):
            by_f += 2.0 * model.slope[j] * state.e[j] + 2.0 * f * model.bend[j] * state.z[j]
        by_f = (model.m * by_f + (model.c - model.c_p) * B) / D
        trace -= (model.c_p + direction * model.mu_k / model.r_0 * by_f) / model.m
    return trace


@kernel
def fly(model, s, state, t, order, tolerance, longest, t_max, releases, may_separate, tangent):
    """Carry ``state`` and, if ``tangent``, the columns ``t.now`` to the end of a flight; returns how it ended.

    releases > 0: until stick is released forwards for that time; the columns are then projected onto the section
    (their switch time is t.tau, the state still in stick).  Otherwise, or when t_max (s, of the flight) comes first,
    until t_max.  ``longest`` bounds a step (time units): columns are rougher than the motion that sizes the steps; see
    ``longest_step``.  ``may_separate`` False ends the flight at a loss of contact.  ``t.log`` is added to.
    """
    x, log = state.x, t.log
    in_a_row = 0
    start = x[TIME]
    found = 0
    while True:
        phase, direction = x[PHASE], x[DIRECTION]
        left = (t_max - (x[TIME] - start)) / model.unit
        x_end, cause = _step(model, s, state, order, tolerance, min(left, longest))
        if not x_end >= 0.0:
            return NO_SOLUTION if x_end < 0.0 else NON_FINITE
        if tangent:
            tangent_series(model, s, t, order, phase, direction)
            tangent_at(model, t, order, x_end)
        state_at(model, s, order, x_end, phase, state)
        before = x[TIME]
        advance_time(x, x_end * model.unit)
        log[DURATION] += x_end * model.unit
        log[STICK_TIME + int(phase)] += x_end * model.unit
        log[N_STEPS] += 1.0
        if cause == NOTHING:
            x[KNOWN] = 0.0
            if x_end >= left:
                return TIME_OVER
            continue
        in_a_row = in_a_row + 1 if x[TIME] == before else 0
        if in_a_row > MAX_EVENTS_IN_A_ROW:
            return STALLED
        last = False
        if cause == RELEASE_FORWARD:
            found += 1
            last = found == releases
        if cause == AT_REST:
            x[SPEED] = 0.0
        if tangent:
            rates(model, state, t.before)
            switch_times(model, state, t, cause)
            shift(model, t, t.before, 1.0)
            if cause == GAP_CLOSED:
                impact_change(model, state, t)
        if last:
            log[RELEASES] += 1.0
            return RETURNED
        x[KNOWN] = 0.0
        if change_phase(model, state, cause, x_end == 0.0) == NO_SOLUTION:
            return NO_SOLUTION
        _count(state, cause, log)
        if tangent:
            if x[PHASE] == SEPARATION:
                slider_rows(model, state, t)
            rates(model, state, t.after)
            shift(model, t, t.after, -1.0)
            if x[PHASE] != SEPARATION:
                slider_rows(model, state, t)
            if x[PHASE] == STICK:
                rest(model, t)
        if x[PHASE] == SEPARATION and not may_separate:
            return LOST_CONTACT
        if x_end >= left:
            return TIME_OVER


@kernel
def section_map(
    model,
    s,
    state,
    t,
    order,
    tolerance,
    longest,
    t_max,
    releases,
    may_separate,
    tangent,
    rows,
    scale,
    start,
    end,
    jacobian,
):
    """The return map of the section "stick is about to be released forwards", and its Jacobian.

    A point of the section is given by its modal coordinates, scaled: start, end, shape (n,), in the order of ``rows``
    (rows of a column) times ``scale``; f is 0 and psi follows from the release condition.  ``t.parameters`` may hold
    changes of parameters in the columns from n on.  jacobian: shape (n, columns), filled if ``tangent``.
    Returns how the flight ended; ``t.log`` is set.
    """
    width, n0, C = len(model.force), len(model.force0), t.columns
    row, n = 2 * width + 2 * n0, len(rows)
    t.log[:] = 0.0
    state.x[:] = 0.0
    for i in range(n):
        r, value = rows[i], start[i] / scale[i]
        if r < width:
            state.z[r] = value
        elif r < 2 * width:
            state.e[r - width] = value
        elif r < 2 * width + n0:
            state.y[r - 2 * width] = value
        else:
            state.g[r - 2 * width - n0] = value
    state.x[PHASE] = STICK
    P = stick_force(model, state)
    if not P > 0.0:
        return OFF_SECTION
    state.x[PSI] = (model.mu_s * P / model.r_0 - model.c_p * model.Omega) / model.k_p
    if tangent:
        t.now[:] = 0.0
        for i in range(n):
            t.now[((i // WIDTH) * n_rows_of(model) + rows[i]) * WIDTH + i % WIDTH] = 1.0 / scale[i]
        for c in range(0, C, WIDTH):
            at, q = c * n_rows_of(model), c * n_inputs(model)
            change = switch_change(model, state, RELEASE_FORWARD, t.now, at, t.parameters, q, c >= t.plain)
            store(t.now, at + row * WIDTH, mul(splat(1.0 / (model.r_0 * model.k_p)), change))
    if change_phase(model, state, RELEASE_FORWARD, False) == NO_SOLUTION:
        return NO_SOLUTION
    # the release itself is that of the flight which ended here
    _count(state, NOTHING, t.log)
    if state.x[PHASE] == SEPARATION and not may_separate:
        return LOST_CONTACT
    if tangent:
        slider_rows(model, state, t)
    outcome = fly(model, s, state, t, order, tolerance, longest, t_max, releases, may_separate, tangent)
    for i in range(n):
        r = rows[i]
        if r < width:
            end[i] = state.z[r] * scale[i]
        elif r < 2 * width:
            end[i] = state.e[r - width] * scale[i]
        elif r < 2 * width + n0:
            end[i] = state.y[r - 2 * width] * scale[i]
        else:
            end[i] = state.g[r - 2 * width - n0] * scale[i]
        if tangent:
            for c in range(C):
                jacobian[i, c] = t.now[((c // WIDTH) * n_rows_of(model) + r) * WIDTH + c % WIDTH] * scale[i]
    return outcome
