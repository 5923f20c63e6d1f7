"""Taylor coefficients in contact beyond the paper: a compliant contact, a force normal to the bent disc, or both.

Compliant: V = (w - u) / compliance follows from the state, so that each order of V is known before its convolutions.
Normal, with beta = B / r_0 and s = sgn(f): in slip the disc feels V = R (1 - s mu_k beta). The in-plane motion is
braked by R (s mu_k + beta). Stick holds while abs(r_0 F - beta V) <= mu_s (V + r_0 F beta). Products of series with
beta are the cost.  Rigid stick moves as under the vertical force.
"""

from .compile import inlined
from .laws import slip_denominator
from .layout import (
    AMPLITUDE_ROW,
    DOWN,
    DRIVE_SERIES,
    DW_DTHETA,
    LOAD_SERIES,
    P_SERIES,
    PSI_SERIES,
    ROWS,
    SLOPE_SERIES,
    SWITCH,
    SWITCH2,
    U_SERIES,
    UP,
    V_SERIES,
    E,
    F,
)
from .series import (
    _CARRIED,
    _axisymmetric,
    _begin_orders,
    _disc_point,
    _e,
    _end_slip,
    _kept,
    _last_force,
    _modal_sum,
    _move_slider,
    _next_order,
    _row,
    _spring,
    _stick_order,
    _z,
    drive,
    lane_count,
    load_at,
)
from .simd import WIDTH, fma, item, mul, total


@inlined
def _deflection(model, s, k):
    """w of order k."""
    w = _modal_sum(model, s, AMPLITUDE_ROW, k)
    for j in range(len(model.mode_amplitude0)):
        w += model.mode_amplitude0[j] * s.y[j * ROWS + k]
    return w


@inlined
def _slope(model, s, k):
    """beta = B / r_0 of order k."""
    return _modal_sum(model, s, DW_DTHETA, k) / model.r_0


@inlined
def _disc_velocity(model, s):
    """Order 0 of the disc's velocity under the slider, without f_0 B."""
    v = _modal_sum(model, s, AMPLITUDE_ROW, E)
    for j in range(len(model.mode_amplitude0)):
        v += model.mode_amplitude0[j] * s.g[j * ROWS]
    return v


@inlined
def _closing(model, s, k, e, carried):
    """Order k of the disc's velocity under the slider from the orders before: without V_{k-1} and f_k."""
    width = lane_count(model)
    lanes = fma(_row(model, AMPLITUDE_ROW, 0), e, mul(_row(model, DW_DTHETA, 0), carried))
    for b in range(WIDTH, width, WIDTH):
        lanes = fma(_row(model, AMPLITUDE_ROW, b), _e(s, width, k * width + b), lanes)
        lanes = fma(_row(model, DW_DTHETA, b), _kept(s, _CARRIED, width, b), lanes)
    v = total(lanes)
    for j in range(len(model.mode_amplitude0)):
        v += item(model.mode_amplitude0, j) * item(s.g, j * ROWS + k)
    return v


@inlined
def _weight(model, s, k):
    """N + k (u - u_0) + c u' of order k."""
    load_k = model.k * s.slider[U_SERIES + k] + model.c * s.slider[V_SERIES + k]
    if model.ramped and k == 1:
        return load_k + s.slider[LOAD_SERIES + 1]
    return load_k + (load_at(model, s) - model.k * model.u_0) if k == 0 else load_k


@inlined
def _leverage(s, k):
    """Order k of beta R without beta_0 R_k, in two sums so that neither waits for the other."""
    odd, even = 0.0, 0.0
    for j in range(1, k, 2):
        odd += s.slider[SLOPE_SERIES + j] * s.slider[P_SERIES + k - j]
        even += s.slider[SLOPE_SERIES + j + 1] * s.slider[P_SERIES + k - j - 1]
    if k % 2 == 1:
        odd += s.slider[SLOPE_SERIES + k] * s.slider[P_SERIES]
    return odd + even


@inlined
def compliant_slip_series(model, s, order, direction):
    """Slip on a compliant contact.  Returns V / R, whose zero is a jammed contact; 1 under the vertical force.

    Fills ``s`` (coefficients 0 are given) up to degree ``order``; ``P`` is R, up to ``order - 1``.
    """
    stiffness, friction = 1.0 / model.compliance, direction * model.mu_k
    lightness, lever = 1.0 / model.m, 1.0 / (model.m * model.r_0)
    f0, ratio, share, beta, V, impulse = s.slider[F], 1.0, 1.0, 0.0, 0.0, 0.0
    w, slope, closing = _deflection(model, s, 0), model.r_0 * _slope(model, s, 0), _disc_velocity(model, s)
    _, pending, _, _, (e, carried, e_last, z_last) = _begin_orders(model, s, f0)
    for k in range(order):
        f = s.slider[F + k]
        V = (w - s.slider[U_SERIES + k]) * stiffness
        # computed before the modes: every order would wait for their sum
        w = (closing + f * slope - impulse * model.inverse_effective_mass) * s.slider[UP + k]
        if model.normal:
            s.slider[SLOPE_SERIES + k] = _slope(model, s, k)
            if k == 0:
                beta = s.slider[SLOPE_SERIES]
                ratio = 1.0 - friction * beta
                share = 1.0 / ratio
            h = _leverage(s, k)
            R = (V + friction * h) * share
            held = (friction + beta) * R + h
        else:
            R, held = V, friction * V
        s.slider[P_SERIES + k] = R
        rate = _spring(model, s, k) * lightness - held * lever
        _move_slider(model, s, k, rate, (V - _weight(model, s, k)) * lightness)
        if k > 0:
            _, _, pending, e, carried, e_last, z_last = _next_order(
                model, s, k, f, f0, impulse, pending, e, carried, e_last, z_last
            )
        closing = _closing(model, s, k + 1, e, carried)
        impulse = V * s.slider[UP + k]
    _end_slip(model, s, order, direction, e, impulse)
    return ratio


@inlined
def compliant_stick_series(model, s, order):
    """Stick on a compliant contact; ``P`` is V.  Fills both release functions."""
    width, stiffness, lightness, impulse = lane_count(model), 1.0 / model.compliance, 1.0 / model.m, 0.0
    for k in range(order + 1):
        s.slider[F + k], s.slider[PSI_SERIES + k + 1] = 0.0, 0.0
    s.slider[PSI_SERIES + 1] = drive(model, s) * model.unit
    if model.ramped:
        s.slider[PSI_SERIES + 2] = s.slider[DRIVE_SERIES + 1] * s.slider[UP + 1]
    for k in range(order):
        V, up = (_deflection(model, s, k) - s.slider[U_SERIES + k]) * stiffness, s.slider[UP + k]
        s.slider[P_SERIES + k] = V
        s.slider[U_SERIES + k + 1] = s.slider[V_SERIES + k] * up
        s.slider[V_SERIES + k + 1] = (V - _weight(model, s, k)) * lightness * up
        for b in range(0, width, WIDTH):
            at = k * width + b
            _stick_order(model, s, b, k, impulse, _e(s, width, at), _z(s, at))
        _axisymmetric(model, s, k, impulse)
        impulse = V * up
    _last_force(model, s, order, impulse)
    s.slider[P_SERIES + order] = 0.0
    release_series(model, s, order)


@inlined
def release_series(model, s, order):
    """Release functions mu_s press -/+ pull of stick from V in ``P``: see ``laws.stick_loads``.

    If only the slope pulls at a slider that may leave the disc, divided by the common factor V: mu_s +/- beta.
    """
    s.slider[SWITCH + order] = s.slider[SWITCH2 + order] = 0.0
    spring, growth, bend = _spring(model, s, 0), model.k_p * s.slider[PSI_SERIES + 1], 0.0
    if model.ramped:
        growth += model.c_p * s.slider[DRIVE_SERIES + 1]
        bend = model.k_p * s.slider[PSI_SERIES + 2]
    for k in range(order):
        press, pull = s.slider[P_SERIES + k], 0.0
        if k < 2:
            pull = model.r_0 * (spring if k == 0 else growth)
        if model.ramped and k == 2:
            pull = model.r_0 * bend
        if model.normal:
            s.slider[SLOPE_SERIES + k] = _slope(model, s, k)
            press += model.r_0 * spring * s.slider[SLOPE_SERIES + k]
            if k > 0:
                press += model.r_0 * growth * s.slider[SLOPE_SERIES + k - 1]
            if model.ramped and k > 1:
                press += model.r_0 * bend * s.slider[SLOPE_SERIES + k - 2]
            pull -= _leverage(s, k) + s.slider[SLOPE_SERIES] * s.slider[P_SERIES + k]
        s.slider[SWITCH + k] = model.mu_s * press - pull
        s.slider[SWITCH2 + k] = model.mu_s * press + pull
    if model.normal and not model.bonded and spring == 0.0 and growth == 0.0:
        for k in range(order):
            s.slider[SWITCH + k], s.slider[SWITCH2 + k] = s.slider[SLOPE_SERIES + k], -s.slider[SLOPE_SERIES + k]
        s.slider[SWITCH] += model.mu_s
        s.slider[SWITCH2] += model.mu_s


@inlined
def normal_slip_series(model, s, order, direction):
    """Slip in rigid contact under the normal force; ``P`` is R.  Returns the denominator of R.

    The recurrence is that of ``series.slip_series``, with h_k, order k of beta R without beta_0 R_k:

        R_k D = (N + k (u - u_0) + c u' + m A + B F)_k + h_k ((1 + m S2) s mu_k - beta_0)
    """
    f0, friction, mobility = s.slider[F], direction * model.mu_k, 1.0 + model.m * model.inverse_effective_mass
    s.slider[U_SERIES], s.slider[V_SERIES], slope = _disc_point(model, s)
    beta = slope / model.r_0
    s.slider[SLOPE_SERIES] = beta
    denominator = slip_denominator(model, model.m, direction, slope)
    inverse, lightness, lever = 1.0 / denominator, 1.0 / model.m, 1.0 / (model.m * model.r_0)

    inertia, pending, by_f, by_f_rate, (e, carried, e_last, z_last) = _begin_orders(model, s, f0)
    h, impulse = 0.0, 0.0
    for k in range(order):
        f = s.slider[F + k]
        if k > 0:
            s.slider[SLOPE_SERIES + k] = _slope(model, s, k)
            h = _leverage(s, k)
            pairs, single, pending, e, carried, e_last, z_last = _next_order(
                model, s, k, f, f0, impulse, pending, e, carried, e_last, z_last
            )
            by_speed = by_f + by_f_rate * s.slider[DOWN + k]
            inertia = total(pairs) + single + f * by_speed + impulse * model.damped_inverse_mass
        spring = _spring(model, s, k)
        top = _weight(model, s, k) + model.m * inertia + slope * spring
        R = (top + h * (mobility * friction - beta)) * inverse
        V = R * (1.0 - friction * beta) - friction * h
        s.slider[P_SERIES + k] = R
        rate = spring * lightness - ((friction + beta) * R + h) * lever
        _move_slider(model, s, k, rate, inertia + rate * slope - model.inverse_effective_mass * V)
        impulse = V * s.slider[UP + k]
    _end_slip(model, s, order, direction, e, impulse)
    return denominator
