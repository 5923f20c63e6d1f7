"""The record of a run: counts, times of phases, energy audits, uniform samples and rows of events.

A sample at an event shows the side before it. Its time is rounded, and differently on another way
to the same event: a sample is "at" an event up to `SAME_INSTANT` of the clock after it.
"""

import math
from typing import NamedTuple

import numpy as np

from .audit import SURFACE, audit_impact, audit_step, surface_share, transverse_energy
from .dense_output import CLOSED_FORM, force_at, move_to
from .jit import helper, inlined
from .model import drive_angle, drive_now, is_rigid
from .state import (
    DIRECTION,
    FORCE,
    HALF,
    PHASE,
    PSI,
    SEPARATION,
    STICK,
    SURFACE_TURN,
    TIME,
    TIME_LOW,
    U_VELOCITY,
    WIDTH,
)
from .transitions import (
    AT_REST,
    CONSISTENT,
    GAP_CLOSED,
    NO_SOLUTION,
    PAUSED,
    STEP_LIMIT,
    change_phase,
    disc_point,
    slider_motion,
    slider_rate,
)

# Kinds of event, in the order of ``disc_model.data.variables.EVENT_KINDS``.
STICK_TO_SLIP, SLIP_TO_STICK, SLIP_REVERSAL, LOSS_OF_CONTACT, REATTACHMENT = range(5)
# Kind of event by its cause, in the order of the causes in `transitions`; at rest the slider may
# also reverse.
KIND_OF = (-1, STICK_TO_SLIP, STICK_TO_SLIP, SLIP_TO_STICK, LOSS_OF_CONTACT, REATTACHMENT)

# Places in ``RunBuffers.counters``.
STEPS, EVENTS, SEPARATIONS, EVENT_ROWS, SAMPLE_ROWS, FROM_AUDIT, N_COUNTERS = range(7)
# Columns of a row of events.
EVENT_ROW = ("time", "kind", "phase", "direction", "psi", "f", "u", "u_velocity", "P")
MAX_EVENTS_PER_STEP = 3
# Columns of a sampler: first time (s), interval (s), number of samples, angle of the fixed point
# (rad), end of the run (s).
FIRST, INTERVAL, NUMBER, THETA, RUN_END = range(5)
# Columns of a row of samples.
SAMPLE_ROW = (
    "sampler",
    "time",
    "P",
    "u",
    "u_velocity",
    "w",
    "w_point",
    "w_point_velocity",
    "psi",
    "psi_velocity",
    "phase",
)
# A release found by the series is rounded at each step, and deviates by up to 80 units of rounding
# within 400 steps.
SAME_INSTANT = 256 * 2.0**-52


class RunBuffers(NamedTuple):
    """Arrays into which a run is recorded."""

    counters: np.ndarray  # shape (N_COUNTERS,)
    phase_times: np.ndarray  # s, shape (3,)
    audit: np.ndarray  # see `audit`
    samplers: np.ndarray  # (n, 5), see ``FIRST``
    sampled: np.ndarray  # (n,), samples taken so far
    sample_rows: np.ndarray  # (more than capacity, len(SAMPLE_ROW))
    sample_capacity: int  # rows that may be filled before the run pauses
    event_rows: np.ndarray  # (capacity, len(EVENT_ROW))


@inlined
def reason_to_pause(limits, pause_at, buffers):
    """Return STEP_LIMIT, PAUSED if a buffer may not hold another step, or CONSISTENT."""
    counters = buffers.counters
    if counters[STEPS] >= limits.max_steps:
        return STEP_LIMIT
    events_fill = counters[EVENT_ROWS] > len(buffers.event_rows) - MAX_EVENTS_PER_STEP
    samples_fill = counters[SAMPLE_ROWS] > buffers.sample_capacity
    if events_fill or samples_fill or counters[STEPS] >= pause_at:
        return PAUSED
    return CONSISTENT


# ---- Steps


@inlined
def record_step(model, series, state, probe, step, limits, buffers):
    """Move ``state`` to the end of a step, and record the step on the way; ``probe`` is a work
    state."""
    counters = buffers.counters
    phase = state.x[PHASE]
    counters[STEPS] += 1
    buffers.phase_times[int(phase)] += step.length * model.unit
    counters[FROM_AUDIT] += 1
    if counters[FROM_AUDIT] >= limits.audit_every:
        counters[FROM_AUDIT] = 0
        audit_step(model, series, step.order, step.length, state, probe, buffers.audit)
    if len(buffers.samplers) > 0:
        sample_step(model, series, step, state, probe, buffers)
    move_to(model, series, step.order, step.length, phase, state)
    if model.has_moving_surface and step.order != CLOSED_FORM:
        share = surface_share(model, series)
        buffers.audit[SURFACE] = max(buffers.audit[SURFACE], share)


@helper
def sample_step(model, series, step, state, probe, buffers):
    """Append a row to the buffers for every sample time within a step that starts at ``state``, its
    end included, to rounding."""
    start = state.x[TIME]
    low = state.x[TIME_LOW]
    phase = state.x[PHASE]
    samplers = buffers.samplers
    last = step.length + SAME_INSTANT * (start / model.unit + step.length + 1.0)
    for i in range(len(samplers)):
        while buffers.sampled[i] < samplers[i, NUMBER]:
            # the last sample may lie a rounding error behind the end of the run
            time = samplers[i, FIRST] + buffers.sampled[i] * samplers[i, INTERVAL]
            time = min(time, samplers[i, RUN_END])
            x = ((time - start) - low) / model.unit
            if x > last:
                break
            move_to(model, series, step.order, max(x, 0.0), phase, probe)
            P = force_at(model, series, step.order, phase, probe)
            place = drive_angle(model, time) - probe.x[PSI] - probe.x[SURFACE_TURN]
            angle = samplers[i, THETA] - place
            row = buffers.sample_rows[buffers.counters[SAMPLE_ROWS]]
            row[0] = i
            row[1] = time
            row[2] = P
            _describe(model, probe, angle, row)
            buffers.counters[SAMPLE_ROWS] += 1
            buffers.sampled[i] += 1


@inlined
def _describe(model, state, angle, row):
    """Fill a row of samples from column 3 on; angle: of the fixed point ahead of the
    material under the slider, rad."""
    w, _, _ = disc_point(model, state)
    row[3], row[4], _ = slider_motion(model, state)
    row[5] = w
    row[6], row[7] = point_motion(model, state, angle)
    row[8] = state.x[PSI]
    row[9] = drive_now(model, state) - slider_rate(model, state)
    row[10] = state.x[PHASE]


@helper
def point_motion(model, state, angle):
    """Return displacement and velocity of the disc's point ``angle`` ahead of the material under
    the slider."""
    w = 0.0
    velocity = 0.0
    for j in range(len(model.shift)):
        if j % WIDTH < HALF:
            turn = model.shift[j] * angle
            along = model.point_amplitude[j] * math.cos(turn)
            across = model.point_amplitude[j] * math.sin(turn)
            w += along * state.z[j] + across * state.z[j + HALF]
            velocity += along * state.e[j] + across * state.e[j + HALF]
    for j in range(len(model.point_amplitude0)):
        w += model.point_amplitude0[j] * state.y[j]
        velocity += model.point_amplitude0[j] * state.g[j]
    return w, velocity


# ---- Events


@inlined
def pass_recorded_event(model, state, step, buffers):
    """Carry out the event that ends a step, and record it. Returns CONSISTENT or NO_SOLUTION."""
    came_from = state.x[DIRECTION]
    hits = step.cause == GAP_CLOSED and is_rigid(model)
    approach = _approach(model, state, hits)
    outcome = change_phase(model, state, step.cause, step.length == 0.0)
    if hits:
        impulse = model.m * (state.x[U_VELOCITY] - approach.velocity)
        audit_impact(model, approach.energy, impulse, approach.slope, state, buffers.audit)
    if outcome == NO_SOLUTION:
        return outcome

    # contact may be lost at once in the phase that follows
    phase = state.x[PHASE]
    kind = KIND_OF[step.cause]
    if step.cause == AT_REST and phase != STICK:
        kind = SLIP_REVERSAL
    lost = phase == SEPARATION and kind != LOSS_OF_CONTACT
    continues = lost or state.x[DIRECTION] == came_from
    if not (kind == SLIP_REVERSAL and continues):
        _record_event(model, state, kind, buffers)
    if lost:
        _record_event(model, state, LOSS_OF_CONTACT, buffers)
    return outcome


class Approach(NamedTuple):
    """A state before an impact, as far as its energy balance needs it; zeros before other events."""

    energy: float  # transverse energy, J
    velocity: float  # u', m/s
    slope: float  # B, m


@inlined
def _approach(model, state, hits):
    """`Approach` of a state; hits: whether an impact follows."""
    if not hits:
        return Approach(0.0, 0.0, 0.0)
    _, _, B = disc_point(model, state)
    return Approach(transverse_energy(model, state, SEPARATION), state.x[U_VELOCITY], B)


@inlined
def _record_event(model, state, kind, buffers):
    """Count an event and append its row."""
    counters = buffers.counters
    counters[EVENTS] += 1
    if kind == LOSS_OF_CONTACT:
        counters[SEPARATIONS] += 1
    u, v, _ = slider_motion(model, state)
    x = state.x
    row = buffers.event_rows[counters[EVENT_ROWS]]
    row[0] = x[TIME] + x[TIME_LOW]
    row[1] = kind
    row[2] = x[PHASE]
    row[3] = x[DIRECTION]
    row[4] = x[PSI]
    row[5] = slider_rate(model, state)
    row[6] = u
    row[7] = v
    row[8] = x[FORCE]
    counters[EVENT_ROWS] += 1
