"""Small changes along a motion: Taylor series of the variational equations, and the jumps at
events.

A change of the state is a column; columns are stored side by side in blocks of eight lanes, and one
pass of the recurrence advances eight.  It is the model's, with each product f x replaced by f dx +
df x. The contact force of order k follows from the same division as for the motion, or from the
state on a compliant contact.

Rows of a column: displacements z and velocities e of all lanes, then y, g of the axisymmetric
modes, then psi, f, and u, u' of the slider. In rigid contact u, u' are the disc's and have a
meaning in separation only.

At an event h = 0 the columns change with the jump of the vector field (the saltation matrix). With
dtau = -dh / h' the change of the event's time, J the Jacobian of the jump and v the rates before
and after,

    dx(after) = J (dx(before) + v(before) dtau) - v(after) dtau.
"""

import math
from typing import NamedTuple

import numpy as np

from . import laws, series, transitions
from .dense_output import state_at
from .jit import helper, inlined, kernel
from .jit.packing import packed
from .jit.simd import WIDTH, add, aligned, fma, load, mul, splat, spread, store, sub, total
from .laws import N_ENTRIES, friction_coefficient, slip_denominator
from .layout import (
    DIRECTION,
    HALF,
    PHASE,
    PSI,
    ROWS,
    SEPARATION,
    SLIDER,
    SLIP,
    STICK,
    U_VELOCITY,
    F,
    Model,
    U,
)
from .transitions import (
    CONSISTENT,
    NO_SOLUTION,
    RETURNED,
    change_phase,
    disc_point,
    event_function,
    instant,
)

# Entries of ``Tangent.log``: times in all and by phase (s), events, steps.
DURATION, STICK_TIME, SLIP_TIME, SEPARATION_TIME = range(4)
RELEASES, BACK_RELEASES, REVERSALS, SEPARATIONS, STICKS, N_STEPS = range(4, 10)
# Rows of the parameters' changes that a column carries, in the order of an `Instant` (LOAD: of N -
# k u_0; D_COMPLIANCE: relative); after them stiffness and damping of all lanes and of the
# axisymmetric modes.
LOAD, D_K, D_C, D_M, D_K_P, D_C_P, D_OMEGA, D_COMPLIANCE, N_SCALARS = range(9)
PASSED = 1e-9  # radians of the fastest motion by which a root was passed before the phase began; less is rounding


@packed
class Tangent(NamedTuple):
    """Columns and their work space.  ``columns`` is a multiple of eight."""

    series: np.ndarray  # [block][order][row][8]
    force: np.ndarray  # [block][order][8] of P (R under the normal force)
    dw_dtheta: np.ndarray  # [block][order][8] of B
    friction: (
        np.ndarray
    )  # [block][order][8] of T, where it has a series of its own: see ``_friction_in_stick``
    now: np.ndarray  # [block][row][8]
    parameters: np.ndarray  # [block][row][8], changes of parameters
    before: np.ndarray  # [row][8], rates before an event in the first lane
    after: np.ndarray
    change: np.ndarray  # [entry of an Instant][8], of a block of columns
    gradient: np.ndarray  # [2][entry], derivatives of laws
    tau: np.ndarray  # [column], change of an event's time
    log: np.ndarray
    base_dw_dtheta: np.ndarray  # [order], B of the motion
    columns: int
    plain: int  # columns before this one carry no change of a parameter
    rows: int  # of a column
    inputs: int  # rows of ``parameters``


def longest_step(order: int, tolerance: float) -> float:
    """Step (time units) at which the last term of an oscillation at the fastest rate falls below
    ``tolerance``."""
    return math.exp((math.log(tolerance) + math.lgamma(order + 1)) / order)


def n_rows(model: Model) -> int:
    return 2 * len(model.mode_amplitude) + 2 * len(model.mode_amplitude0) + SLIDER


def build_tangent(model: Model, columns: int, order: int, plain: int | None = None) -> Tangent:
    """Work space for ``columns`` columns; the first ``plain`` (all by default) carry no changes of
    parameters."""
    columns = WIDTH * -(-columns // WIDTH)
    plain = columns if plain is None else WIDTH * (plain // WIDTH)
    rows, order_size = n_rows(model), (order + 2) * columns
    inputs = N_SCALARS + rows - SLIDER
    sizes = (
        order_size * rows, order_size, order_size, order_size, rows * columns, inputs * columns,
        rows * WIDTH, rows * WIDTH, N_ENTRIES * WIDTH, 2 * N_ENTRIES, columns, N_STEPS + 1, order + 2,
    )  # fmt: skip
    return Tangent._make((*map(aligned, sizes), columns, plain, rows, inputs))


@inlined
def slider_row(model, row):
    """Row of one of the slider's quantities, ``PSI`` to ``U_VELOCITY``, in a column: behind those
    of the disc."""
    return 2 * len(model.mode_amplitude) + 2 * len(model.mode_amplitude0) + row


@inlined
def _convolve(s, t, origin, k, j, width, f_row):
    """Order k of f dx + df x for a, b, alpha, beta of the pair whose a is lane j."""
    zero = splat(0.0)
    a0, b0, p0, q0, a1, b1, p1, q1 = zero, zero, zero, zero, zero, zero, zero, zero
    a, b = origin + (k * t.rows + j) * WIDTH, origin + (k * t.rows + j + HALF) * WIDTH
    p, q = a + width * WIDTH, b + width * WIDTH
    at, low, stride = origin + f_row * WIDTH, k * width + j, t.rows * WIDTH
    for i in range(k + 1):
        f, df = spread(s.f, i), load(t.series, at)
        a0, b0 = fma(f, load(t.series, a), a0), fma(f, load(t.series, b), b0)
        p0, q0 = fma(f, load(t.series, p), p0), fma(f, load(t.series, q), q0)
        a1, b1 = fma(df, spread(s.z, low), a1), fma(df, spread(s.z, low + HALF), b1)
        p1, q1 = fma(df, spread(s.e, low), p1), fma(df, spread(s.e, low + HALF), q1)
        a, b, p, q, at, low = (
            a - stride,
            b - stride,
            p - stride,
            q - stride,
            at + stride,
            low - width,
        )
    return add(a0, a1), add(b0, b1), add(p0, p1), add(q0, q1)


@inlined
def point_change(model, x, at, f, B):
    """du, d(u'), dB of the disc under the slider from columns x; f, B of the motion."""
    width, n0 = len(model.mode_amplitude), len(model.mode_amplitude0)
    zero = splat(0.0)
    du, dv, dB = zero, zero, zero
    for j in range(width):
        if model.shift[j] > 0.0:
            force = splat(model.mode_amplitude[j])
            du = fma(force, load(x, at + j * WIDTH), du)
            dv = fma(force, load(x, at + (width + j) * WIDTH), dv)
            dB = fma(splat(model.dw_dtheta[j + HALF]), load(x, at + (j + HALF) * WIDTH), dB)
    for j in range(n0):
        force = splat(model.mode_amplitude0[j])
        du = fma(force, load(x, at + (2 * width + j) * WIDTH), du)
        dv = fma(force, load(x, at + (2 * width + n0 + j) * WIDTH), dv)
    df = load(x, at + slider_row(model, F) * WIDTH)
    return du, fma(splat(f), dB, fma(splat(B), df, dv)), dB


@inlined
def _modal_rates(model, s, t, block, k, phase):
    """Rates of all modes without the contact force, order k; displacements of order k + 1 are
    final. Returns the change of u'' and dB of order k + 1 (lanes)."""
    width, n0, q = len(model.mode_amplitude), len(model.mode_amplitude0), block * t.inputs * WIDTH
    origin, f_row = block * len(t.base_dw_dtheta) * t.rows * WIDTH, slider_row(model, F)
    here, there = origin + k * t.rows * WIDTH, origin + (k + 1) * t.rows * WIDTH
    up, free, single, dB = splat(s.up[k]), splat(0.0), splat(0.0), splat(0.0)
    for j in range(width):
        if model.shift[j] > 0.0:
            i, z = j + HALF, k * width + j
            da, db = load(t.series, here + j * WIDTH), load(t.series, here + i * WIDTH)
            dp, dq = (
                load(t.series, here + (width + j) * WIDTH),
                load(t.series, here + (width + i) * WIDTH),
            )
            stiffness, damping = splat(-model.stiffness[j]), splat(-model.damping[j])
            rate_p, rate_q = (
                fma(stiffness, da, mul(damping, dp)),
                fma(stiffness, db, mul(damping, dq)),
            )
            if phase != STICK:
                l = splat(model.shift[j])
                fa, fb, fp, fq = _convolve(s, t, origin, k, j, width, f_row)
                dp, dq = fma(l, fb, dp), sub(dq, mul(l, fa))
                rate_p, rate_q = fma(l, fq, rate_p), sub(rate_q, mul(l, fp))
            if block * WIDTH >= t.plain:
                d_stiffness = load(t.parameters, q + (N_SCALARS + j) * WIDTH)
                d_damping = load(t.parameters, q + (N_SCALARS + width + j) * WIDTH)
                rate_p = sub(rate_p, fma(d_stiffness, splat(s.z[z]), mul(d_damping, splat(s.e[z]))))
                rate_q = sub(
                    rate_q,
                    fma(d_stiffness, splat(s.z[z + HALF]), mul(d_damping, splat(s.e[z + HALF]))),
                )
            db_next = mul(dq, up)
            store(t.series, there + j * WIDTH, mul(dp, up))
            store(t.series, there + i * WIDTH, db_next)
            store(t.series, there + (width + j) * WIDTH, rate_p)
            store(t.series, there + (width + i) * WIDTH, mul(rate_q, up))
            free = fma(splat(model.mode_amplitude[j]), rate_p, free)
            dB = fma(splat(model.dw_dtheta[i]), db_next, dB)
    for j in range(n0):
        y, g = 2 * width + j, 2 * width + n0 + j
        dy, dg = load(t.series, here + y * WIDTH), load(t.series, here + g * WIDTH)
        rate = fma(splat(-model.stiffness0[j]), dy, mul(splat(-model.damping0[j]), dg))
        if block * WIDTH >= t.plain:
            d_stiffness = load(t.parameters, q + (N_SCALARS + 2 * width + j) * WIDTH)
            d_damping = load(t.parameters, q + (N_SCALARS + 2 * width + n0 + j) * WIDTH)
            rate = sub(
                rate,
                fma(
                    d_stiffness, splat(s.y[j * ROWS + k]), mul(d_damping, splat(s.g[j * ROWS + k]))
                ),
            )
        store(t.series, there + y * WIDTH, mul(dg, up))
        store(t.series, there + g * WIDTH, rate)
        single = fma(splat(model.mode_amplitude0[j]), rate, single)
    return add(free, single), dB


@inlined
def _slider_forces(model, s, t, block, k, dpsi, df, du, dv):
    """Changes of order k of F, of the vertical force without m u'', and of psi' (lanes)."""
    q = block * t.inputs * WIDTH
    pull = sub(mul(splat(model.k_p), dpsi), mul(splat(model.c_p), df))
    vertical = fma(splat(model.k), du, mul(splat(model.c), dv))
    turn = sub(splat(0.0), df)
    if block * WIDTH >= t.plain:
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
    return pull, vertical, turn


@inlined
def _path_change(s, t, block, k, f_row):
    """Change of f B without f'_k B_0, order k + 1: the contribution of the disc's slope to d(u')
    (lanes)."""
    orders = len(t.base_dw_dtheta)
    origin, chain = block * orders * t.rows * WIDTH, block * orders * WIDTH
    carried = mul(splat(s.f[k + 1]), load(t.dw_dtheta, chain))
    for i in range(k + 1):
        carried = fma(splat(s.f[i]), load(t.dw_dtheta, chain + (k + 1 - i) * WIDTH), carried)
        carried = fma(
            splat(t.base_dw_dtheta[k + 1 - i]),
            load(t.series, origin + (i * t.rows + f_row) * WIDTH),
            carried,
        )
    return carried


@inlined
def _leverage_change(model, s, t, block, k, force, changes):
    """Change of beta R of order k without beta_0 dR_k, beta being B / r_0 (lanes), R the series at
    the offset ``force`` in ``Series.slider`` and ``changes`` its changes, [block][order][8]."""
    chain = block * len(t.base_dw_dtheta) * WIDTH
    change = mul(splat(s.slider[force]), load(t.dw_dtheta, chain + k * WIDTH))
    for i in range(1, k + 1):
        change = fma(splat(t.base_dw_dtheta[i]), load(changes, chain + (k - i) * WIDTH), change)
        change = fma(splat(s.slider[force + i]), load(t.dw_dtheta, chain + (k - i) * WIDTH), change)
    return mul(splat(1.0 / model.r_0), change)


@inlined
def _compliant_change(model, s, t, block, k, friction):
    """Change of V = (w - u) / compliance of order k (lanes); ``friction``: coefficient in slip,
    else 0."""
    at = (block * len(t.base_dw_dtheta) + k) * t.rows * WIDTH
    dw, _, _ = point_change(model, t.series, at, 0.0, 0.0)
    compression = sub(dw, load(t.series, at + slider_row(model, U) * WIDTH))
    change = mul(splat(1.0 / model.compliance), compression)
    if block * WIDTH >= t.plain:
        V = s.P[k]
        if model.normal:
            for i in range(k + 1):
                if model.decaying and friction != 0.0:
                    V -= t.base_dw_dtheta[i] / model.r_0 * s.slider[series.FRICTION_SERIES + k - i]
                else:
                    V -= friction * t.base_dw_dtheta[i] / model.r_0 * s.P[k - i]
        d_give = load(t.parameters, block * t.inputs * WIDTH + D_COMPLIANCE * WIDTH)
        change = sub(change, mul(splat(V), d_give))
    return change


@inlined
def _falling_change(model, s, t, block, k):
    """Change of T of order k without q_0 dR_k (lanes), where friction falls with the speed."""
    orders, change = len(t.base_dw_dtheta), splat(0.0)
    chain, df = block * orders * WIDTH, (block * orders * t.rows + slider_row(model, F)) * WIDTH
    for i in range(k + 1):
        change = fma(
            splat(s.slider[series.WEAKENING_SERIES + i]),
            load(t.series, df + (k - i) * t.rows * WIDTH),
            change,
        )
        if i > 0:
            change = fma(
                splat(s.slider[series.COEFFICIENT_SERIES + i]),
                load(t.force, chain + (k - i) * WIDTH),
                change,
            )
    return change


@inlined
def _forces_in_slip(model, s, t, block, k, friction, denominator, free, vertical, pull):
    """Changes of order k of the contact force (P or R), of V, T and f' (lanes), for laws other than
    the paper's; ``friction``: its signed coefficient; ``denominator``: of the contact force;
    ``free``: change of u'' without forces; ``vertical`` and ``pull``: see ``_slider_forces``."""
    beta, mobility, h = (
        t.base_dw_dtheta[0] / model.r_0,
        1.0 + model.m * model.inverse_effective_mass,
        splat(0.0),
    )
    if model.normal:
        h = _leverage_change(model, s, t, block, k, series.P_SERIES, t.force)
    if model.decaying:
        part, twist = _falling_change(model, s, t, block, k), splat(0.0)
        if model.normal:
            twist = _leverage_change(model, s, t, block, k, series.FRICTION_SERIES, t.friction)
        if model.compliant:
            force = V = _compliant_change(model, s, t, block, k, friction)
            if model.normal:
                force = fma(splat(beta), part, add(twist, V))
        else:
            force = fma(splat(t.base_dw_dtheta[0]), pull, fma(splat(model.m), free, vertical))
            force = sub(force, mul(splat(beta), add(part, h)))
            if model.normal:
                force = fma(splat(mobility), fma(splat(beta), part, twist), force)
        force = mul(splat(1.0 / denominator), force)
        T = held = fma(splat(friction), force, part)
        if model.normal:
            held = add(T, fma(splat(beta), force, h))
        if not model.compliant:
            V = sub(force, fma(splat(beta), T, twist)) if model.normal else force
        store(t.friction, (block * len(t.base_dw_dtheta) + k) * WIDTH, T)
        return force, V, T, mul(splat(1.0 / model.m), sub(pull, mul(splat(1.0 / model.r_0), held)))
    if model.compliant:
        V = _compliant_change(model, s, t, block, k, friction)
        force = mul(splat(1.0 / denominator), fma(splat(friction), h, V))
    else:
        top = fma(splat(t.base_dw_dtheta[0]), pull, fma(splat(model.m), free, vertical))
        force = mul(splat(1.0 / denominator), fma(splat(mobility * friction - beta), h, top))
        V = sub(mul(splat(1.0 - friction * beta), force), mul(splat(friction), h))
    T = held = mul(splat(friction), force)
    if model.normal:
        held = fma(splat(friction + beta), force, h)
    return force, V, T, mul(splat(1.0 / model.m), sub(pull, mul(splat(1.0 / model.r_0), held)))


@inlined
def _friction_in_stick(model, s, t, block, k, pull, V):
    """Change of T of order k in stick (lanes), from those of F (``pull``) and V: see
    ``series._stick_friction``. Under the normal force ``t.force`` holds the changes of R."""
    T = mul(splat(model.r_0), pull)
    if model.normal:
        beta, at = t.base_dw_dtheta[0] / model.r_0, (block * len(t.base_dw_dtheta) + k) * WIDTH
        V = add(V, _leverage_change(model, s, t, block, k, series.FRICTION_SERIES, t.friction))
        T = sub(
            sub(T, _leverage_change(model, s, t, block, k, series.NORMAL_SERIES, t.force)),
            mul(splat(beta), V),
        )
        T = mul(splat(1.0 / (1.0 + beta * beta)), T)
        store(t.friction, at, T)
        store(t.force, at, fma(splat(beta), T, V))
    return T


@inlined
def _apply_force(model, s, t, block, k, P, T):
    """Velocities of order k + 1, once the changes P of the vertical contact force and T of friction
    are known."""
    width, n0, up = len(model.mode_amplitude), len(model.mode_amplitude0), splat(s.up[k])
    there = (block * len(t.base_dw_dtheta) + k + 1) * t.rows * WIDTH
    for j in range(width):
        if model.shift[j] > 0.0:
            e = there + (width + j) * WIDTH
            store(
                t.series, e, mul(up, sub(load(t.series, e), mul(splat(model.mode_amplitude[j]), P)))
            )
            if model.coupled:
                e += HALF * WIDTH
                store(
                    t.series,
                    e,
                    sub(load(t.series, e), mul(mul(up, splat(model.couple[j + HALF])), T)),
                )
    for j in range(n0):
        g = there + (2 * width + n0 + j) * WIDTH
        store(t.series, g, mul(up, sub(load(t.series, g), mul(splat(model.mode_amplitude0[j]), P))))


@helper
def tangent_series(model, s, t, order, phase, direction):
    """Taylor coefficients of all columns along the step whose series is ``s``, from ``t.now``."""
    R, orders, width = t.rows, len(t.base_dw_dtheta), len(model.mode_amplitude)
    psi_row, f_row = slider_row(model, PSI), slider_row(model, F)
    u_row, v_row = slider_row(model, U), slider_row(model, U_VELOCITY)
    for k in range(order + 1):
        dw_dtheta = 0.0
        for j in range(width):
            dw_dtheta += model.dw_dtheta[j] * s.z[k * width + j]
        t.base_dw_dtheta[k] = dw_dtheta
    B0 = t.base_dw_dtheta[0]
    friction = direction * model.mu_k / model.r_0 if phase == SLIP else 0.0
    if model.decaying and phase == SLIP:
        for k in range(order):
            series.weakening(model, s, k, direction)
    inverse = 1.0 / (1.0 + model.m * model.inverse_effective_mass + friction * B0)
    lightness = splat(1.0 / model.m)
    for block in range(t.columns // WIDTH):
        at, chain, origin = block * R * WIDTH, block * orders * WIDTH, block * orders * R * WIDTH
        for i in range(0, R * WIDTH, WIDTH):
            store(t.series, origin + i, load(t.now, at + i))
        du, dv, dB = point_change(model, t.now, at, s.f[0], B0)
        if model.compliant or phase == SEPARATION:
            du, dv = load(t.now, at + u_row * WIDTH), load(t.now, at + v_row * WIDTH)
        store(t.dw_dtheta, chain, dB)
        for k in range(order):
            up = splat(s.up[k])
            here, there = origin + k * R * WIDTH, origin + (k + 1) * R * WIDTH
            free, dB = _modal_rates(model, s, t, block, k, phase)
            store(t.dw_dtheta, chain + (k + 1) * WIDTH, dB)
            dpsi, df = load(t.series, here + psi_row * WIDTH), load(t.series, here + f_row * WIDTH)
            pull, vertical, turn = _slider_forces(model, s, t, block, k, dpsi, df, du, dv)
            P, V, T, rate_f = splat(0.0), splat(0.0), splat(0.0), splat(0.0)
            if phase == SLIP and not model.compliant:
                free = fma(splat(s.down[k]), _path_change(s, t, block, k, f_row), free)
            if phase == SEPARATION:
                rate_f = mul(pull, lightness)
            elif (model.compliant or model.normal or model.decaying) and phase == SLIP:
                mu = friction_coefficient(model, direction, s.f[0])
                denominator = slip_denominator(model, model.m, mu, B0)
                P, V, T, rate_f = _forces_in_slip(
                    model, s, t, block, k, mu, denominator, free, vertical, pull
                )
            elif model.compliant:
                P = V = _compliant_change(model, s, t, block, k, 0.0)
            else:
                if phase == SLIP:
                    vertical = fma(splat(B0), pull, vertical)
                P = V = mul(splat(inverse), fma(splat(model.m), free, vertical))
                if phase == SLIP:
                    rate_f = mul(lightness, sub(pull, mul(splat(friction), P)))
                    T = mul(splat(direction * model.mu_k), P)
            if model.compliant or phase == SEPARATION:
                acceleration = mul(lightness, sub(V, vertical))
            else:
                acceleration = sub(free, mul(splat(model.inverse_effective_mass), V))
                if phase == SLIP:
                    acceleration = fma(splat(B0), rate_f, acceleration)
            store(t.force, chain + k * WIDTH, P)
            if model.coupled and phase == STICK:
                T = _friction_in_stick(model, s, t, block, k, pull, V)
            _apply_force(model, s, t, block, k, V, T)
            store(t.series, there + psi_row * WIDTH, mul(turn, up))
            store(t.series, there + f_row * WIDTH, mul(rate_f, up))
            du, dv = mul(dv, up), mul(acceleration, up)
            store(t.series, there + u_row * WIDTH, du)
            store(t.series, there + v_row * WIDTH, dv)


@helper
def take_step(model, s, t, order, x, dt, state, tangent):
    """Count a step to x (time units; ``dt`` s), and move ``state`` and, if requested, the columns
    there."""
    phase = state.x[PHASE]
    if tangent:
        tangent_series(model, s, t, order, phase, state.x[DIRECTION])
        size, at = t.rows * WIDTH, splat(x)
        for block in range(t.columns // WIDTH):
            for i in range(0, size, WIDTH):
                j = (block * len(t.base_dw_dtheta) + order) * size + i
                value = load(t.series, j)
                for _ in range(order):
                    j -= size
                    value = fma(value, at, load(t.series, j))
                store(t.now, block * size + i, value)
    state_at(model, s, order, x, phase, state)
    t.log[DURATION] += dt
    t.log[STICK_TIME + int(phase)] += dt
    t.log[N_STEPS] += 1.0


# ---- Events


@kernel
def rates(model, state, out):
    """Rates of all rows in the state's phase, into the first lane of ``out`` ([row][8])."""
    width, n0 = len(model.mode_amplitude), len(model.mode_amplitude0)
    phase, direction = state.x[PHASE], state.x[DIRECTION]
    i, _ = instant(model, state)
    f, V, T, rate_f = i.f, 0.0, 0.0, 0.0
    if phase == STICK:
        V = laws.vertical_in_stick(model, i)
        T = laws.friction_in_stick(model, i, V)
    elif phase == SLIP:
        friction = friction_coefficient(model, direction, f)
        force = laws.slip_numerator(model, i) / slip_denominator(model, i.m, friction, i.dw_dtheta)
        V, rate_f = laws.slip_rates(model, i, friction, force)
        T = friction * force
    else:
        rate_f = laws.inplane_force_per_radius(i) / i.m
    for j in range(width):
        other = j + HALF if j % WIDTH < HALF else j - HALF
        out[j * WIDTH] = state.e[j] + model.shift[j] * f * state.z[other]
        rate = (
            model.shift[j] * f * state.e[other]
            - model.damping[j] * state.e[j]
            - model.stiffness[j] * state.z[j]
        )
        out[(width + j) * WIDTH] = rate - model.mode_amplitude[j] * V
        if model.coupled:
            out[(width + j) * WIDTH] -= model.couple[j] * T
    for j in range(n0):
        out[(2 * width + j) * WIDTH] = state.g[j]
        rate = -model.damping0[j] * state.g[j] - model.stiffness0[j] * state.y[j]
        out[(2 * width + n0 + j) * WIDTH] = rate - model.mode_amplitude0[j] * V
    out[slider_row(model, PSI) * WIDTH] = model.Omega - f
    out[slider_row(model, F) * WIDTH] = rate_f
    u, v = (i.u, i.u_velocity) if model.compliant or phase == SEPARATION else (i.w, i.w_velocity)
    out[slider_row(model, U) * WIDTH] = v
    out[slider_row(model, U_VELOCITY) * WIDTH] = (
        V - model.N - model.k * (u - model.u_0) - model.c * v
    ) / model.m


@inlined
def _free_change(model, state, x, at, q, parameters, changes):
    """Change of A, ``transitions.Instant.free`` (lanes)."""
    width, n0, f = len(model.mode_amplitude), len(model.mode_amplitude0), state.x[F]
    df, acceleration = load(x, at + slider_row(model, F) * WIDTH), splat(0.0)
    for j in range(width):
        if model.shift[j] > 0.0:
            i, l = j + HALF, model.shift[j]
            z, e = load(x, at + j * WIDTH), load(x, at + (width + j) * WIDTH)
            part = fma(
                splat(-(model.stiffness[j] + (l * f) ** 2)), z, mul(splat(-model.damping[j]), e)
            )
            part = fma(splat(2.0 * l * f), load(x, at + (width + i) * WIDTH), part)
            part = fma(splat(2.0 * l * state.e[i] - 2.0 * l * l * f * state.z[j]), df, part)
            if changes:
                part = sub(
                    part, mul(splat(state.z[j]), load(parameters, q + (N_SCALARS + j) * WIDTH))
                )
                part = sub(
                    part,
                    mul(splat(state.e[j]), load(parameters, q + (N_SCALARS + width + j) * WIDTH)),
                )
            acceleration = fma(splat(model.mode_amplitude[j]), part, acceleration)
    for j in range(n0):
        y, g = load(x, at + (2 * width + j) * WIDTH), load(x, at + (2 * width + n0 + j) * WIDTH)
        part = fma(splat(-model.stiffness0[j]), y, mul(splat(-model.damping0[j]), g))
        if changes:
            part = sub(
                part,
                mul(splat(state.y[j]), load(parameters, q + (N_SCALARS + 2 * width + j) * WIDTH)),
            )
            part = sub(
                part,
                mul(
                    splat(state.g[j]),
                    load(parameters, q + (N_SCALARS + 2 * width + n0 + j) * WIDTH),
                ),
            )
        acceleration = fma(splat(model.mode_amplitude0[j]), part, acceleration)
    return acceleration


@inlined
def _change(t, row):
    """Change of the law whose derivatives stand in a row of ``t.gradient``, for the columns of
    ``t.change`` (lanes)."""
    change = splat(0.0)
    for entry in range(N_ENTRIES):
        change = fma(
            splat(t.gradient[row * N_ENTRIES + entry]), load(t.change, entry * WIDTH), change
        )
    return change


@inlined
def put_changes(model, state, t, x, c, changes):
    """Changes of an instant's entries for the block of columns x that begins with ``c``, into
    ``t.change``; ``changes``: whether columns change parameters. Returns that of the law whose
    derivatives begin ``t.gradient``."""
    at, q, slider = c * t.rows, c * t.inputs, c * t.rows + slider_row(model, 0) * WIDTH
    for entry in range(N_SCALARS):
        store(
            t.change,
            entry * WIDTH,
            load(t.parameters, q + entry * WIDTH) if changes else splat(0.0),
        )
    _, _, dw_dtheta = disc_point(model, state)
    dw, dv, d_slope = point_change(model, x, at, state.x[F], dw_dtheta)
    store(t.change, laws.PSI_ENTRY * WIDTH, load(x, slider + PSI * WIDTH))
    store(t.change, laws.F_ENTRY * WIDTH, load(x, slider + F * WIDTH))
    store(t.change, laws.W_ENTRY * WIDTH, dw)
    store(t.change, laws.W_VELOCITY_ENTRY * WIDTH, dv)
    store(t.change, laws.DW_DTHETA_ENTRY * WIDTH, d_slope)
    store(
        t.change,
        laws.FREE_ENTRY * WIDTH,
        _free_change(model, state, x, at, q, t.parameters, changes),
    )
    store(t.change, laws.U_ENTRY * WIDTH, load(x, slider + U * WIDTH))
    store(t.change, laws.U_VELOCITY_ENTRY * WIDTH, load(x, slider + U_VELOCITY * WIDTH))
    return _change(t, 0)


@inlined
def _set_derivative(model, i, t, row, entry, value):
    """Enter a derivative, ``value`` being the law's after a complex step of an entry. The columns'
    change of N contains that of -k u_0, and their change of the compliance is relative."""
    derivative = value.imag / laws.TINY
    if entry == D_K:
        derivative += model.u_0 * t.gradient[row * N_ENTRIES + LOAD]
    elif entry == D_COMPLIANCE:
        derivative *= i.compliance
    t.gradient[row * N_ENTRIES + entry] = derivative


@helper
def event_gradient(model, state, t, cause):
    """Derivatives of the event function of ``cause``, into ``t.gradient``."""
    i, _ = instant(model, state)
    slipping = state.x[PHASE] == SLIP
    for entry in range(N_ENTRIES):
        _set_derivative(
            model, i, t, 0, entry, event_function(model, laws.stepped(i, entry), cause, slipping)
        )


@helper
def event_times(model, state, t, cause, at_once):
    """``t.tau``: change of the time of the event ``cause`` for every column.  Returns the event
    function's rate. A phase that ended ``at_once``, its event function negative from the start,
    does so in neighbouring motions, too."""
    event_gradient(model, state, t, cause)
    rate = total(
        put_changes(model, state, t, t.before, 0, False)
    )  # the other lanes of ``before`` are zero
    i, _ = instant(model, state)
    value = abs(event_function(model, i, cause, state.x[PHASE] == SLIP))
    by_rate = 0.0 if at_once and value > PASSED * model.unit * abs(rate) else -1.0 / rate
    for c in range(0, t.columns, WIDTH):
        store(t.tau, c, mul(splat(by_rate), put_changes(model, state, t, t.now, c, c >= t.plain)))
    return rate


@helper
def _jump(t, rates_at, sign):
    """t.now += sign * rates * tau."""
    for c in range(0, t.columns, WIDTH):
        tau = load(t.tau, c)
        for r in range(t.rows):
            at = c * t.rows + r * WIDTH
            store(t.now, at, fma(splat(sign * rates_at[r * WIDTH]), tau, load(t.now, at)))


@helper
def impact_change(model, state, t):
    """Jacobian of the plastic impact, applied to the columns; ``state`` is the one before."""
    width, n0 = len(model.mode_amplitude), len(model.mode_amplitude0)
    i, _ = instant(model, state)
    for entry in range(N_ENTRIES):
        p, f = laws.impact(model, laws.stepped(i, entry))
        _set_derivative(model, i, t, 0, entry, p)
        _set_derivative(model, i, t, 1, entry, f)
    for c in range(0, t.columns, WIDTH):
        block, dp = c * t.rows, put_changes(model, state, t, t.now, c, c >= t.plain)
        store(t.now, block + slider_row(model, F) * WIDTH, _change(t, 1))
        for j in range(width):
            at = block + (width + j) * WIDTH
            store(t.now, at, sub(load(t.now, at), mul(splat(model.mode_amplitude[j]), dp)))
        for j in range(n0):
            at = block + (2 * width + n0 + j) * WIDTH
            store(t.now, at, sub(load(t.now, at), mul(splat(model.mode_amplitude0[j]), dp)))


@helper
def slider_rows(model, state, t):
    """Rows of the slider that follow from the others in contact: u, u' if it is rigid, and df = 0
    in stick, exactly."""
    _, _, B = disc_point(model, state)
    for c in range(0, t.columns, WIDTH):
        block = c * t.rows
        if not model.compliant:
            du, dv, _ = point_change(model, t.now, block, state.x[F], B)
            store(t.now, block + slider_row(model, U) * WIDTH, du)
            store(t.now, block + slider_row(model, U_VELOCITY) * WIDTH, dv)
        if state.x[PHASE] == STICK:
            store(t.now, block + slider_row(model, F) * WIDTH, splat(0.0))


@helper
def count_event(state, cause, log):
    phase = state.x[PHASE]
    if cause == transitions.RELEASE_FORWARD:
        log[RELEASES] += 1.0
    elif cause == transitions.RELEASE_BACKWARD:
        log[BACK_RELEASES] += 1.0
    elif cause == transitions.AT_REST and phase == SLIP:
        log[REVERSALS] += 1.0
    if phase == SEPARATION:
        log[SEPARATIONS] += 1.0
    elif phase == STICK:
        log[STICKS] += 1.0


@helper
def pass_event(model, state, t, cause, at_once, returns, changes):
    """Carry out and count an event, and, if requested, change the columns.  Returns the exit code.
    ``at_once``: the phase had no duration; ``returns``: the integration ends at this event, still
    in the phase before it."""
    if cause == transitions.AT_REST:
        state.x[F] = 0.0
    if changes:
        rates(model, state, t.before)
        event_times(model, state, t, cause, at_once)
        _jump(t, t.before, 1.0)
        if cause == transitions.GAP_CLOSED and not model.compliant:
            impact_change(model, state, t)
    if returns:
        t.log[RELEASES] += 1.0
        return RETURNED
    if change_phase(model, state, cause, at_once) == NO_SOLUTION:
        return NO_SOLUTION
    count_event(state, cause, t.log)
    if changes:
        if state.x[PHASE] == SEPARATION:
            slider_rows(model, state, t)
        rates(model, state, t.after)
        _jump(t, t.after, -1.0)
        if state.x[PHASE] != SEPARATION:
            slider_rows(model, state, t)
    return CONSISTENT
