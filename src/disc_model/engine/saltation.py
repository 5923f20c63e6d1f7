"""Small changes carried through a switch: the saltation matrix, applied to columns.

At a switch h = 0 the columns turn with the jump of the vector field: with dtau = -dh / h' the change of the switch's
time, J the Jacobian of the jump and v the rates before and after,

    dx(after) = J (dx(before) + v(before) dtau) - v(after) dtau.
"""

from __future__ import annotations

from .compile import helper, inlined, kernel
from .lanes import WIDTH, add, fma, load, mul, splat, store, sub, total
from .layout import (
    DIRECTION,
    HALF,
    PHASE,
    PSI,
    SEPARATION,
    SLIP,
    SPEED,
    STICK,
    U_VELOCITY,
    U,
    give_of,
    is_compliant,
    is_normal,
)
from .switches import (
    AT_REST,
    CONTACT_LOST,
    GAP_CLOSED,
    RELEASE_FORWARD,
    disc_point,
    slip_force,
    spring_force,
    stick_force,
)
from .tangent import (
    D_C,
    D_C_P,
    D_GIVE,
    D_K,
    D_K_P,
    D_M,
    D_OMEGA,
    F_ROW,
    LOAD,
    N_SCALARS,
    PSI_ROW,
    U_ROW,
    V_ROW,
    n_inputs,
    n_rows_of,
    point_change,
    slider_row,
)


@inlined
def _contact_force(model, state):
    """P of the state's phase."""
    phase = state.x[PHASE]
    if phase == SEPARATION:
        return 0.0
    if phase == STICK:
        return stick_force(model, state)
    P, _, _ = slip_force(model, state, state.x[DIRECTION])
    return P


@kernel
def rates(model, state, out):
    """Rates of all rows in the state's phase, into the first lane of ``out`` ([row][8])."""
    width, n0 = len(model.force), len(model.force0)
    x = state.x
    phase, f, P = x[PHASE], x[SPEED], _contact_force(model, state)
    F = spring_force(model, state)
    rate_f = 0.0
    if phase == SLIP:
        resistance = x[DIRECTION] * model.mu_k
        if is_normal(model):
            # P is R; from here on it is V
            _, _, slope = disc_point(model, state)
            force, beta = P, slope / model.r_0
            P = force * (1.0 - resistance * beta)
            rate_f = (F - (resistance + beta) * force / model.r_0) / model.m
        else:
            rate_f = (F - resistance * P / model.r_0) / model.m
    elif phase == SEPARATION:
        rate_f = F / model.m
    for j in range(width):
        other = j + HALF if j % WIDTH < HALF else j - HALF
        out[j * WIDTH] = state.e[j] + model.shift[j] * f * state.z[other]
        rate = model.shift[j] * f * state.e[other] - model.damping[j] * state.e[j] - model.stiffness[j] * state.z[j]
        out[(width + j) * WIDTH] = rate - model.force[j] * P
    for j in range(n0):
        out[(2 * width + j) * WIDTH] = state.g[j]
        rate = -model.damping0[j] * state.g[j] - model.stiffness0[j] * state.y[j]
        out[(2 * width + n0 + j) * WIDTH] = rate - model.force0[j] * P
    out[slider_row(model, PSI_ROW) * WIDTH] = model.Omega - f
    out[slider_row(model, F_ROW) * WIDTH] = rate_f
    u, v, _ = disc_point(model, state)
    if is_compliant(model) or phase == SEPARATION:
        u, v = x[U], x[U_VELOCITY]
    out[slider_row(model, U_ROW) * WIDTH] = v
    out[slider_row(model, V_ROW) * WIDTH] = (P - model.N - model.k * (u - model.u_0) - model.c * v) / model.m


@inlined
def _force_change(model, state, x, at, parameters, q, changes, slipping):
    """Change of the numerator of P at a state: in stick (f = 0), or in slip where P = 0 (lanes)."""
    width, n0 = len(model.force), len(model.force0)
    f = state.x[SPEED] if slipping else 0.0
    u, v, B = disc_point(model, state)
    du, dv, dB = point_change(model, x, at, f, B)
    df = load(x, at + slider_row(model, F_ROW) * WIDTH)
    acceleration = splat(0.0)
    for j in range(width):
        if model.shift[j] > 0.0:
            i, l = j + HALF, model.shift[j]
            z, e = load(x, at + j * WIDTH), load(x, at + (width + j) * WIDTH)
            part = fma(splat(-(model.stiffness[j] + (l * f) ** 2)), z, mul(splat(-model.damping[j]), e))
            part = fma(splat(2.0 * l * f), load(x, at + (width + i) * WIDTH), part)
            part = fma(splat(2.0 * l * state.e[i] - 2.0 * l * l * f * state.z[j]), df, part)
            if changes:
                part = sub(part, mul(splat(state.z[j]), load(parameters, q + (N_SCALARS + j) * WIDTH)))
                part = sub(part, mul(splat(state.e[j]), load(parameters, q + (N_SCALARS + width + j) * WIDTH)))
            acceleration = fma(splat(model.force[j]), part, acceleration)
    for j in range(n0):
        y, g = load(x, at + (2 * width + j) * WIDTH), load(x, at + (2 * width + n0 + j) * WIDTH)
        part = fma(splat(-model.stiffness0[j]), y, mul(splat(-model.damping0[j]), g))
        if changes:
            part = sub(part, mul(splat(state.y[j]), load(parameters, q + (N_SCALARS + 2 * width + j) * WIDTH)))
            part = sub(part, mul(splat(state.g[j]), load(parameters, q + (N_SCALARS + 2 * width + n0 + j) * WIDTH)))
        acceleration = fma(splat(model.force0[j]), part, acceleration)
    change = fma(splat(model.m), acceleration, fma(splat(model.k), du, mul(splat(model.c), dv)))
    if changes:
        change = add(change, load(parameters, q + LOAD * WIDTH))
        change = fma(splat(u), load(parameters, q + D_K * WIDTH), change)
        change = fma(splat(v), load(parameters, q + D_C * WIDTH), change)
    if slipping:
        change = fma(splat(spring_force(model, state)), dB, change)
        change = fma(splat(B), _pull_change(model, state, x, at, parameters, q, changes), change)
    return change


@inlined
def _pull_change(model, state, x, at, parameters, q, changes):
    """Change of F at a state (lanes)."""
    dpsi, df = load(x, at + slider_row(model, PSI_ROW) * WIDTH), load(x, at + slider_row(model, F_ROW) * WIDTH)
    change = fma(splat(model.k_p), dpsi, mul(splat(-model.c_p), df))
    if changes:
        change = fma(splat(state.x[PSI]), load(parameters, q + D_K_P * WIDTH), change)
        change = fma(splat(model.Omega - state.x[SPEED]), load(parameters, q + D_C_P * WIDTH), change)
        change = fma(splat(model.c_p), load(parameters, q + D_OMEGA * WIDTH), change)
    return change


@inlined
def _inertia(model, state, slipping):
    """u'' without P and f' (needed where the mass changes)."""
    f = state.x[SPEED] if slipping else 0.0
    acceleration = 0.0
    for j in range(len(model.force)):
        part = -model.damping[j] * state.e[j] - (model.stiffness[j] + (model.shift[j] * f) ** 2) * state.z[j]
        acceleration += model.force[j] * part + 2.0 * f * model.slope[j] * state.e[j]
    for j in range(len(model.force0)):
        acceleration -= model.force0[j] * (model.damping0[j] * state.g[j] + model.stiffness0[j] * state.y[j])
    return acceleration


@inlined
def _release_change(model, state, cause, x, at, parameters, q, changes, V_change):
    """Change of the release function mu_s press -/+ pull: see ``switches.grip``."""
    side = 1.0 if cause == RELEASE_FORWARD else -1.0
    pull = _pull_change(model, state, x, at, parameters, q, changes)
    if not is_normal(model):
        return fma(splat(-side * model.r_0), pull, mul(splat(model.mu_s), V_change))
    V, F = stick_force(model, state), spring_force(model, state)
    _, _, B = disc_point(model, state)
    _, _, dB = point_change(model, x, at, 0.0, 0.0)
    press = fma(splat(F), dB, fma(splat(B), pull, V_change))
    held = mul(splat(1.0 / model.r_0), fma(splat(V), dB, mul(splat(B), V_change)))
    return fma(splat(-side), sub(mul(splat(model.r_0), pull), held), mul(splat(model.mu_s), press))


@inlined
def _compliant_switch_change(model, state, cause, x, at, parameters, q, changes):
    """``switch_change`` where V = (w - u) / give is one of the state; contact is lost where w - u vanishes."""
    dw, _, _ = point_change(model, x, at, 0.0, 0.0)
    closer = sub(dw, load(x, at + slider_row(model, U_ROW) * WIDTH))
    if cause == CONTACT_LOST:
        return closer
    V = mul(splat(1.0 / give_of(model.give)), closer)
    if changes:
        V = sub(V, mul(splat(stick_force(model, state)), load(parameters, q + D_GIVE * WIDTH)))
    return _release_change(model, state, cause, x, at, parameters, q, changes, V)


@inlined
def switch_change(model, state, cause, x, at, parameters, q, changes):
    """Change of the switch function of ``cause`` at a state, for a block of columns (lanes)."""
    if cause == AT_REST:
        return load(x, at + slider_row(model, F_ROW) * WIDTH)
    if cause == GAP_CLOSED:
        du, _, _ = point_change(model, x, at, 0.0, 0.0)
        return sub(load(x, at + slider_row(model, U_ROW) * WIDTH), du)
    if is_compliant(model):
        return _compliant_switch_change(model, state, cause, x, at, parameters, q, changes)
    slipping = cause == CONTACT_LOST and state.x[PHASE] == SLIP
    change = _force_change(model, state, x, at, parameters, q, changes, slipping)
    if changes:
        # (1 + m S2) P = ... + m A: what the mass itself changes
        P = 0.0 if cause == CONTACT_LOST else stick_force(model, state)
        inertia = _inertia(model, state, slipping) - P * model.compliance
        change = fma(splat(inertia), load(parameters, q + D_M * WIDTH), change)
    if cause == CONTACT_LOST:
        return change
    if is_normal(model):
        change = mul(splat(1.0 / (1.0 + model.m * model.compliance)), change)
        return _release_change(model, state, cause, x, at, parameters, q, changes, change)
    side = 1.0 if cause == RELEASE_FORWARD else -1.0
    change = mul(splat(model.mu_s / (1.0 + model.m * model.compliance)), change)
    return fma(splat(-side * model.r_0), _pull_change(model, state, x, at, parameters, q, changes), change)


@helper
def switch_times(model, state, t, cause):
    """``t.tau``: change of the time of the switch ``cause`` for every column.  Returns the switch function's rate."""
    C = t.columns
    # the other lanes of ``before`` are zero
    rate = total(switch_change(model, state, cause, t.before, 0, t.still, 0, False))
    for c in range(0, C, WIDTH):
        at, q = c * n_rows_of(model), c * n_inputs(model)
        change = switch_change(model, state, cause, t.now, at, t.parameters, q, c >= t.plain)
        store(t.tau, c, mul(splat(-1.0 / rate), change))
    return rate


@helper
def shift(model, t, rates_at, sign):
    """t.now += sign * rates * tau."""
    C = t.columns
    R = n_rows_of(model)
    for c in range(0, C, WIDTH):
        tau = load(t.tau, c)
        for r in range(R):
            at = c * R + r * WIDTH
            store(t.now, at, fma(splat(sign * rates_at[r * WIDTH]), tau, load(t.now, at)))


@helper
def impact_change(model, state, t):
    """Jacobian of the plastic impact, applied to the columns; ``state`` is the one before.

    Under the normal force the impulse p also takes p B / (m r_0^2) from f.
    """
    C, width, n0 = t.columns, len(model.force), len(model.force0)
    _, v, B = disc_point(model, state)
    lever = 1.0 / (model.m * model.r_0**2) if is_normal(model) else 0.0
    share = 1.0 / (model.compliance + 1.0 / model.m + lever * B**2)
    p = (v - state.x[U_VELOCITY]) * share
    for c in range(0, C, WIDTH):
        block = c * n_rows_of(model)
        _, dv, dB = point_change(model, t.now, block, state.x[SPEED], B)
        change = sub(dv, load(t.now, block + slider_row(model, V_ROW) * WIDTH))
        if c >= t.plain:
            # 1 / m: -dm / m^2
            dm = load(t.parameters, c * n_inputs(model) + D_M * WIDTH)
            mass = p / model.m**2
            if is_normal(model):
                mass *= 1.0 + (B / model.r_0) ** 2
            change = fma(splat(mass), dm, change)
        if is_normal(model):
            change = sub(change, mul(splat(2.0 * p * lever * B), dB))
        dp = mul(splat(share), change)
        if is_normal(model):
            f = block + slider_row(model, F_ROW) * WIDTH
            stopped = mul(splat(lever), fma(splat(B), dp, mul(splat(p), dB)))
            if c >= t.plain:
                stopped = sub(stopped, mul(splat(p * lever * B / model.m), dm))
            store(t.now, f, sub(load(t.now, f), stopped))
        for j in range(width):
            at = block + (width + j) * WIDTH
            store(t.now, at, sub(load(t.now, at), mul(splat(model.force[j]), dp)))
        for j in range(n0):
            at = block + (2 * width + n0 + j) * WIDTH
            store(t.now, at, sub(load(t.now, at), mul(splat(model.force0[j]), dp)))


@helper
def slider_rows(model, state, t):
    """Rows u, u' as the disc's: rigid contact."""
    if is_compliant(model):
        return
    C = t.columns
    _, _, B = disc_point(model, state)
    for c in range(0, C, WIDTH):
        block = c * n_rows_of(model)
        du, dv, _ = point_change(model, t.now, block, state.x[SPEED], B)
        store(t.now, block + slider_row(model, U_ROW) * WIDTH, du)
        store(t.now, block + slider_row(model, V_ROW) * WIDTH, dv)


@helper
def rest(model, t):
    """df = 0 in stick, exactly."""
    C = t.columns
    for c in range(0, C, WIDTH):
        store(t.now, c * n_rows_of(model) + slider_row(model, F_ROW) * WIDTH, splat(0.0))
