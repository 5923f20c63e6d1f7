"""One step of the motion: its series, its length, and the event that ends the phase within it."""

import math

import numpy as np

from . import layout, series, transitions
from .dense_output import load_state
from .jit import inlined
from .jit.simd import WIDTH, absolute, largest, load, maximum, splat
from .polynomial import NO_ROOT, first_root, set_powers

# Longest step, in radians of the fastest motion: in longer ones the series' terms cancel more digits than they add.
LONGEST_STEP, TYPICAL_STEP = 8.0, 3.0


@inlined
def _size(model, s, k):
    """Largest modulus among the modal velocities of order k."""
    width, n, biggest = series.lane_count(model), len(model.mode_amplitude0), splat(0.0)
    for j in range(k * width, (k + 1) * width, WIDTH):
        biggest = maximum(biggest, absolute(load(s.modes, series.E * width + j)))
    size = largest(biggest)
    for j in range(n):
        size = max(size, abs(s.g[j * layout.ROWS + k]))
    return size


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
    """Reference of a quantity's error: its usual or present size, whichever is larger; its growth if both are zero."""
    size = max(usual, now)
    return size if size > 0.0 else growth


@inlined
def _relative(error, scale):
    return error / scale if scale > 0.0 else error


@inlined
def step_size(model, s, order, tolerance, phase):
    """Step (time units) at which the last two terms of the series fall below the tolerance (Jorba and Zou). The two are
    merged as if the step were ``TYPICAL_STEP``, which saves a root.  Modal velocities are compared with those of static
    deflection under the preload, f with the drive speed, or with their own size; u' where it is not the disc's."""
    # time is measured by the fastest motion in compliant contact, which does not exist out of contact
    calm = model.free_unit if model.compliant and phase == layout.SEPARATION else 1.0
    typical, longest = TYPICAL_STEP * calm, LONGEST_STEP * calm
    last = max(_size(model, s, order), _size(model, s, order - 1) / typical)
    usual_speed, share = series.drive(model, s), 1.0
    if model.ramped:
        share = series.load_at(model, s) / model.N
    scale = _scale(share * model.velocity_scale, _size(model, s, 0), _size(model, s, 1))
    speed = _scale(usual_speed, abs(s.f[0]), abs(s.f[1]))
    weight = 1.0
    if model.decaying and phase == layout.SLIP and model.decay > 0.0:
        # slow slip grows by itself, and where friction falls the series converges like that of a fraction
        slow, weight = abs(s.f[0]) + 1.0 / model.decay, 10.0
        speed = min(speed, slow) if speed > 0.0 else slow
    error = _relative(last, scale) + weight * _relative(_last_two(s.f, order, typical), speed)
    if model.compliant or phase == layout.SEPARATION:
        error += _relative(_last_two(s.v, order, typical), _scale(share * model.slider_scale, abs(s.v[0]), abs(s.v[1])))
    if phase != layout.SEPARATION:
        last_force = _last_force(s.P, order)
        force = _scale(series.load_at(model, s), abs(s.P[0]), abs(s.P[1]))
        if model.normal and phase == layout.STICK:
            # the release functions, unlike P, contain the slope's acceleration
            last_force = max(last_force, _last_force(s.switch, order), _last_force(s.switch2, order))
        error += _relative(last_force, force)
    if not error < math.inf or not scale + speed < math.inf:
        return math.nan
    if error * longest**order <= tolerance:
        return longest
    # (tolerance / error)**(1 / order) to 0.8 % for orders >= 14, faster than libm: the bits of a number are its binary
    # logarithm, interpolated linearly between powers of two
    logarithm = (np.float64(tolerance / error).view(np.int64) * 2.0**-52 - 1023.0) * (1.0 / order)
    whole = math.floor(logarithm)
    part = logarithm - whole
    return np.int64((whole + 1023.0 + part * (0.6565 + 0.3435 * part)) * 2.0**52).view(np.float64)


@inlined
def expand(compliant, normal, decaying, model, s, state, order):
    """Series of the current phase.  Returns the denominator of P in slip over that without friction, else 1. The first
    arguments are flags of the model: the compiler drops a branch unseen if its condition is an argument's length."""
    load_state(model, s, state)
    phase, direction = state.x[layout.PHASE], state.x[layout.DIRECTION]
    if phase == layout.SLIP:
        if len(compliant) == 1:
            return series.compliant_slip_series(model, s, order, direction)
        if len(normal) == 1:
            return series.rigid_slip_series(model, s, order, direction) / transitions.usual_denominator(model)
        if len(decaying) == 1:
            return series.rigid_slip_series(model, s, order, direction) / transitions.usual_denominator(model)
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
    """Place where an event function ends the phase, and its ``cause``; (x_end, ``later``) if it does not end it."""
    x = first_root(c, known, n, x_end, s.powers, s.roots)
    if x == NO_ROOT:
        return x_end, later
    set_powers(s.powers, x, n)
    return x, cause


@inlined
def first_event(model, s, state, order, x_end):
    """Place and cause of the phase's end within (0, x_end]: (x, cause), or (x_end, NOTHING)."""
    phase, known, known_force = state.x[layout.PHASE], int(state.x[layout.KNOWN]), 0
    if model.compliant:  # there the contact force, too, starts at zero
        known_force = int(state.x[layout.KNOWN_FORCE])
    set_powers(s.powers, x_end, order)
    if phase == layout.SEPARATION:
        x, cause = _sooner(s, s.switch, known, order, x_end, transitions.GAP_CLOSED, transitions.NOTHING)
        if cause != transitions.GAP_CLOSED or known != 0:
            return x, cause
        # a run that was cut just after a separation knows no root there, but the gap, and its rates per radian of the
        # fastest motion, are still rounding
        rounding = transitions.ROUNDING * transitions.deflection_size(model, state)
        while known < 3 and abs(s.switch[known]) <= rounding:
            known += 1
        if known == 0:
            return x, cause
        set_powers(s.powers, x_end, order)
        return _sooner(s, s.switch, known, order, x_end, transitions.GAP_CLOSED, transitions.NOTHING)
    if phase == layout.SLIP:
        x_end, cause = _sooner(s, s.switch, known, order, x_end, transitions.AT_REST, transitions.NOTHING)
        if not model.bonded:
            x_end, cause = _sooner(s, s.P, known_force, order - 1, x_end, transitions.CONTACT_LOST, cause)
        return x_end, cause
    cause, known_release = transitions.NOTHING, known_force
    never_pulled = model.k_p * model.Omega == 0.0 and transitions.inplane_force_per_radius(model, state) == 0.0
    if not model.bonded and never_pulled:
        # P = 0 and the friction limit coincide, and it is contact that ends
        x_end, cause = _sooner(s, s.P, known_force, order - 1, x_end, transitions.CONTACT_LOST, cause)
        if not model.normal:
            return x_end, cause
        # the slope of the disc may pull: here P is no factor of the release functions
        known_release = 0
    x_end, cause = _sooner(s, s.switch, known_release, order - 1, x_end, transitions.RELEASE_FORWARD, cause)
    # under the vertical force the pull only grows; a bent disc's slope can turn it, or the damper of a slowing drive
    if model.normal or model.ramped or s.switch2[0] < s.switch[0]:
        x_end, cause = _sooner(s, s.switch2, known_release, order - 1, x_end, transitions.RELEASE_BACKWARD, cause)
    if not model.bonded and (model.mu_s == 0.0 or (model.compliant and model.normal)):
        # friction may hold although contact ends: without any, or on a slope so steep that it holds the slider down
        x_end, cause = _sooner(s, s.P, known_force, order - 1, x_end, transitions.CONTACT_LOST, cause)
    return x_end, cause


@inlined
def set_course(model, state):
    """Set Omega and N to those of the state's time, on a ramp."""
    if model.ramped:
        x = state.x
        since = (x[layout.TIME] - model.ramp_begin) + x[layout.TIME_LOW]
        x[layout.DRIVE] = model.Omega + model.Omega_rate * since
        x[layout.LOAD] = model.N + model.N_rate * since
