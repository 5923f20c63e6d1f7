"""Tangent propagation: how small changes of state and parameters travel along a motion and through its switches.

A change of the state is a column; the columns lie side by side in blocks of eight lanes, so that one pass of the
recurrence moves eight of them.  The Taylor coefficients of the variational equations are those of the model with
each product f x replaced by f dx + df x, the coefficients of the motion itself being known; the contact force of
order k then follows from the same scalar division as that of the motion.

At a switch h = 0 the columns turn with the jump of the vector field: with dtau = -dh / h' the change of the switch's
time, J the Jacobian of the jump and v the rates before and after,

    dx(after) = J (dx(before) + v(before) dtau) - v(after) dtau.

Rows of a column: displacements z and velocities e of all lanes, then y, g of the axisymmetric modes, then psi, f, and
u, u' of the slider (which are the disc's in contact, and mean something in separation only).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .compile import inlined, kernel
from .evaluate import state_at
from .lanes import WIDTH, add, fma, load, mul, splat, spread, store, sub, total
from .layout import (
    DIRECTION,
    HALF,
    KNOWN,
    PHASE,
    PSI,
    SEPARATION,
    SLIP,
    SPEED,
    STICK,
    TIME,
    U_VELOCITY,
    Model,
    U,
    aligned,
)
from .machine import (
    _AT_REST,
    _CONTACT_LOST,
    _GAP_CLOSED,
    _NOTHING,
    _RELEASE_FORWARD,
    _advance_time,
    _expand,
    _first_switch,
    step_size,
)
from .switches import (
    PAINLEVE_MARGIN,
    PARADOX,
    come_to_rest,
    disc_point,
    leave_rest,
    lose_contact,
    slip_force,
    spring_force,
    stick_force,
    touch_down,
)

# How a flight ended.
RETURNED, TIME_OVER, NO_SOLUTION, STALLED, NON_FINITE, LOST_CONTACT, OFF_SECTION = range(7)

# What a flight counts, entries of ``Tangent.log``.
DURATION, STICK_TIME, SLIP_TIME, SEPARATION_TIME, RELEASES, BACK_RELEASES, REVERSALS, SEPARATIONS, STICKS, N_STEPS = (
    range(10)
)
LOG_SIZE = 16
DIVERGENCE = 10  # integral of the trace of the Jacobian

# Rows of the parameters' changes that a column carries; after them stiffness and damping of all lanes and of the
# axisymmetric modes.
LOAD, D_K, D_C, D_M, D_K_P, D_C_P, D_OMEGA, N_SCALARS = range(8)


class Tangent(NamedTuple):
    """Columns and their work space.  ``columns`` is a multiple of eight."""

    series: np.ndarray  # [block][order][row][8]
    force: np.ndarray  # [block][order][8] of P
    slope: np.ndarray  # [block][order][8] of B
    base_slope: np.ndarray  # [order], B of the motion
    now: np.ndarray  # [block][row][8]
    parameters: np.ndarray  # [block][row][8], changes of parameters
    before: np.ndarray  # [row][8], rates before a switch in the first lane
    after: np.ndarray
    still: np.ndarray  # like ``parameters``, zero, eight columns
    tau: np.ndarray  # [column], change of a switch's time
    log: np.ndarray
    columns: int
    plain: int  # columns before this one carry no change of a parameter


def longest_step(order: int, tolerance: float) -> float:
    """Step (time units) at which the last term of an oscillation at the fastest rate falls below ``tolerance``."""
    return math.exp((math.log(tolerance) + math.lgamma(order + 1)) / order)


def n_rows(model: Model) -> int:
    """Number of rows of a column."""
    return 2 * len(model.force) + 2 * len(model.force0) + 4


def build_tangent(model: Model, columns: int, order: int, plain: int | None = None) -> Tangent:
    """Work space for ``columns`` columns; the first ``plain`` (all by default) carry no changes of parameters."""
    columns = WIDTH * -(-columns // WIDTH)
    plain = columns if plain is None else WIDTH * (plain // WIDTH)
    rows, parameters = n_rows(model), N_SCALARS + 2 * len(model.force) + 2 * len(model.force0)
    return Tangent(
        series=aligned((order + 2) * rows * columns),
        force=aligned((order + 2) * columns),
        slope=aligned((order + 2) * columns),
        base_slope=aligned(order + 2),
        now=aligned(rows * columns),
        parameters=aligned(parameters * columns),
        before=aligned(rows * WIDTH),
        after=aligned(rows * WIDTH),
        still=aligned(parameters * WIDTH),
        tau=aligned(columns),
        log=np.zeros(LOG_SIZE),
        columns=columns,
        plain=plain,
    )


@inlined
def _convolve(s, t, origin, R, k, j, width, f_row):
    """Order k of f dx + df x for a, b, alpha, beta of the pair whose a is lane j."""
    zero = splat(0.0)
    a0, b0, p0, q0, a1, b1, p1, q1 = zero, zero, zero, zero, zero, zero, zero, zero
    a, b = origin + (k * R + j) * WIDTH, origin + (k * R + j + HALF) * WIDTH
    p, q = a + width * WIDTH, b + width * WIDTH
    at, low, stride = origin + f_row * WIDTH, k * width + j, R * WIDTH
    for i in range(k + 1):
        f, df = spread(s.f, i), load(t.series, at)
        a0, b0 = fma(f, load(t.series, a), a0), fma(f, load(t.series, b), b0)
        p0, q0 = fma(f, load(t.series, p), p0), fma(f, load(t.series, q), q0)
        a1, b1 = fma(df, spread(s.z, low), a1), fma(df, spread(s.z, low + HALF), b1)
        p1, q1 = fma(df, spread(s.e, low), p1), fma(df, spread(s.e, low + HALF), q1)
        a, b, p, q, at, low = a - stride, b - stride, p - stride, q - stride, at + stride, low - width
    return add(a0, a1), add(b0, b1), add(p0, p1), add(q0, q1)


@inlined
def _motion_slope(model, s, t, order):
    """B of the motion, all orders."""
    width = len(model.force)
    for k in range(order + 1):
        slope = 0.0
        for j in range(width):
            slope += model.slope[j] * s.z[k * width + j]
        t.base_slope[k] = slope


@inlined
def _point_change(model, x, at, f, B):
    """du, d(u'), dB of the disc under the slider from columns x; f, B of the motion."""
    width, n0 = len(model.force), len(model.force0)
    zero = splat(0.0)
    du, dv, dB = zero, zero, zero
    for j in range(width):
        if model.shift[j] > 0.0:
            force = splat(model.force[j])
            du = fma(force, load(x, at + j * WIDTH), du)
            dv = fma(force, load(x, at + (width + j) * WIDTH), dv)
            dB = fma(splat(model.slope[j + HALF]), load(x, at + (j + HALF) * WIDTH), dB)
    for j in range(n0):
        force = splat(model.force0[j])
        du = fma(force, load(x, at + (2 * width + j) * WIDTH), du)
        dv = fma(force, load(x, at + (2 * width + n0 + j) * WIDTH), dv)
    df = load(x, at + (2 * width + 2 * n0 + 1) * WIDTH)
    return du, fma(splat(f), dB, fma(splat(B), df, dv)), dB


@kernel
def tangent_series(model, s, t, order, phase, direction):
    """Taylor coefficients of all columns along the step whose series is ``s``, from ``t.now``."""
    width, n0, C, R = len(model.force), len(model.force0), t.columns, n_rows_of(model)
    orders, inputs = len(t.base_slope), n_inputs(model)
    psi_row, f_row = 2 * width + 2 * n0, 2 * width + 2 * n0 + 1
    _motion_slope(model, s, t, order)
    B0 = t.base_slope[0]
    friction = direction * model.mu_k / model.r_0 if phase == SLIP else 0.0
    inverse = 1.0 / (1.0 + model.m * model.compliance + friction * B0)
    lightness, zero = splat(1.0 / model.m), splat(0.0)
    for block in range(C // WIDTH):
        changes = block * WIDTH >= t.plain
        at, q, chain, origin = (
            block * R * WIDTH,
            block * inputs * WIDTH,
            block * orders * WIDTH,
            block * orders * R * WIDTH,
        )
        for i in range(0, R * WIDTH, WIDTH):
            store(t.series, origin + i, load(t.now, at + i))
        du, dv, dB = _point_change(model, t.now, at, s.f[0], B0)
        if phase == SEPARATION:
            du, dv = load(t.now, at + (psi_row + 2) * WIDTH), load(t.now, at + (psi_row + 3) * WIDTH)
        store(t.slope, chain, dB)
        for k in range(order):
            up, down = splat(s.up[k]), splat(s.down[k])
            here, there = origin + k * R * WIDTH, origin + (k + 1) * R * WIDTH
            free, dB = zero, zero
            for j in range(width):
                if model.shift[j] > 0.0:
                    i = j + HALF
                    da, db = load(t.series, here + j * WIDTH), load(t.series, here + i * WIDTH)
                    dp, dq = load(t.series, here + (width + j) * WIDTH), load(t.series, here + (width + i) * WIDTH)
                    stiffness, damping = splat(-model.stiffness[j]), splat(-model.damping[j])
                    rate_p, rate_q = fma(stiffness, da, mul(damping, dp)), fma(stiffness, db, mul(damping, dq))
                    if phase != STICK:
                        l = splat(model.shift[j])
                        fa, fb, fp, fq = _convolve(s, t, origin, R, k, j, width, f_row)
                        dp, dq = fma(l, fb, dp), sub(dq, mul(l, fa))
                        rate_p, rate_q = fma(l, fq, rate_p), sub(rate_q, mul(l, fp))
                    if changes:
                        d_stiffness = load(t.parameters, q + (N_SCALARS + j) * WIDTH)
                        d_damping = load(t.parameters, q + (N_SCALARS + width + j) * WIDTH)
                        z, e = k * width + j, k * width + j
                        rate_p = sub(rate_p, fma(d_stiffness, splat(s.z[z]), mul(d_damping, splat(s.e[e]))))
                        rate_q = sub(
                            rate_q, fma(d_stiffness, splat(s.z[z + HALF]), mul(d_damping, splat(s.e[e + HALF])))
                        )
                    db_next = mul(dq, up)
                    store(t.series, there + j * WIDTH, mul(dp, up))
                    store(t.series, there + i * WIDTH, db_next)
                    store(t.series, there + (width + j) * WIDTH, rate_p)
                    store(t.series, there + (width + i) * WIDTH, mul(rate_q, up))
                    free = fma(splat(model.force[j]), rate_p, free)
                    dB = fma(splat(model.slope[i]), db_next, dB)
            for j in range(n0):
                y, g = 2 * width + j, 2 * width + n0 + j
                dy, dg = load(t.series, here + y * WIDTH), load(t.series, here + g * WIDTH)
                rate = fma(splat(-model.stiffness0[j]), dy, mul(splat(-model.damping0[j]), dg))
                if changes:
                    d_stiffness = load(t.parameters, q + (N_SCALARS + 2 * width + j) * WIDTH)
                    d_damping = load(t.parameters, q + (N_SCALARS + 2 * width + n0 + j) * WIDTH)
                    rate = sub(rate, fma(d_stiffness, splat(s.y[k * n0 + j]), mul(d_damping, splat(s.g[k * n0 + j]))))
                store(t.series, there + y * WIDTH, mul(dg, up))
                store(t.series, there + g * WIDTH, rate)
                free = fma(splat(model.force0[j]), rate, free)
            store(t.slope, chain + (k + 1) * WIDTH, dB)
            dpsi, df = load(t.series, here + psi_row * WIDTH), load(t.series, here + f_row * WIDTH)
            pull = sub(mul(splat(model.k_p), dpsi), mul(splat(model.c_p), df))
            vertical = fma(splat(model.k), du, mul(splat(model.c), dv))
            turn = sub(zero, df)
            if changes:
                d_m, d_omega = load(t.parameters, q + D_M * WIDTH), load(t.parameters, q + D_OMEGA * WIDTH)
                d_c_p = load(t.parameters, q + D_C_P * WIDTH)
                pull = fma(load(t.parameters, q + D_K_P * WIDTH), splat(s.psi[k]), pull)
                pull = sub(pull, mul(d_c_p, splat(s.f[k])))
                pull = sub(pull, mul(d_m, splat(s.f[k + 1] * s.down[k])))
                vertical = fma(load(t.parameters, q + D_K * WIDTH), splat(s.u[k]), vertical)
                vertical = fma(load(t.parameters, q + D_C * WIDTH), splat(s.v[k]), vertical)
                vertical = fma(d_m, splat(s.v[k + 1] * s.down[k]), vertical)
                if k == 0:
                    pull = fma(splat(model.c_p), d_omega, fma(d_c_p, splat(model.Omega), pull))
                    vertical = add(vertical, load(t.parameters, q + LOAD * WIDTH))
                    turn = add(turn, d_omega)
            P, acceleration, rate_f = zero, zero, zero
            if phase == SEPARATION:
                rate_f = mul(pull, lightness)
                acceleration = sub(zero, mul(vertical, lightness))
            else:
                if phase == SLIP:
                    carried = mul(splat(s.f[k + 1]), load(t.slope, chain))
                    for i in range(k + 1):
                        carried = fma(splat(s.f[i]), load(t.slope, chain + (k + 1 - i) * WIDTH), carried)
                        carried = fma(
                            splat(t.base_slope[k + 1 - i]), load(t.series, origin + (i * R + f_row) * WIDTH), carried
                        )
                    free = fma(down, carried, free)
                    vertical = fma(splat(B0), pull, vertical)
                P = mul(splat(inverse), fma(splat(model.m), free, vertical))
                acceleration = sub(free, mul(splat(model.compliance), P))
                if phase == SLIP:
                    rate_f = mul(lightness, sub(pull, mul(splat(friction), P)))
                    acceleration = fma(splat(B0), rate_f, acceleration)
            store(t.force, chain + k * WIDTH, P)
            for j in range(width):
                if model.shift[j] > 0.0:
                    e = there + (width + j) * WIDTH
                    store(t.series, e, mul(up, sub(load(t.series, e), mul(splat(model.force[j]), P))))
            for j in range(n0):
                g = there + (2 * width + n0 + j) * WIDTH
                store(t.series, g, mul(up, sub(load(t.series, g), mul(splat(model.force0[j]), P))))
            store(t.series, there + psi_row * WIDTH, mul(turn, up))
            store(t.series, there + f_row * WIDTH, mul(rate_f, up))
            du, dv = mul(dv, up), mul(acceleration, up)
            store(t.series, there + (psi_row + 2) * WIDTH, du)
            store(t.series, there + (psi_row + 3) * WIDTH, dv)


@inlined
def n_rows_of(model):
    """As ``n_rows``, inside kernels."""
    return 2 * len(model.force) + 2 * len(model.force0) + 4


@inlined
def n_inputs(model):
    """Number of rows of ``Tangent.parameters``."""
    return N_SCALARS + 2 * len(model.force) + 2 * len(model.force0)


@kernel
def tangent_at(model, t, order, x):
    """``t.now`` at x (time units) of the step."""
    size, at = n_rows_of(model) * WIDTH, splat(x)
    for block in range(t.columns // WIDTH):
        origin, now = block * len(t.base_slope) * size, block * size
        for i in range(0, size, WIDTH):
            j = origin + order * size + i
            value = load(t.series, j)
            for _ in range(order):
                j -= size
                value = fma(value, at, load(t.series, j))
            store(t.now, now + i, value)


@inlined
def _contact_force(model, state):
    """P of the state's phase."""
    phase = state.x[PHASE]
    if phase == SEPARATION:
        return 0.0
    if phase == STICK:
        return stick_force(model, state)
    P, _ = slip_force(model, state, state.x[DIRECTION])
    return P


@kernel
def rates(model, state, out):
    """Rates of all rows in the state's phase, into the first lane of ``out`` ([row][8])."""
    width, n0 = len(model.force), len(model.force0)
    x = state.x
    phase, f, P = x[PHASE], x[SPEED], _contact_force(model, state)
    F = spring_force(model, state)
    row = 2 * width + 2 * n0
    rate_f = 0.0
    if phase == SLIP:
        rate_f = (F - x[DIRECTION] * model.mu_k * P / model.r_0) / model.m
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
    out[row * WIDTH] = model.Omega - f
    out[(row + 1) * WIDTH] = rate_f
    u, v, _ = disc_point(model, state)
    if phase == SEPARATION:
        u, v = x[U], x[U_VELOCITY]
    out[(row + 2) * WIDTH] = v
    out[(row + 3) * WIDTH] = (P - model.N - model.k * (u - model.u_0) - model.c * v) / model.m


@inlined
def _force_change(model, state, x, at, parameters, q, changes, slipping):
    """Change of the numerator of P at a state: in stick (f = 0), or in slip where P = 0 (lanes)."""
    width, n0 = len(model.force), len(model.force0)
    f = state.x[SPEED] if slipping else 0.0
    u, v, B = disc_point(model, state)
    du, dv, dB = _point_change(model, x, at, f, B)
    df = load(x, at + (2 * width + 2 * n0 + 1) * WIDTH)
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
    row = 2 * len(model.force) + 2 * len(model.force0)
    change = fma(splat(model.k_p), load(x, at + row * WIDTH), mul(splat(-model.c_p), load(x, at + (row + 1) * WIDTH)))
    if changes:
        change = fma(splat(state.x[PSI]), load(parameters, q + D_K_P * WIDTH), change)
        change = fma(splat(model.Omega - state.x[SPEED]), load(parameters, q + D_C_P * WIDTH), change)
        change = fma(splat(model.c_p), load(parameters, q + D_OMEGA * WIDTH), change)
    return change


@inlined
def _inertia(model, state, slipping):
    """u'' without P and f', and P in stick (needed where the mass changes)."""
    f = state.x[SPEED] if slipping else 0.0
    acceleration = 0.0
    for j in range(len(model.force)):
        part = -model.damping[j] * state.e[j] - (model.stiffness[j] + (model.shift[j] * f) ** 2) * state.z[j]
        acceleration += model.force[j] * part + 2.0 * f * model.slope[j] * state.e[j]
    for j in range(len(model.force0)):
        acceleration -= model.force0[j] * (model.damping0[j] * state.g[j] + model.stiffness0[j] * state.y[j])
    return acceleration


@inlined
def switch_change(model, state, cause, x, at, parameters, q, changes):
    """Change of the switch function of ``cause`` at a state, for a block of columns (lanes)."""
    row = 2 * len(model.force) + 2 * len(model.force0)
    if cause == _AT_REST:
        return load(x, at + (row + 1) * WIDTH)
    if cause == _GAP_CLOSED:
        du, _, _ = _point_change(model, x, at, 0.0, 0.0)
        return sub(load(x, at + (row + 2) * WIDTH), du)
    slipping = cause == _CONTACT_LOST and state.x[PHASE] == SLIP
    change = _force_change(model, state, x, at, parameters, q, changes, slipping)
    if changes:
        # (1 + m S2) P = ... + m A: what the mass itself changes
        P = 0.0 if cause == _CONTACT_LOST else stick_force(model, state)
        inertia = _inertia(model, state, slipping) - P * model.compliance
        change = fma(splat(inertia), load(parameters, q + D_M * WIDTH), change)
    if cause == _CONTACT_LOST:
        return change
    side = 1.0 if cause == _RELEASE_FORWARD else -1.0
    change = mul(splat(model.mu_s / (1.0 + model.m * model.compliance)), change)
    return fma(splat(-side * model.r_0), _pull_change(model, state, x, at, parameters, q, changes), change)


@kernel
def _switch_times(model, state, t, cause):
    """``t.tau``: change of the time of the switch ``cause`` for every column.  Returns the switch function's rate."""
    C = t.columns
    # the other lanes of ``before`` are zero
    rate = total(switch_change(model, state, cause, t.before, 0, t.still, 0, False))
    for c in range(0, C, WIDTH):
        at, q = c * n_rows_of(model), c * n_inputs(model)
        change = switch_change(model, state, cause, t.now, at, t.parameters, q, c >= t.plain)
        store(t.tau, c, mul(splat(-1.0 / rate), change))
    return rate


@kernel
def _shift(model, t, rates_at, sign):
    """t.now += sign * rates * tau."""
    C = t.columns
    R = n_rows_of(model)
    for c in range(0, C, WIDTH):
        tau = load(t.tau, c)
        for r in range(R):
            at = c * R + r * WIDTH
            store(t.now, at, fma(splat(sign * rates_at[r * WIDTH]), tau, load(t.now, at)))


@kernel
def _impact_change(model, state, t):
    """Jacobian of the plastic impact, applied to the columns; ``state`` is the one before."""
    C, width, n0 = t.columns, len(model.force), len(model.force0)
    row = 2 * width + 2 * n0
    _, v, B = disc_point(model, state)
    share = 1.0 / (model.compliance + 1.0 / model.m)
    p = (v - state.x[U_VELOCITY]) * share
    for c in range(0, C, WIDTH):
        block = c * n_rows_of(model)
        _, dv, _ = _point_change(model, t.now, block, state.x[SPEED], B)
        change = sub(dv, load(t.now, block + (row + 3) * WIDTH))
        if c >= t.plain:
            # 1 / m: -dm / m^2
            change = fma(splat(p / model.m**2), load(t.parameters, c * n_inputs(model) + D_M * WIDTH), change)
        dp = mul(splat(share), change)
        for j in range(width):
            at = block + (width + j) * WIDTH
            store(t.now, at, sub(load(t.now, at), mul(splat(model.force[j]), dp)))
        for j in range(n0):
            at = block + (2 * width + n0 + j) * WIDTH
            store(t.now, at, sub(load(t.now, at), mul(splat(model.force0[j]), dp)))


@kernel
def _slider_rows(model, state, t):
    """Rows u, u' as the disc's: contact."""
    C = t.columns
    row = 2 * len(model.force) + 2 * len(model.force0)
    _, _, B = disc_point(model, state)
    for c in range(0, C, WIDTH):
        block = c * n_rows_of(model)
        du, dv, _ = _point_change(model, t.now, block, state.x[SPEED], B)
        store(t.now, block + (row + 2) * WIDTH, du)
        store(t.now, block + (row + 3) * WIDTH, dv)


@kernel
def _step(model, s, state, order, tolerance, left):
    """Expand and find the first switch within ``left`` time units: (length, cause); nan or -1 is failure."""
    if _expand(model, s, state, order) <= PAINLEVE_MARGIN:
        return -1.0, _NOTHING
    x_end = step_size(model, s, order, tolerance, state.x[PHASE])
    if not x_end > 0.0:
        return np.nan, _NOTHING
    return _first_switch(model, s, state, order, min(x_end, left))


@kernel
def _change_phase(model, state, cause, log):
    """Carry out a switch.  Returns its outcome."""
    if cause == _GAP_CLOSED:
        outcome = touch_down(model, state)
    elif cause == _AT_REST:
        outcome = come_to_rest(model, state)
        if state.x[PHASE] == SLIP:
            log[REVERSALS] += 1.0
    elif cause == _CONTACT_LOST:
        outcome = lose_contact(model, state)
    else:
        outcome = leave_rest(model, state, 1.0 if cause == _RELEASE_FORWARD else -1.0)
        log[RELEASES if cause == _RELEASE_FORWARD else BACK_RELEASES] += 1.0
    if state.x[PHASE] == SEPARATION:
        log[SEPARATIONS] += 1.0
    elif state.x[PHASE] == STICK:
        log[STICKS] += 1.0
    return outcome


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
def _rest(model, t):
    """df = 0 in stick, exactly."""
    C = t.columns
    row = 2 * len(model.force) + 2 * len(model.force0) + 1
    for c in range(0, C, WIDTH):
        block = c * n_rows_of(model)
        store(t.now, block + row * WIDTH, splat(0.0))


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
        _advance_time(x, x_end * model.unit)
        log[DURATION] += x_end * model.unit
        log[STICK_TIME + int(phase)] += x_end * model.unit
        log[N_STEPS] += 1.0
        if cause == _NOTHING:
            x[KNOWN] = 0.0
            if x_end >= left:
                return TIME_OVER
            continue
        in_a_row = in_a_row + 1 if x[TIME] == before else 0
        if in_a_row > 200:
            return STALLED
        last = False
        if cause == _RELEASE_FORWARD:
            found += 1
            last = found == releases
        if cause == _AT_REST:
            x[SPEED] = 0.0
        if tangent:
            rates(model, state, t.before)
            _switch_times(model, state, t, cause)
            _shift(model, t, t.before, 1.0)
            if cause == _GAP_CLOSED:
                _impact_change(model, state, t)
        if last:
            log[RELEASES] += 1.0
            return RETURNED
        x[KNOWN] = 0.0
        if _change_phase(model, state, cause, log) == PARADOX:
            return NO_SOLUTION
        if tangent:
            if x[PHASE] == SEPARATION and cause != _GAP_CLOSED:
                _slider_rows(model, state, t)
            rates(model, state, t.after)
            _shift(model, t, t.after, -1.0)
            if x[PHASE] != SEPARATION:
                _slider_rows(model, state, t)
            if x[PHASE] == STICK:
                _rest(model, t)
        if x[PHASE] == SEPARATION and not may_separate:
            return LOST_CONTACT


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
            change = switch_change(model, state, _RELEASE_FORWARD, t.now, at, t.parameters, q, c >= t.plain)
            store(t.now, at + row * WIDTH, mul(splat(1.0 / (model.r_0 * model.k_p)), change))
    if _change_phase(model, state, _RELEASE_FORWARD, t.log) == PARADOX:
        return NO_SOLUTION
    t.log[RELEASES] = 0.0
    if state.x[PHASE] == SEPARATION and not may_separate:
        return LOST_CONTACT
    if tangent:
        _slider_rows(model, state, t)
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
