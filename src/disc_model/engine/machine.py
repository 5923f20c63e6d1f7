"""The phase machine: expand, find the first switch, move there, change phase, record; until the end.

The loop runs wholly inside one compiled function and hands back control when a buffer is full, so that memory
does not grow with the simulated time and callers can show progress.  Where it pauses has no influence on results.
"""

from __future__ import annotations

import math

from .audit import audit_impact, audit_step, transverse_energy
from .coasting import LONGEST_COAST, coast_length
from .compile import inlined, kernel
from .dense_output import COAST, load_state, move_to
from .lanes import WIDTH, absolute, largest, load, maximum, splat
from .layout import (
    COASTED,
    DIRECTION,
    FORCE,
    KNOWN,
    PHASE,
    PSI,
    SEPARATION,
    SLIP,
    SPEED,
    STICK,
    TIME,
    TIME_LOW,
    U_VELOCITY,
    E,
    U,
)
from .polynomial import NO_ROOT, first_root, set_powers
from .sampling import sample_step
from .series import lane_count, separation_series, slip_series, stick_series
from .switches import (
    LOSS_OF_CONTACT,
    PAINLEVE_MARGIN,
    PARADOX,
    REATTACHMENT,
    SLIP_REVERSAL,
    SLIP_TO_STICK,
    STICK_TO_SLIP,
    break_loose,
    come_to_rest,
    disc_point,
    lose_contact,
    never_pulled,
    touch_down,
)

# Why the machine handed back control.
PAUSED, FINISHED, STOPPED, STEP_LIMIT, NO_SOLUTION, STALLED, NON_FINITE = range(7)

# Counters, shape (N_COUNTERS,).
STEPS, EVENTS, SEPARATIONS, IN_A_ROW, EVENT_ROWS, SAMPLE_ROWS, FROM_AUDIT, N_COUNTERS = range(8)
# Columns of a row of events.
EVENT_ROW = ("time", "kind", "phase", "direction", "psi", "f", "u", "u_velocity", "P")

# What can end a step.
NOTHING, RELEASE_FORWARD, RELEASE_BACKWARD, AT_REST, CONTACT_LOST, GAP_CLOSED = range(6)

MAX_EVENTS_PER_STEP = 3
# More switches than this without the clock moving end the run: a guard, not a tuned interval.
MAX_EVENTS_IN_A_ROW = 200
# Longest step, in units of 1 / largest omega: beyond it the terms of the series cancel more digits than they add.
LONGEST_STEP = 8.0
TYPICAL_STEP = 3.0


@inlined
def _size(model, s, k):
    """Largest modulus among the modal velocities of order k."""
    width, n, biggest = lane_count(model), len(model.force0), splat(0.0)
    for j in range(k * width, (k + 1) * width, WIDTH):
        biggest = maximum(biggest, absolute(load(s.modes, E * width + j)))
    size = largest(biggest)
    for j in range(k * n, (k + 1) * n):
        size = max(size, abs(s.g[j]))
    return size


@inlined
def _last_two(c, order):
    """Size of the last two terms, as if the step were ``TYPICAL_STEP``."""
    return max(abs(c[order]), abs(c[order - 1]) / TYPICAL_STEP)


@inlined
def _scale(usual, now, growth):
    """What a quantity's error is compared with: its usual size or its present one; its growth if both are zero."""
    size = max(usual, now)
    return size if size > 0.0 else growth


@inlined
def _relative(error, scale):
    return error / scale if scale > 0.0 else error


@inlined
def step_size(model, s, order, tolerance, phase):
    """Step (time units) at which the last two terms of the series fall below the tolerance (Jorba and Zou).

    Modal velocities are compared with those of static deflection under the preload, or with what is there if that is
    more; f with the drive speed; in separation also u'.  The two terms are merged as if the step were
    ``TYPICAL_STEP``, which spares a root.
    """
    last = max(_size(model, s, order), _size(model, s, order - 1) / TYPICAL_STEP)
    scale = _scale(model.velocity_scale, _size(model, s, 0), _size(model, s, 1))
    speed = _scale(model.speed_scale, abs(s.f[0]), abs(s.f[1]))
    error = _relative(last, scale) + _relative(_last_two(s.f, order), speed)
    if phase == SEPARATION:
        error += _relative(_last_two(s.v, order), _scale(model.slider_scale, abs(s.v[0]), abs(s.v[1])))
    else:
        # P is known to one order less
        last_force = max(abs(s.P[order - 1]) / TYPICAL_STEP, abs(s.P[order - 2]) / TYPICAL_STEP**2)
        error += _relative(last_force, _scale(model.N, abs(s.P[0]), abs(s.P[1])))
    if not error < math.inf or not scale + speed < math.inf:
        return math.nan
    if error * LONGEST_STEP**order <= tolerance:
        return LONGEST_STEP
    return math.exp(math.log(tolerance / error) / order)


@inlined
def expand(model, s, state, order):
    """Series of the current phase.  Returns the denominator of P in slip over that without friction, else 1."""
    load_state(s, state)
    phase = state.x[PHASE]
    if phase == SLIP:
        return slip_series(model, s, order, state.x[DIRECTION]) / (1.0 + model.m * model.compliance)
    if phase == STICK:
        stick_series(model, s, order)
    else:
        separation_series(model, s, order)
    return 1.0


@inlined
def first_switch(model, s, state, order, x_end):
    """Where and why the phase ends within (0, x_end]: (x, cause), or (x_end, NOTHING)."""
    phase, known = state.x[PHASE], int(state.x[KNOWN])
    set_powers(s.powers, x_end)
    cause = NOTHING
    if phase == STICK:
        if not model.bonded and never_pulled(model, state):
            # P = 0 and the friction limit coincide, and it is contact that ends
            x = first_root(s.P, 0, order - 1, x_end, s.powers, s.roots)
            return (x, CONTACT_LOST) if x != NO_ROOT else (x_end, NOTHING)
        x = first_root(s.switch, 0, order - 1, x_end, s.powers, s.roots)
        if x != NO_ROOT:
            x_end, cause = x, RELEASE_FORWARD
            set_powers(s.powers, x_end)
        if s.switch2[0] < s.switch[0]:
            x = first_root(s.switch2, 0, order - 1, x_end, s.powers, s.roots)
            if x != NO_ROOT:
                x_end, cause = x, RELEASE_BACKWARD
                set_powers(s.powers, x_end)
        if model.mu_s == 0.0 and not model.bonded:
            # the friction limit is zero all along and says nothing of contact
            x = first_root(s.P, 0, order - 1, x_end, s.powers, s.roots)
            if x != NO_ROOT:
                x_end, cause = x, CONTACT_LOST
        return x_end, cause
    if phase == SEPARATION:
        x = first_root(s.switch, known, order, x_end, s.powers, s.roots)
        return (x, GAP_CLOSED) if x != NO_ROOT else (x_end, NOTHING)
    x = first_root(s.switch, known, order, x_end, s.powers, s.roots)
    if x != NO_ROOT:
        x_end, cause = x, AT_REST
        set_powers(s.powers, x_end)
    if not model.bonded:
        x = first_root(s.P, 0, order - 1, x_end, s.powers, s.roots)
        if x != NO_ROOT:
            x_end, cause = x, CONTACT_LOST
    return x_end, cause


@inlined
def advance_time(x, dt):
    """Compensated sum: TIME + TIME_LOW is the time to twice the digits."""
    dt += x[TIME_LOW]
    new = x[TIME] + dt
    kept = new - x[TIME]
    x[TIME_LOW] = (x[TIME] - (new - kept)) + (dt - kept)
    x[TIME] = new


@inlined
def _record(model, state, kind, counters, rows):
    """Count an event and, if events are kept, append its row."""
    counters[EVENTS] += 1
    if kind == LOSS_OF_CONTACT:
        counters[SEPARATIONS] += 1
    if len(rows) == 0:
        return
    row, x = rows[counters[EVENT_ROWS]], state.x
    u, v = x[U], x[U_VELOCITY]
    if x[PHASE] != SEPARATION:
        u, v, _ = disc_point(model, state)
    row[0] = x[TIME] + x[TIME_LOW]
    row[1], row[2], row[3] = kind, x[PHASE], x[DIRECTION]
    row[4], row[5], row[6], row[7], row[8] = x[PSI], x[SPEED], u, v, x[FORCE]
    counters[EVENT_ROWS] += 1


@inlined
def _switch(model, state, cause, at_once, counters, rows, audit):
    """Carry out the switch and record its events; ``at_once``: after no time.  Returns CONSISTENT or PARADOX."""
    came_from = state.x[DIRECTION]
    if cause == GAP_CLOSED:
        before, velocity = transverse_energy(model, state, SEPARATION), state.x[U_VELOCITY]
        _, _, slope = disc_point(model, state)
        outcome = touch_down(model, state)
        audit_impact(model, before, model.m * (state.x[U_VELOCITY] - velocity), slope, state, audit)
        kind = REATTACHMENT
    elif cause == AT_REST:
        outcome = come_to_rest(model, state)
        kind = SLIP_TO_STICK if state.x[PHASE] == STICK else SLIP_REVERSAL
    elif cause == CONTACT_LOST:
        outcome = lose_contact(model, state)
        kind = LOSS_OF_CONTACT
    else:
        outcome = break_loose(model, state, 1.0 if cause == RELEASE_FORWARD else -1.0, at_once)
        kind = STICK_TO_SLIP
    if outcome == PARADOX:
        return outcome
    lost = state.x[PHASE] == SEPARATION and kind != LOSS_OF_CONTACT
    if not (kind == SLIP_REVERSAL and state.x[DIRECTION] == came_from) and not (kind == SLIP_REVERSAL and lost):
        _record(model, state, kind, counters, rows)
    if lost:
        _record(model, state, LOSS_OF_CONTACT, counters, rows)
    return outcome


@inlined
def _move(
    model, s, state, probe, order, x_end, audit_every, counters, phase_times, audit, samplers, sampled, sample_rows,
):  # fmt: skip
    """Carry the state and the clock over a step, or a coast (order ``COAST``), auditing and sampling on the way."""
    x, phase = state.x, state.x[PHASE]
    counters[STEPS] += 1
    counters[FROM_AUDIT] += 1
    if counters[FROM_AUDIT] >= audit_every:
        counters[FROM_AUDIT] = 0
        audit_step(model, s, order, x_end, phase, x[DIRECTION], probe, audit)
    if len(samplers) > 0:
        counters[SAMPLE_ROWS] = sample_step(
            model, s, order, state, x_end, samplers, sampled, probe, sample_rows, counters[SAMPLE_ROWS]
        )
    move_to(model, s, order, x_end, phase, state)
    x[KNOWN], x[FORCE], x[COASTED] = 0.0, 0.0, 1.0 if x_end < LONGEST_COAST else 0.0
    advance_time(x, x_end * model.unit)
    phase_times[int(phase)] += x_end * model.unit


@kernel
def run(
    model, s, state, probe, order, tolerance, t_end, stop_at_first, max_steps, pause_after, audit_every,
    counters, phase_times, audit, samplers, sampled, sample_capacity, sample_rows, event_rows,
):  # fmt: skip
    """Advance ``state`` until a reason to return: one of PAUSED ... NON_FINITE.

    order, tolerance: of the series; t_end: s; audit_every: steps between energy audits; counters: shape (N_COUNTERS,);
    phase_times: s, shape (3,); audit: see ``audit``; samplers, sampled: see ``sampling``; sample_capacity: rows that
    may be filled before the machine pauses; event_rows: shape (capacity, len(EVENT_ROW)), capacity 0 keeps no events.
    """
    pause = counters[STEPS] + pause_after
    x = state.x
    while True:
        if counters[STEPS] >= max_steps:
            return STEP_LIMIT
        full = len(event_rows) > 0 and counters[EVENT_ROWS] > len(event_rows) - MAX_EVENTS_PER_STEP
        if full or counters[STEPS] >= pause or counters[SAMPLE_ROWS] > sample_capacity:
            return PAUSED
        phase = x[PHASE]
        left = ((t_end - x[TIME]) - x[TIME_LOW]) / model.unit
        if phase == STICK and x[COASTED] == 0.0:
            x_end = min(coast_length(model, s, state), left)
            if x_end > 0.0:
                _move(
                    model, s, state, probe, COAST, x_end,
                    audit_every, counters, phase_times, audit, samplers, sampled, sample_rows,
                )  # fmt: skip
                if x_end >= left:
                    return FINISHED
                continue
        if expand(model, s, state, order) <= PAINLEVE_MARGIN:
            return NO_SOLUTION
        x_end = step_size(model, s, order, tolerance, phase)
        if not x_end > 0.0:
            return NON_FINITE
        x_end, cause = first_switch(model, s, state, order, min(x_end, left))
        before = x[TIME]
        _move(
            model, s, state, probe, order, x_end,
            audit_every, counters, phase_times, audit, samplers, sampled, sample_rows,
        )  # fmt: skip
        if cause != NOTHING:
            counters[IN_A_ROW] = counters[IN_A_ROW] + 1 if x[TIME] == before else 0
            if counters[IN_A_ROW] > MAX_EVENTS_IN_A_ROW:
                return STALLED
            if _switch(model, state, cause, x_end == 0.0, counters, event_rows, audit) == PARADOX:
                return NO_SOLUTION
            if stop_at_first and counters[SEPARATIONS] > 0:
                return STOPPED
        if x_end >= left:
            return FINISHED
