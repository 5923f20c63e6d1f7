"""Taylor coefficients of stick (docs/model.md, Stick), with the law of contact as a stage.

Where the surface on which friction acts moves, the slider moves with it, and inertia is a part of
the force H by which the disc holds the slider (docs/model.md, Friction on the surface).
"""

from .contact import leverage
from .jit import inlined
from .jit.simd import total
from .laws import surface_mobility
from .modes import (
    begin_stick,
    deflection,
    next_stick,
    put_last_forces,
    rest_on_disc,
    slope,
    stretched_stick,
    surface_velocity,
)


@inlined
def stick_series(model, series, order):
    """Fill ``series``, whose coefficients 0 are given, up to degree ``order`` with stick; P, which
    is V, up to ``order - 1``, and both release functions."""
    S = model.inverse_effective_mass
    inverse = 1.0 / (1.0 + model.m * S)
    by_acceleration = model.m * inverse
    # V acts on the next order of itself by the disc's damping, and by u' in the slider's damper: by
    # one factor, because that chain sets the pace
    by_impulse = inverse * (model.m * model.damped_inverse_mass - model.c * S)
    rest_on_disc(model, series, 0.0)
    pending = begin_stick(model, series)
    u = series.u[0]
    v = series.v[0]
    v_free = v  # u' without V of the order before
    if model.has_moving_surface:
        series.slider[0] = surface_velocity(model, series) / model.r_0
    V_impulse = 0.0
    H_impulse = 0.0
    for k in range(order):
        pending = stretched_stick(model, series, k, pending)
        pairs = total(pending.up)
        along = pending.along
        single, pending = next_stick(model, series, k, V_impulse, H_impulse)

        # the law of contact
        up = series.up[k]
        if model.has_compliance:
            V = (deflection(model, series, k) - u) / model.compliance
            vertical = series.preload[k] + model.k * u + model.c * v
            u = v * up
            v = (V - vertical) / model.m * up
            V_impulse = V * up
            series.V[k] = V
        else:
            vertical = series.preload[k] + model.k * u + model.c * v_free
            acceleration = pairs + (single + V_impulse * model.damped_inverse_mass)
            V = by_impulse * V_impulse + (by_acceleration * (pairs + single) + inverse * vertical)
            u = v * up
            v_free = acceleration * up
            V_impulse = V * up
            v = v_free - S * V_impulse
        series.psi[k + 1] = series.drive[k] * up
        if model.has_moving_surface:
            H_impulse = _surface_order(model, series, k, total(along), H_impulse)
        series.P[k] = V
        series.switch[k] = model.mu_s * V
        series.switch2[k] = model.mu_s * V
        series.u[k + 1] = u
        series.v[k + 1] = v
        series.f[k] = 0.0

    put_last_forces(model, series, order, V_impulse, H_impulse)
    series.f[order] = 0.0
    series.P[order] = 0.0
    series.switch[order] = 0.0
    series.switch2[order] = 0.0
    if model.has_normal_force:
        _release_on_slope(model, series, order)
    else:
        _release(model, series, order)


@inlined
def _surface_order(model, series, k, along, H_impulse):
    """Enter H of order k, and the slider's own rate, psi and the surface's turn of order k + 1.
    Returns the impulse of H, which is that of the order before in ``H_impulse``; along: G of order k
    without it."""
    up = series.up[k]
    slider = series.slider[k]
    G = along - model.damped_surface_inverse_mass * H_impulse
    F = model.k_p * series.psi[k] + model.c_p * (series.drive[k] - slider)
    H = (model.r_0 * F - model.m * G) / surface_mobility(model, model.m)
    turn = slider * up
    series.hold[k] = H
    series.slider[k + 1] = (G + model.surface_inverse_mass * H) / model.r_0 * up
    series.psi[k + 1] -= turn
    series.turn[k + 1] = turn
    return H * up


@inlined
def _hold(model, series, k):
    """H of order k, in N: r_0 F, which is 0 from order 3 on, unless the surface moves."""
    if model.has_moving_surface:
        return series.hold[k]
    return model.r_0 * (model.k_p * series.psi[k] + model.c_p * series.drive[k])


@inlined
def _orders_of_hold(model, order):
    """Return how many orders H is entered to, or is not zero."""
    return order if model.has_moving_surface else 3


@inlined
def _release(model, series, order):
    """Complete both release functions, mu_s press -/+ pull (see `laws.stick_loads`), by the pull,
    which is H."""
    for k in range(_orders_of_hold(model, order)):
        pull = _hold(model, series, k)
        series.switch[k] -= pull
        series.switch2[k] += pull


@inlined
def _release_on_slope(model, series, order):
    """Fill both release functions under the normal force, from V in P. If only the slope pulls at a
    slider that may leave the disc, they are divided by the common factor V: mu_s -/+ beta."""
    for k in range(order):
        series.slope[k] = slope(model, series, k) / model.r_0
        pull = _hold(model, series, k)
        pull -= leverage(series.slope, series.P, k) + series.slope[0] * series.P[k]
        press = series.P[k]
        for j in range(min(k + 1, _orders_of_hold(model, order))):
            press += _hold(model, series, j) * series.slope[k - j]
        series.switch[k] = model.mu_s * press - pull
        series.switch2[k] = model.mu_s * press + pull
    only_slope = _hold(model, series, 0) == 0.0 and _hold(model, series, 1) == 0.0
    if only_slope and not model.bonded:
        for k in range(order):
            series.switch[k] = series.slope[k]
            series.switch2[k] = -series.slope[k]
        series.switch[0] += model.mu_s
        series.switch2[0] += model.mu_s
