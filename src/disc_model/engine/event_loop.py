"""The event loop: expand the series, find the first event, move there, change phase, record; until
the end.

A `run` records the motion, and returns when a buffer is full. Pauses have no influence on results.
An integration takes small changes along with the motion instead, to a time or back to a section,
and records nothing but counts.
"""

import math
from typing import NamedTuple

import numpy as np

from . import layout, series, tangent, transitions
from .audit import SURFACE, audit_impact, audit_step, surface_velocity, transverse_energy
from .dense_output import (
    CLOSED_FORM,
    LONGEST_STICK,
    closed_form_length,
    load_state,
    move_to,
    sample_step,
)
from .jit import helper, inlined, kernel
from .jit.packing import packed
from .jit.simd import WIDTH, mul, splat, store
from .laws import PSI_ENTRY, TINY, stepped
from .polynomial import NO_ROOT, first_root, set_powers

# Kinds of event, in the order of ``disc_model.data.variables.EVENT_KINDS``.
STICK_TO_SLIP, SLIP_TO_STICK, SLIP_REVERSAL, LOSS_OF_CONTACT, REATTACHMENT = range(5)
# Kind of event by its cause, in the order of the causes in ``transitions``; at rest the slider may
# also reverse.
KIND_OF = (-1, STICK_TO_SLIP, STICK_TO_SLIP, SLIP_TO_STICK, LOSS_OF_CONTACT, REATTACHMENT)

STEPS, EVENTS, SEPARATIONS, EVENT_ROWS, SAMPLE_ROWS, FROM_AUDIT, N_COUNTERS = range(7)
EVENT_ROW = ("time", "kind", "phase", "direction", "psi", "f", "u", "u_velocity", "P")
MAX_EVENTS_PER_STEP = 3
# State.x[PROPAGATED] after the closed form of stick, which usually ends shortly before the release:
# the next step is short, and a series of low order is enough for it.
JUST_PROPAGATED, ORDER_BEFORE_RELEASE = 2.0, 10
# Longest step, in radians of the fastest motion: in longer ones the series' terms cancel more
# digits than they add.
LONGEST_STEP, TYPICAL_STEP = 8.0, 3.0


class Limits(NamedTuple):
    order: int  # of the series
    tolerance: float  # of the series
    t_end: float  # s
    may_separate: bool  # if not, a loss of contact ends the run
    max_steps: int
    pause_after: int  # steps
    audit_every: int  # steps


class IntegrationLimits(NamedTuple):
    order: int  # of the series
    tolerance: float  # of the series
    longest: float  # step, time units: columns are rougher than the motion that sizes the steps; see ``longest_step``
    t_max: float  # s, of the flight
    releases: int  # it ends where stick is released forwards for that time; 0: at ``t_max``
    may_separate: bool  # if not, a loss of contact ends it
    tangent: bool  # whether the columns travel along


class RunBuffers(NamedTuple):
    counters: np.ndarray  # shape (N_COUNTERS,)
    phase_times: np.ndarray  # s, shape (3,)
    audit: np.ndarray  # see ``audit``
    samplers: np.ndarray  # see ``dense_output.sample_step``
    sampled: np.ndarray  # see ``dense_output.sample_step``
    sample_rows: np.ndarray  # see ``dense_output.sample_step``
    sample_capacity: int  # rows that may be filled before the machine pauses
    event_rows: np.ndarray  # shape (capacity, len(EVENT_ROW))


@packed
class Section(NamedTuple):
    """Points of the section "stick is about to be released forwards", n coordinates each, and the
    map's Jacobian."""

    rows: np.ndarray  # (n,), where each coordinate stands in a column
    scale: np.ndarray  # (n,), coordinate over the state's entry
    end: np.ndarray  # (n,)
    jacobian: np.ndarray  # (n, columns)


@inlined
def _last_two(c, order, typical):
    """Size of the last two terms, as if the step were ``typical``."""
    return max(abs(c[order]), abs(c[order - 1]) / typical)


@inlined
def _last_force(c, order):
    """As ``_last_two`` for P or a release function, which are known to one order less."""
    return max(abs(c[order - 1]) / TYPICAL_STEP, abs(c[order - 2]) / TYPICAL_STEP**2)


@inlined
def _scale(usual, now, growth):
    """Reference of a quantity's error: its usual or present size, whichever is larger; its growth
    if both are zero."""
    size = max(usual, now)
    return size if size > 0.0 else growth


@inlined
def _relative(error, scale):
    return error / scale if scale > 0.0 else error


@inlined
def step_size(model, s, order, tolerance, phase):
    """Step (time units) at which the last two terms of the series fall below the tolerance (Jorba
    and Zou). The two are merged as if the step were ``TYPICAL_STEP``, which saves a root.  Modal
    velocities are compared with those of static deflection under the preload, f with the drive
    speed, or with their own size; u' where it is not the disc's."""
    # time is measured by the fastest motion in compliant contact, which does not exist out of
    # contact
    calm = model.free_unit if model.compliant and phase == layout.SEPARATION else 1.0
    typical, longest = TYPICAL_STEP * calm, LONGEST_STEP * calm
    last = max(
        series.velocity_size(model, s, order), series.velocity_size(model, s, order - 1) / typical
    )
    usual_speed, share = series.drive(model, s), 1.0
    if model.ramped:
        share = series.load_at(model, s) / model.N
    scale = _scale(
        share * model.velocity_scale,
        series.velocity_size(model, s, 0),
        series.velocity_size(model, s, 1),
    )
    speed = _scale(usual_speed, abs(s.f[0]), abs(s.f[1]))
    weight = 1.0
    if model.decaying and phase == layout.SLIP and model.decay > 0.0:
        # slow slip grows by itself, and where friction falls the series converges like that of a
        # fraction
        slow, weight = abs(s.f[0]) + 1.0 / model.decay, 10.0
        speed = min(speed, slow) if speed > 0.0 else slow
    error = _relative(last, scale) + weight * _relative(_last_two(s.f, order, typical), speed)
    if model.compliant or phase == layout.SEPARATION:
        error += _relative(
            _last_two(s.v, order, typical),
            _scale(share * model.slider_scale, abs(s.v[0]), abs(s.v[1])),
        )
    if phase != layout.SEPARATION:
        last_force = _last_force(s.P, order)
        force = _scale(series.load_at(model, s), abs(s.P[0]), abs(s.P[1]))
        if model.normal and phase == layout.STICK:
            # the release functions, unlike P, contain the slope's acceleration
            last_force = max(
                last_force, _last_force(s.switch, order), _last_force(s.switch2, order)
            )
        error += _relative(last_force, force)
    if not error < math.inf or not scale + speed < math.inf:
        return math.nan
    if error * longest**order <= tolerance:
        return longest
    # (tolerance / error)**(1 / order) to 0.8 % for orders >= 14, faster than libm: the bits of a
    # number are its binary logarithm, interpolated linearly between powers of two
    logarithm = (np.float64(tolerance / error).view(np.int64) * 2.0**-52 - 1023.0) * (1.0 / order)
    whole = math.floor(logarithm)
    part = logarithm - whole
    return np.int64((whole + 1023.0 + part * (0.6565 + 0.3435 * part)) * 2.0**52).view(np.float64)


@inlined
def expand(compliant, normal, other, model, s, state, order):
    """Series of the current phase.  Returns the denominator of P in slip over that without
    friction, else 1. The first arguments are flags of the model (``other``: of the normal force or
    of falling friction): the compiler drops a branch unseen if its condition is an argument's
    length."""
    load_state(model, s, state)
    phase, direction = state.x[layout.PHASE], state.x[layout.DIRECTION]
    if phase == layout.SLIP:
        if len(compliant) == 1:
            return series.compliant_slip_series(model, s, order, direction)
        if len(other) > 0:
            return series.rigid_slip_series(
                model, s, order, direction
            ) / transitions.usual_denominator(model)
        return series.slip_series(model, s, order, direction) / transitions.usual_denominator(model)
    if phase == layout.SEPARATION:
        series.separation_series(model, s, order)
    elif len(compliant) == 1:
        series.compliant_stick_series(model, s, order)
    else:
        series.stick_series(model, s, order)
        if len(normal) == 1:
            series.release_series(model, s, order)
    return 1.0


@inlined
def _sooner(s, c, known, n, x_end, cause, later):
    """Place where an event function ends the phase, and its ``cause``; (x_end, ``later``) if it
    does not end it."""
    x = first_root(c, known, n, x_end, s.powers, s.roots)
    if x == NO_ROOT:
        return x_end, later
    set_powers(s.powers, x, n)
    return x, cause


@helper
def _zeros_of_gap(model, s, state, tolerance):
    """How many first coefficients of the gap are zero, but for their errors: see `first_event`."""
    zeros, closing = 0, 0.0
    rounding = transitions.gap_error(model, state, 0, 0.0)
    if not model.compliant and s.switch[3] > 0.0:
        # the time for which an error of the acceleration closes the gap, before its rate opens it
        closing = transitions.gap_error(model, state, 2, tolerance) / s.switch[3]
    while zeros < 3 and s.switch[zeros] <= rounding:
        error = transitions.gap_error(model, state, zeros, tolerance)
        if zeros < 2:
            error += s.switch[3] * closing ** (3 - zeros)
        if s.switch[zeros] < -error:
            break
        zeros += 1
    return zeros


@helper
def _zeros_of_slip(model, s, state, tolerance):
    """How many first coefficients of f in slip are zero, but for their errors: see
    `first_event`."""
    usual_speed = layout.drive_now(model, state)
    rounding = transitions.slip_error(model, state, 0.0)
    error = transitions.slip_error(model, state, tolerance)
    least = -error - tolerance * usual_speed
    greatest = rounding + transitions.ROUNDING * usual_speed
    if not least <= s.switch[0] <= greatest:
        return 0
    return 2 if -error <= s.switch[1] <= rounding else 1


@inlined
def _end_of_slip(model, s, state, known, order, x_end, tolerance):
    """Place and cause of the end of slip by f = 0; ``known``: multiplicity of its root at 0."""
    x, cause = _sooner(s, s.switch, known, order, x_end, transitions.AT_REST, transitions.NOTHING)
    if cause == transitions.AT_REST and known == 0:
        known = _zeros_of_slip(model, s, state, tolerance)
        if known > 0 and s.switch[known] > 0.0:
            set_powers(s.powers, x_end, order)
            return _sooner(
                s, s.switch, known, order, x_end, transitions.AT_REST, transitions.NOTHING
            )
    return x, cause


@inlined
def _end_of_contact(model, s, state, known, order, x_end, cause, tolerance):
    """Place where P = 0 ends the phase, and CONTACT_LOST; (x_end, ``cause``) if it does not;
    ``known``: multiplicity of its root at 0."""
    x, found = _sooner(s, s.P, known, order - 1, x_end, transitions.CONTACT_LOST, cause)
    if model.compliant and found == transitions.CONTACT_LOST and known == 0 and s.P[1] > 0.0:
        just_begun = abs(s.P[0]) <= transitions.force_error(model, state, tolerance)
        if just_begun:
            set_powers(s.powers, x_end, order)
            return _sooner(s, s.P, 1, order - 1, x_end, transitions.CONTACT_LOST, cause)
    return x, found


@inlined
def first_event(model, s, state, order, x_end, tolerance):
    """Place and cause of the phase's end within (0, x_end]: (x, cause), or (x_end, NOTHING).

    A run that was cut just after an event knows no root at its start, but its first coefficients
    are still errors of the state at the event, by the rounding and the ``tolerance`` of the series.
    They do not end the phase that has just begun: the first coefficient beyond them decides."""
    phase, known, known_force = state.x[layout.PHASE], int(state.x[layout.KNOWN]), 0
    if model.compliant:  # there the contact force, too, starts at zero
        known_force = int(state.x[layout.KNOWN_FORCE])
    set_powers(s.powers, x_end, order)
    if phase == layout.SEPARATION:
        x, cause = _sooner(
            s, s.switch, known, order, x_end, transitions.GAP_CLOSED, transitions.NOTHING
        )
        if cause == transitions.GAP_CLOSED and known == 0:
            known = _zeros_of_gap(model, s, state, tolerance)
            if known > 0 and s.switch[known] > 0.0:
                set_powers(s.powers, x_end, order)
                return _sooner(
                    s, s.switch, known, order, x_end, transitions.GAP_CLOSED, transitions.NOTHING
                )
        return x, cause
    if phase == layout.SLIP:
        x_end, cause = _end_of_slip(model, s, state, known, order, x_end, tolerance)
        if not model.bonded:
            x_end, cause = _end_of_contact(
                model, s, state, known_force, order, x_end, cause, tolerance
            )
        return x_end, cause
    cause, known_release = transitions.NOTHING, known_force
    never_pulled = (
        model.k_p * model.Omega == 0.0 and transitions.inplane_force_per_radius(model, state) == 0.0
    )
    if not model.bonded and never_pulled:
        # P = 0 and the friction limit coincide, and it is contact that ends
        x_end, cause = _end_of_contact(model, s, state, known_force, order, x_end, cause, tolerance)
        if not model.normal:
            return x_end, cause
        # the slope of the disc may pull: here P is no factor of the release functions
        known_release = 0
    x_end, cause = _sooner(
        s, s.switch, known_release, order - 1, x_end, transitions.RELEASE_FORWARD, cause
    )
    # under the vertical force the pull only grows; a bent disc's slope can turn it, or the damper
    # of a slowing drive
    if model.normal or model.ramped or s.switch2[0] < s.switch[0]:
        x_end, cause = _sooner(
            s, s.switch2, known_release, order - 1, x_end, transitions.RELEASE_BACKWARD, cause
        )
    if not model.bonded and (model.mu_s == 0.0 or (model.compliant and model.normal)):
        # friction may hold although contact ends: without any, or on a slope so steep that it holds
        # the slider down
        x_end, cause = _end_of_contact(model, s, state, known_force, order, x_end, cause, tolerance)
    return x_end, cause


@inlined
def _record(model, state, kind, buffers):
    """Count an event and append its row."""
    counters, x = buffers.counters, state.x
    counters[EVENTS] += 1
    if kind == LOSS_OF_CONTACT:
        counters[SEPARATIONS] += 1
    row = buffers.event_rows[counters[EVENT_ROWS]]
    u, v, _ = transitions.slider_motion(model, state)
    row[0] = x[layout.TIME] + x[layout.TIME_LOW]
    row[1], row[2], row[3] = kind, x[layout.PHASE], x[layout.DIRECTION]
    row[4], row[5], row[6], row[7], row[8] = x[layout.PSI], x[layout.F], u, v, x[layout.FORCE]
    counters[EVENT_ROWS] += 1


@inlined
def _apply_event(model, state, cause, at_once, buffers):
    """Carry out the event and record its events; ``at_once``: the phase had no duration.  Returns
    its exit code."""
    came_from, before, velocity, dw_dtheta = state.x[layout.DIRECTION], 0.0, 0.0, 0.0
    hits = (
        cause == transitions.GAP_CLOSED and len(model.compliant) == 0
    )  # numba has no `not` of a tuple as a value
    if hits:
        before, velocity = (
            transverse_energy(model, state, layout.SEPARATION),
            state.x[layout.U_VELOCITY],
        )
        _, _, dw_dtheta = transitions.disc_point(model, state)
    outcome = transitions.change_phase(model, state, cause, at_once)
    if hits:
        audit_impact(
            model,
            before,
            model.m * (state.x[layout.U_VELOCITY] - velocity),
            dw_dtheta,
            state,
            buffers.audit,
        )
    if outcome == transitions.NO_SOLUTION:
        return outcome
    phase, kind = state.x[layout.PHASE], KIND_OF[cause]
    if cause == transitions.AT_REST and phase != layout.STICK:
        kind = SLIP_REVERSAL
    lost = phase == layout.SEPARATION and kind != LOSS_OF_CONTACT
    if kind != SLIP_REVERSAL or not (lost or state.x[layout.DIRECTION] == came_from):
        _record(model, state, kind, buffers)
    if lost:
        _record(model, state, LOSS_OF_CONTACT, buffers)
    return outcome


@inlined
def _record_step(model, s, state, probe, order, x_end, audit_every, buffers):
    """Move ``state`` over a step, or over stick in closed form (``CLOSED_FORM``), with audits and
    samples."""
    phase, counters = state.x[layout.PHASE], buffers.counters
    counters[STEPS] += 1
    counters[FROM_AUDIT] += 1
    if counters[FROM_AUDIT] >= audit_every:
        counters[FROM_AUDIT] = 0
        audit_step(model, s, order, x_end, phase, state.x[layout.DIRECTION], probe, buffers.audit)
    if len(buffers.samplers) > 0:
        kept, filled = buffers.sample_rows, counters[SAMPLE_ROWS]
        counters[SAMPLE_ROWS] = sample_step(
            model, s, order, state, x_end, buffers.samplers, buffers.sampled, probe, kept, filled
        )
    move_to(model, s, order, x_end, phase, state)
    if model.coupled:
        speed = model.r_0 * layout.drive_now(model, state)
        share = abs(surface_velocity(model, state)) / speed if speed > 0.0 else 0.0
        buffers.audit[SURFACE] = max(buffers.audit[SURFACE], share)


@inlined
def _advance_clock(model, state, order, x_end, dt):
    """Advance the clock, by a compensated sum, and drive and load of a ramp over a step of x_end
    units, ``dt`` s."""
    x = state.x
    x[layout.KNOWN], x[layout.KNOWN_FORCE], x[layout.FORCE] = 0.0, 0.0, 0.0
    x[layout.PROPAGATED] = (
        0.0 if x_end >= LONGEST_STICK else JUST_PROPAGATED if order == CLOSED_FORM else 1.0
    )
    dt += x[layout.TIME_LOW]
    new = x[layout.TIME] + dt
    change = new - x[layout.TIME]
    x[layout.TIME_LOW] = (x[layout.TIME] - (new - change)) + (dt - change)
    x[layout.TIME] = new
    layout.set_course(model, state)


@inlined
def follow(model, s, state, probe, limits, buffers, t):
    """Advance ``state`` until a reason to return: see the exit codes in ``transitions``. The motion
    is recorded in ``buffers``; or ``t`` is a tuple of one `Tangent`, which takes counts and small
    changes, and ``limits`` are `IntegrationLimits`. The compiler drops the branches of the other
    use. ``probe`` is a work state."""
    x, start, releases, pause = state.x, state.x[layout.TIME], 0, 0
    if len(t) == 0:
        pause = buffers.counters[STEPS] + limits.pause_after
    layout.set_course(model, state)
    while True:
        order, x_end, cause = limits.order, 0.0, transitions.NOTHING
        if len(t) == 0:
            if buffers.counters[STEPS] >= limits.max_steps:
                return transitions.STEP_LIMIT
            full = buffers.counters[EVENT_ROWS] > len(buffers.event_rows) - MAX_EVENTS_PER_STEP
            if (
                full
                or buffers.counters[SAMPLE_ROWS] > buffers.sample_capacity
                or buffers.counters[STEPS] >= pause
            ):
                return transitions.PAUSED
            left = longest = ((limits.t_end - x[layout.TIME]) - x[layout.TIME_LOW]) / model.unit
            if x[layout.PHASE] == layout.STICK and x[layout.PROPAGATED] == 0.0:
                x_end = min(closed_form_length(model, s, state), left)
            elif x[layout.PROPAGATED] == JUST_PROPAGATED and not model.compliant:
                order = ORDER_BEFORE_RELEASE
        else:
            left = (limits.t_max - (x[layout.TIME] - start)) / model.unit
            longest = min(left, limits.longest)
        if x_end > 0.0:
            order = CLOSED_FORM
        else:
            denominator = expand(
                model.compliant, model.normal, model.normal + model.decaying, model, s, state, order
            )
            if denominator <= transitions.PAINLEVE_MARGIN:
                return transitions.NO_SOLUTION
            x_end = step_size(model, s, order, limits.tolerance, x[layout.PHASE])
            if not x_end > 0.0:
                return transitions.NON_FINITE
            if len(t) == 1 and model.decaying and x[layout.PHASE] == layout.SLIP:
                # where friction falls steeply, a change of f grows faster than the fastest motion
                growth = (
                    abs(series.weakening(model, s, 0, x[layout.DIRECTION]))
                    * model.unit
                    / (model.m * model.r_0)
                )
                longest = min(longest, limits.longest / max(growth, 1.0))
            x_end, cause = first_event(
                model, s, state, order, min(x_end, longest), limits.tolerance
            )
        before, dt = x[layout.TIME], x_end * model.unit
        if len(t) == 0:
            buffers.phase_times[int(x[layout.PHASE])] += dt
            _record_step(model, s, state, probe, order, x_end, limits.audit_every, buffers)
        else:
            tangent.take_step(model, s, t[0], order, x_end, dt, state, limits.tangent)
        _advance_clock(model, state, order, x_end, dt)
        if cause != transitions.NOTHING:
            x[layout.IN_A_ROW] = x[layout.IN_A_ROW] + 1.0 if x[layout.TIME] == before else 0.0
            if x[layout.IN_A_ROW] > transitions.MAX_EVENTS_IN_A_ROW:
                return transitions.STALLED
            if len(t) == 0:
                outcome = _apply_event(model, state, cause, x_end == 0.0, buffers)
            else:
                releases += 1 if cause == transitions.RELEASE_FORWARD else 0
                returns = cause == transitions.RELEASE_FORWARD and releases == limits.releases
                outcome = tangent.pass_event(
                    model, state, t[0], cause, x_end == 0.0, returns, limits.tangent
                )
            if outcome != transitions.CONSISTENT:
                return outcome
            if x[layout.PHASE] == layout.SEPARATION and not limits.may_separate:
                return transitions.STOPPED
        if x_end >= left:
            return transitions.TIME_OVER


@kernel
def run(model, s, state, probe, limits, buffers):
    """See `follow`."""
    return follow(model, s, state, probe, limits, buffers, ())


@inlined
def _entry_at(model, state, row):
    """Array and index of the entry of a state that stands at ``row`` of a column."""
    slider = row - tangent.slider_row(model, layout.PSI)
    return (state.disc, row) if slider < 0 else (state.x, layout.PSI + slider)


@kernel
def release_angle(model, state):
    """psi at a forward release; the event function is linear in it."""
    i, _ = transitions.instant(model, state)
    margin = transitions.event_function(
        model, stepped(i, PSI_ENTRY), transitions.RELEASE_FORWARD, False
    )
    return i.psi - margin.real / (margin.imag / TINY)


@helper
def _leave_section(model, s, state, t, course, section, start):
    """Put state and, if requested, columns just after the release at ``start``.  Returns an exit
    code."""
    rows, scale = section.rows, section.scale
    t.log[:] = 0.0
    state.x[:] = 0.0
    for i in range(len(rows)):
        entries, at = _entry_at(model, state, rows[i])
        entries[at] = start[i] / scale[i]
    state.x[layout.PHASE] = layout.STICK
    if not transitions.stick_force(model, state) > 0.0:
        return transitions.OFF_SECTION
    state.x[layout.PSI] = release_angle(model, state)
    if course.tangent:
        t.now[:] = 0.0
        for i in range(len(rows)):
            t.now[((i // WIDTH) * t.rows + rows[i]) * WIDTH + i % WIDTH] = 1.0 / scale[i]
        tangent.event_gradient(model, state, t, transitions.RELEASE_FORWARD)
        by_psi = splat(-1.0 / t.gradient[PSI_ENTRY])
        for c in range(0, t.columns, WIDTH):
            dpsi = mul(by_psi, tangent.put_changes(model, state, t, t.now, c, c >= t.plain))
            store(t.now, c * t.rows + tangent.slider_row(model, layout.PSI) * WIDTH, dpsi)
    if not transitions.friction_drops(model):
        # then slip begins only where the friction limit falls below the pull, and does not just
        # touch it
        tangent.rates(model, state, t.before)
        if not tangent.event_times(model, state, t, transitions.RELEASE_FORWARD, False) < 0.0:
            return transitions.OFF_SECTION
    if (
        transitions.change_phase(model, state, transitions.RELEASE_FORWARD, False)
        == transitions.NO_SOLUTION
    ):
        return transitions.NO_SOLUTION
    # the release itself belongs to the integration that ended here
    tangent.count_event(state, transitions.NOTHING, t.log)
    if state.x[layout.PHASE] == layout.SEPARATION and not course.may_separate:
        return transitions.STOPPED
    if course.tangent:
        tangent.slider_rows(model, state, t)
    return transitions.CONSISTENT


@kernel
def _flight(model, s, state, t, course, section, start):
    """See ``integrate``."""
    if len(start) > 0:
        outcome = _leave_section(model, s, state, t, course, section, start)
        if outcome != transitions.CONSISTENT:
            return outcome
    outcome = follow(model, s, state, state, course, None, (t,))
    for i in range(len(section.rows)):
        entries, at = _entry_at(model, state, section.rows[i])
        section.end[i] = entries[at] * section.scale[i]
        if course.tangent:
            for c in range(t.columns):
                at = ((c // WIDTH) * t.rows + section.rows[i]) * WIDTH + c % WIDTH
                section.jacobian[i, c] = t.now[at] * section.scale[i]
    return outcome


_NOWHERE = Section(np.zeros(0, np.int64), np.zeros(0), np.zeros(0), np.zeros((0, 0)))


def integrate(model, s, state, t, course, section=_NOWHERE, start=_NOWHERE.end):
    """Advance ``state`` and, if requested, the columns ``t.now`` to the end of an integration;
    returns its exit code. At the last release, not at ``t_max``, the columns are projected onto the
    section (their event time is t.tau, the state still in stick). ``t.log`` is incremented, or set
    from a point ``start`` of a section on, where this is its return map, with its Jacobian if the
    course asks for it. A point is given by its modal coordinates; f is 0 and psi follows from the
    release condition. ``t.parameters`` may change parameters in the columns from n on."""
    return _flight(model, s, state, t, course, section, start)
