"""Taylor coefficients of stick (docs/model.md, Stick), with the law of contact as a stage."""

from .contact import leverage, stick_forces
from .jit import inlined
from .jit.simd import total
from .modes import begin_stick, deflection, next_stick, put_last_forces, rest_on_disc, slope


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
    V_impulse = 0.0
    T_impulse = 0.0
    for k in range(order):
        pairs = total(pending)
        single, pending = next_stick(model, series, k, V_impulse, T_impulse)

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
        if model.has_couple:
            T_impulse = _friction(model, series, k, V) * up
        series.P[k] = V
        series.switch[k] = model.mu_s * V
        series.switch2[k] = model.mu_s * V
        series.u[k + 1] = u
        series.v[k + 1] = v
        series.psi[k + 1] = series.drive[k] * up
        series.f[k] = 0.0

    put_last_forces(model, series, order, V_impulse, T_impulse)
    series.f[order] = 0.0
    series.P[order] = 0.0
    series.switch[order] = 0.0
    series.switch2[order] = 0.0
    if model.has_normal_force:
        _release_on_slope(model, series, order)
    else:
        _release(model, series)


@inlined
def _pull(model, series, k):
    """r_0 F of order k, in N; 0 from order 3 on."""
    return model.r_0 * (model.k_p * series.psi[k] + model.c_p * series.drive[k])


@inlined
def _friction(model, series, k, V):
    """Friction T of order k under V of this order; enters R and T if the force is normal."""
    pull = _pull(model, series, k)
    if not model.has_normal_force:
        return pull
    series.slope[k] = slope(model, series, k) / model.r_0
    known_R = leverage(series.slope, series.normal, k)
    known_T = leverage(series.slope, series.friction, k)
    R, T = stick_forces(series.slope[0], pull, V, known_R, known_T)
    series.normal[k] = R
    series.friction[k] = T
    return T


@inlined
def _release(model, series):
    """Complete both release functions, mu_s press -/+ pull (see `laws.stick_loads`), by the pull,
    which is that of the spring."""
    for k in range(3):
        pull = _pull(model, series, k)
        series.switch[k] -= pull
        series.switch2[k] += pull


@inlined
def _release_on_slope(model, series, order):
    """Fill both release functions under the normal force, from V in P. If only the slope pulls at a
    slider that may leave the disc, they are divided by the common factor V: mu_s -/+ beta."""
    for k in range(order):
        series.slope[k] = slope(model, series, k) / model.r_0
        pull = _pull(model, series, k)
        pull -= leverage(series.slope, series.P, k) + series.slope[0] * series.P[k]
        press = series.P[k]
        for j in range(min(k, 2) + 1):
            press += _pull(model, series, j) * series.slope[k - j]
        series.switch[k] = model.mu_s * press - pull
        series.switch2[k] = model.mu_s * press + pull
    only_slope = _pull(model, series, 0) == 0.0 and _pull(model, series, 1) == 0.0
    if only_slope and not model.bonded:
        for k in range(order):
            series.switch[k] = series.slope[k]
            series.switch2[k] = -series.slope[k]
        series.switch[0] += model.mu_s
        series.switch2[0] += model.mu_s
