"""The length of a step: how far the series of a phase may be trusted."""

import math

import numpy as np

from .jit import inlined
from .modes import largest_velocity
from .series import load_at_start
from .state import SEPARATION, SLIP, STICK

# Longest step, in radians of the fastest motion: in longer ones the series' terms cancel more
# digits than they add.
LONGEST_STEP = 8.0
TYPICAL_STEP = 3.0
# Slip speed, over that by which exponential friction falls to a part e, from which it counts as
# fallen.
FALLEN = 10.0


@inlined
def step_size(model, series, order, tolerance, phase):
    """Return the step (time units) at which the last two terms of the series fall below the
    tolerance (Jorba and Zou); nan if a number has overflowed.

    The two are merged as if the step were ``TYPICAL_STEP``, which saves a root.  Modal velocities
    are compared with those of static deflection under the preload, f with the drive speed, or with
    their own size; u' where it is not the disc's.
    """
    # time is measured by the fastest motion in compliant contact, which does not exist out of
    # contact
    calm = model.free_unit if model.has_compliance and phase == SEPARATION else 1.0
    typical = TYPICAL_STEP * calm
    longest = LONGEST_STEP * calm
    share = load_at_start(model, series) / model.N if model.has_ramp else 1.0

    # the disc and the slider's turning
    last_velocity = max(
        largest_velocity(model, series, order), largest_velocity(model, series, order - 1) / typical
    )
    velocity = _scale(
        share * model.velocity_scale,
        largest_velocity(model, series, 0),
        largest_velocity(model, series, 1),
    )
    speed, weight = _speed_scale(model, series, phase)
    error = _relative(last_velocity, velocity)
    error += weight * _relative(_last_two(series.f, order, typical), speed)

    # the slider's height and the contact force
    if model.has_compliance or phase == SEPARATION:
        height_rate = _scale(share * model.slider_scale, abs(series.v[0]), abs(series.v[1]))
        error += _relative(_last_two(series.v, order, typical), height_rate)
    if phase != SEPARATION:
        error += _force_error(model, series, order, phase)
    if not error < math.inf or not velocity + speed < math.inf:
        return math.nan
    length = longest
    if error * longest**order > tolerance:
        length = _root(tolerance / error, order)
    if model.has_exponential_friction and phase == SLIP:
        return _before_friction_rises(model, series, order, length)
    return length


@inlined
def _speed_scale(model, series, phase):
    """Return what the error of f is compared with, rad/s, and how much it counts."""
    speed = _scale(series.drive[0], abs(series.f[0]), abs(series.f[1]))
    if model.has_varying_friction and phase == SLIP and model.decay > 0.0:
        # slow slip grows by itself, and where friction falls the series converges like that of a
        # fraction
        slow = abs(series.f[0]) + 1.0 / model.decay
        if speed > 0.0:
            slow = min(speed, slow)
        return slow, 10.0
    return speed, 1.0


@inlined
def _before_friction_rises(model, series, order, length):
    """Return the longest step, up to ``length``, in which the slip speed certainly does not fall by
    more than half, if exponential friction has fallen.

    It then rises again from almost nothing as slip slows down, and a series of this order, whose
    terms are almost zero, does not show how far.
    """
    speed = abs(series.f[0])
    if model.decay * speed < FALLEN:
        return length
    sense = 1.0 if series.f[0] > 0.0 else -1.0
    while _greatest_loss(series.f, order, sense, length) > 0.5 * speed:
        length *= 0.75
    return length


@inlined
def _greatest_loss(c, order, sense, x):
    """Return a bound on how far a series falls below its start within x, times ``sense``."""
    loss = 0.0
    power = 1.0
    for k in range(1, order + 1):
        power *= x
        loss += max(0.0, -sense * c[k] * power)
    return loss


@inlined
def _force_error(model, series, order, phase):
    """Size of the last two terms of the contact force over its own."""
    last = _last_two_of_force(series.P, order)
    if model.has_normal_force and phase == STICK:
        # the release functions, unlike P, contain the slope's acceleration
        last = max(last, _last_two_of_force(series.switch, order))
        last = max(last, _last_two_of_force(series.switch2, order))
    force = _scale(load_at_start(model, series), abs(series.P[0]), abs(series.P[1]))
    return _relative(last, force)


@inlined
def _last_two(c, order, typical):
    """Size of the last two terms, as if the step were ``typical``."""
    return max(abs(c[order]), abs(c[order - 1]) / typical)


@inlined
def _last_two_of_force(c, order):
    """As `_last_two` for P or a release function, which are known to one order less."""
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
def _root(ratio, order):
    """ratio**(1 / order) to 0.8 % for orders >= 14, faster than libm: the bits of a number are its
    binary logarithm, interpolated linearly between powers of two."""
    logarithm = (np.float64(ratio).view(np.int64) * 2.0**-52 - 1023.0) * (1.0 / order)
    whole = math.floor(logarithm)
    part = logarithm - whole
    bits = (whole + 1023.0 + part * (0.6565 + 0.3435 * part)) * 2.0**52
    return np.int64(bits).view(np.float64)
