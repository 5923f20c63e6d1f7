"""Small changes along a motion: Taylor series of the variational equations.

One pass of the recurrence advances eight columns (see `columns`).  It is the model's, with each
product f x replaced by f dx + df x, and the law of contact is the stage that the motion has
(`contact`), applied to changes.
"""

import math
from typing import NamedTuple

from .columns import (
    D_C,
    D_C_P,
    D_COMPLIANCE,
    D_K,
    D_K_P,
    D_LOAD,
    D_M,
    D_OMEGA,
    DURATION,
    N_INPUTS,
    N_STEPS,
    STICK_TIME,
    chain_at,
    entry,
    has_inputs,
    inputs_at,
    now_at,
    order_at,
    put_entry,
)
from .contact import known_numerator, known_of, put_sensitivity, slip_law
from .dense_output import state_at
from .jit import helper, inlined
from .jit.simd import WIDTH, load, splat, spread, store
from .laws import surface_mobility
from .model import ROWS, is_rigid
from .modes import slope
from .series import ORDER, displacement_of_lane
from .state import (
    DIRECTION,
    HALF,
    PHASE,
    PHI_RATE,
    PSI,
    SEPARATION,
    SLIP,
    STICK,
    U_VELOCITY,
    U,
    displacement0_place,
    slider_place,
    velocity0_place,
    velocity_place,
)
from .stretching import membrane_change, membrane_force0, membrane_force_on


def longest_step(order: int, tolerance: float) -> float:
    """Return the step (time units) at which the last term of an oscillation at the fastest rate
    falls below ``tolerance``: columns are rougher than the motion that sizes the steps."""
    return math.exp((math.log(tolerance) + math.lgamma(order + 1)) / order)


@helper
def take_step(model, series, tangent, step, state, changes):
    """Count a step, and move ``state`` and, if ``changes``, the columns to its end."""
    phase = state.x[PHASE]
    if changes:
        tangent_series(model, series, tangent, step.order, phase, state.x[DIRECTION])
        _move_columns(tangent, step.order, step.length)
    state_at(model, series, step.order, step.length, phase, state)
    duration = step.length * model.unit
    tangent.log[DURATION] += duration
    tangent.log[STICK_TIME + int(phase)] += duration
    tangent.log[N_STEPS] += 1.0


@inlined
def _move_columns(tangent, order, x):
    """Put the series of the columns at x (time units) into ``Tangent.now``."""
    size = tangent.rows * WIDTH
    for block in range(tangent.columns // WIDTH):
        last = order_at(tangent, block, order)
        for i in range(0, size, WIDTH):
            at = last + i
            value = load(tangent.series, at)
            for _ in range(order):
                at -= size
                value = load(tangent.series, at) + value * x
            store(tangent.now, now_at(tangent, block) + i, value)


@helper
def tangent_series(model, series, tangent, order, phase, direction):
    """Fill ``Tangent.series`` along the step whose series is given, from ``Tangent.now``."""
    for k in range(order + 1):
        tangent.motion_slope[k] = slope(model, series, k)
    B = tangent.motion_slope[0]
    law = slip_law(model, direction, series.f[0], B)
    if model.has_varying_friction and phase == SLIP:
        for k in range(order):
            put_sensitivity(model, series, k, direction)
    for block in range(tangent.columns // WIDTH):
        now = now_at(tangent, block)
        start = order_at(tangent, block, 0)
        for i in range(0, tangent.rows * WIDTH, WIDTH):
            store(tangent.series, start + i, load(tangent.now, now + i))
        du, dv, d_slope = point_change(model, tangent.now, now, series.f[0], B)
        if model.has_compliance or phase == SEPARATION:
            du = entry(tangent.now, now, slider_place(model, U))
            dv = entry(tangent.now, now, slider_place(model, U_VELOCITY))
        store(tangent.slope, chain_at(tangent, block, 0), d_slope)
        for k in range(order):
            du, dv = _next_order(model, series, tangent, block, k, phase, law, du, dv)


@inlined
def _next_order(model, series, tangent, block, k, phase, law, du, dv):
    """Order k + 1 of a block of columns. du, dv: changes of u and u' of order k, of which those of
    order k + 1 are returned (lanes)."""
    lightness = 1.0 / model.m
    up = series.up[k]
    there = order_at(tangent, block, k + 1)

    # rates without forces
    free, along = _modal_rates(model, series, tangent, block, k, phase)
    slider = _slider_loads(model, series, tangent, block, k, du, dv, along)

    # forces, and the rates that they change
    V = splat(0.0)
    H = splat(0.0)
    rate_f = splat(0.0)
    if phase == SLIP:
        if is_rigid(model):
            free = free + series.down[k] * _path_change(model, series, tangent, block, k)
        V, H = _forces_in_slip(model, series, tangent, block, k, law, free, slider)
        lever = surface_mobility(model, model.m) * (1.0 / model.r_0)
        rate_f = lightness * (slider.pull - H * lever)
    elif phase == STICK:
        V, H = _forces_in_stick(model, series, tangent, block, k, free, slider)
    else:
        rate_f = slider.pull * lightness
    if model.has_compliance or phase == SEPARATION:
        acceleration = lightness * (V - slider.vertical)
    else:
        acceleration = free - model.inverse_effective_mass * V
        if phase == SLIP:
            acceleration = acceleration + tangent.motion_slope[0] * rate_f
    _apply_forces(model, tangent, block, k, up, V, H)

    # the slider
    du_next = dv * up
    dv_next = acceleration * up
    put_entry(tangent.series, there, slider_place(model, PSI), slider.turn * up)
    put_entry(tangent.series, there, slider_place(model, PHI_RATE), rate_f * up)
    put_entry(tangent.series, there, slider_place(model, U), du_next)
    put_entry(tangent.series, there, slider_place(model, U_VELOCITY), dv_next)
    return du_next, dv_next


# ---- The disc


@inlined
def point_change(model, rows, at, f, B):
    """Return du, d(u'), dB of the disc under the slider from the block of columns that begins at
    ``at`` of ``rows``; f, B of the motion."""
    du = splat(0.0)
    dv = splat(0.0)
    d_slope = splat(0.0)
    for j in range(len(model.mode_amplitude)):
        if model.shift[j] > 0.0:
            i = j + HALF
            amplitude = model.mode_amplitude[j]
            du = du + amplitude * entry(rows, at, j)
            dv = dv + amplitude * entry(rows, at, velocity_place(model, j))
            d_slope = d_slope + model.dw_dtheta[i] * entry(rows, at, i)
    for j in range(len(model.mode_amplitude0)):
        amplitude = model.mode_amplitude0[j]
        du = du + amplitude * entry(rows, at, displacement0_place(model, j))
        dv = dv + amplitude * entry(rows, at, velocity0_place(model, j))
    df = entry(rows, at, slider_place(model, PHI_RATE))
    return du, dv + B * df + f * d_slope, d_slope


@inlined
def surface_change(model, rows, at):
    """Return the change of v_s, the velocity along the path of the surface on which friction acts,
    from the block of columns that begins at ``at`` of ``rows`` (lanes)."""
    change = splat(0.0)
    for j in range(len(model.mode_amplitude)):
        if model.shift[j] > 0.0:
            i = j + HALF
            change = change + model.tangential[i] * entry(rows, at, velocity_place(model, i))
    return change


@inlined
def _modal_rates(model, series, tangent, block, k, phase):
    """Enter the changes of all modes of order k + 1, of velocities that the contact force changes
    their rates without it; and that of the slope. Returns the changes of order k, but for forces,
    of u'' and of the surface's acceleration along the path (lanes)."""
    free = splat(0.0)
    along = splat(0.0)
    d_slope = splat(0.0)
    for j in range(len(model.mode_amplitude)):
        if model.shift[j] > 0.0:
            rate, rate_beta, db_next = _pair_rates(model, series, tangent, block, k, j, phase)
            free = free + model.mode_amplitude[j] * rate
            d_slope = d_slope + model.dw_dtheta[j + HALF] * db_next
            if model.has_moving_surface:
                along = along + model.tangential[j + HALF] * rate_beta
    single = splat(0.0)
    for j in range(len(model.mode_amplitude0)):
        rate = _axisymmetric_rates(model, series, tangent, block, k, j)
        single = single + model.mode_amplitude0[j] * rate
    store(tangent.slope, chain_at(tangent, block, k + 1), d_slope)
    return free + single, along


@inlined
def _pair_rates(model, series, tangent, block, k, j, phase):
    """Changes of order k + 1 of the pair whose a is in lane j. Returns the rates of alpha and beta
    without the contact force, and b of order k + 1 (lanes)."""
    i = j + HALF
    up = series.up[k]
    here = order_at(tangent, block, k)
    there = order_at(tangent, block, k + 1)
    alpha_row = velocity_place(model, j)
    beta_row = velocity_place(model, i)
    da = entry(tangent.series, here, j)
    db = entry(tangent.series, here, i)
    d_alpha = entry(tangent.series, here, alpha_row)
    d_beta = entry(tangent.series, here, beta_row)

    # the modes' own equations
    rate_alpha = 0.0 - (model.stiffness[j] * da + model.damping[j] * d_alpha)
    rate_beta = 0.0 - (model.stiffness[j] * db + model.damping[j] * d_beta)
    if model.has_stretching:
        stride = tangent.rows * WIDTH
        work = series.membrane
        rate_alpha = rate_alpha - membrane_change(
            model, work, ROWS, k, tangent.series, here, stride, j
        )
        rate_beta = rate_beta - membrane_change(
            model, work, ROWS, k, tangent.series, here, stride, i
        )
    if phase != STICK:
        l = model.shift[j]
        turned = _turned(model, series, tangent, block, k, j)
        d_alpha = d_alpha + l * turned.b
        d_beta = d_beta - l * turned.a
        rate_alpha = rate_alpha + l * turned.beta
        rate_beta = rate_beta - l * turned.alpha

    # changes of stiffness and damping
    if has_inputs(tangent, block):
        at = inputs_at(tangent, block)
        d_stiffness = entry(tangent.inputs, at, N_INPUTS + j)
        d_damping = entry(tangent.inputs, at, N_INPUTS + alpha_row)
        z = displacement_of_lane(k, j)
        e = z + WIDTH
        a = series.modes[z]
        b = series.modes[z + HALF]
        alpha = series.modes[e]
        beta = series.modes[e + HALF]
        if model.has_stretching:
            # it is the plate's material that changes, and with it the membrane in the same ratio
            a += membrane_force_on(series.membrane, ROWS, k, j) / model.stiffness[j]
            b += membrane_force_on(series.membrane, ROWS, k, j + HALF) / model.stiffness[j]
        rate_alpha = rate_alpha - (d_stiffness * a + d_damping * alpha)
        rate_beta = rate_beta - (d_stiffness * b + d_damping * beta)
    db_next = d_beta * up
    put_entry(tangent.series, there, j, d_alpha * up)
    put_entry(tangent.series, there, i, db_next)
    put_entry(tangent.series, there, alpha_row, rate_alpha)
    put_entry(tangent.series, there, beta_row, rate_beta * up)
    return rate_alpha, rate_beta, db_next


class PairProducts(NamedTuple):
    """Changes of the products of f with the components of a pair (lanes)."""

    a: object
    b: object
    alpha: object
    beta: object


@inlined
def _turned(model, series, tangent, block, k, j):
    """`PairProducts` of order k, f dx + df x, of the pair whose a is in lane j."""
    zero = splat(0.0)
    # f times changes; changes of f times the motion
    a_by_f = zero
    b_by_f = zero
    alpha_by_f = zero
    beta_by_f = zero
    a_by_df = zero
    b_by_df = zero
    alpha_by_df = zero
    beta_by_df = zero
    width = len(model.shift)
    changes = tangent.series
    stride = tangent.rows * WIDTH
    # from changes of order k, and of f of order 0, on
    a = order_at(tangent, block, k) + j * WIDTH
    b = a + HALF * WIDTH
    alpha = a + width * WIDTH
    beta = b + width * WIDTH
    df_at = order_at(tangent, block, 0) + slider_place(model, PHI_RATE) * WIDTH
    z = displacement_of_lane(k, j)
    e = z + WIDTH
    for i in range(k + 1):
        f = spread(series.f, i)
        a_by_f = a_by_f + f * load(changes, a)
        b_by_f = b_by_f + f * load(changes, b)
        alpha_by_f = alpha_by_f + f * load(changes, alpha)
        beta_by_f = beta_by_f + f * load(changes, beta)
        df = load(changes, df_at)
        a_by_df = a_by_df + df * spread(series.modes, z)
        b_by_df = b_by_df + df * spread(series.modes, z + HALF)
        alpha_by_df = alpha_by_df + df * spread(series.modes, e)
        beta_by_df = beta_by_df + df * spread(series.modes, e + HALF)
        a -= stride
        b -= stride
        alpha -= stride
        beta -= stride
        df_at += stride
        z -= ORDER
        e -= ORDER
    return PairProducts(
        a_by_f + a_by_df, b_by_f + b_by_df, alpha_by_f + alpha_by_df, beta_by_f + beta_by_df
    )


@inlined
def _axisymmetric_rates(model, series, tangent, block, k, j):
    """Changes of order k + 1 of a mode without nodal diameter. Returns the rate of its velocity
    without the contact force (lanes)."""
    here = order_at(tangent, block, k)
    there = order_at(tangent, block, k + 1)
    y_row = displacement0_place(model, j)
    g_row = velocity0_place(model, j)
    dy = entry(tangent.series, here, y_row)
    dg = entry(tangent.series, here, g_row)
    rate = 0.0 - (model.stiffness0[j] * dy + model.damping0[j] * dg)
    if model.has_stretching:
        stride = tangent.rows * WIDTH
        row = len(model.shift) + j
        rate = rate - membrane_change(
            model, series.membrane, ROWS, k, tangent.series, here, stride, row
        )
    if has_inputs(tangent, block):
        at = inputs_at(tangent, block)
        d_stiffness = entry(tangent.inputs, at, N_INPUTS + y_row)
        d_damping = entry(tangent.inputs, at, N_INPUTS + g_row)
        y = series.y[j * ROWS + k]
        g = series.g[j * ROWS + k]
        if model.has_stretching:
            y += membrane_force0(model, series.membrane, ROWS, k, j) / model.stiffness0[j]
        rate = rate - (d_stiffness * y + d_damping * g)
    put_entry(tangent.series, there, y_row, dg * series.up[k])
    put_entry(tangent.series, there, g_row, rate)
    return rate


@inlined
def _apply_forces(model, tangent, block, k, up, V, H):
    """Complete the velocities of order k + 1 by the changes V and H of the contact forces of order k
    (lanes)."""
    there = order_at(tangent, block, k + 1)
    for j in range(len(model.mode_amplitude)):
        if model.shift[j] > 0.0:
            row = velocity_place(model, j)
            rate = entry(tangent.series, there, row) - model.mode_amplitude[j] * V
            put_entry(tangent.series, there, row, rate * up)
            if model.has_moving_surface:
                row += HALF
                d_beta = entry(tangent.series, there, row)
                push = (up * model.tangential[j + HALF]) * H
                put_entry(tangent.series, there, row, d_beta + push)
    for j in range(len(model.mode_amplitude0)):
        row = velocity0_place(model, j)
        rate = entry(tangent.series, there, row) - model.mode_amplitude0[j] * V
        put_entry(tangent.series, there, row, rate * up)


# ---- The slider and the law of contact


class SliderLoads(NamedTuple):
    """Changes of what acts on the slider but for contact forces (lanes)."""

    pull: object  # of F - m G / r_0, and of m at the same accelerations
    vertical: object  # of N + k (u - u_0) + c u', and of m at the same u''
    turn: object  # of psi'


@inlined
def _slider_loads(model, series, tangent, block, k, du, dv, along):
    """`SliderLoads` of order k; du, dv, along: changes of u, u' and G of order k (lanes)."""
    here = order_at(tangent, block, k)
    dpsi = entry(tangent.series, here, slider_place(model, PSI))
    df = entry(tangent.series, here, slider_place(model, PHI_RATE))
    if model.has_moving_surface:
        # the slider's own rate
        df = df + surface_change(model, tangent.series, here) * (1.0 / model.r_0)
    pull = model.k_p * dpsi - model.c_p * df
    vertical = model.k * du + model.c * dv
    turn = 0.0 - df
    if model.has_moving_surface:
        pull = pull - along * (model.m / model.r_0)
    if has_inputs(tangent, block):
        at = inputs_at(tangent, block)
        d_m = entry(tangent.inputs, at, D_M)
        d_c_p = entry(tangent.inputs, at, D_C_P)
        f = series.f[k]
        f_rate = series.f[k + 1] * series.down[k]
        if model.has_moving_surface:
            f = series.slider[k]
            f_rate = series.slider[k + 1] * series.down[k]
        v_rate = series.v[k + 1] * series.down[k]
        pull = pull + entry(tangent.inputs, at, D_K_P) * series.psi[k] - d_c_p * f
        pull = pull - d_m * f_rate
        vertical = vertical + entry(tangent.inputs, at, D_K) * series.u[k]
        vertical = vertical + entry(tangent.inputs, at, D_C) * series.v[k] + d_m * v_rate
        if k == 0:
            d_omega = entry(tangent.inputs, at, D_OMEGA)
            pull = pull + d_c_p * model.Omega + model.c_p * d_omega
            vertical = vertical + entry(tangent.inputs, at, D_LOAD)
            turn = turn + d_omega
    return SliderLoads(pull, vertical, turn)


@inlined
def _sum(numbers, changes, at, stride, k, first):
    """sum_{i=first..k} numbers[i] changes[k - i] (lanes), order 0 of the changes being at ``at`` and
    orders ``stride`` apart."""
    lanes = splat(0.0)
    for i in range(first, k + 1):
        lanes = lanes + spread(numbers, i) * load(changes, at + (k - i) * stride)
    return lanes


@inlined
def _path_change(model, series, tangent, block, k):
    """Change of f B without f'_k B_0, order k + 1: the contribution of the disc's slope to d(u')
    (lanes)."""
    chain = chain_at(tangent, block, 0)
    df = order_at(tangent, block, 0) + slider_place(model, PHI_RATE) * WIDTH
    stride = tangent.rows * WIDTH
    turned = _sum(series.f, tangent.slope, chain, WIDTH, k + 1, 0)
    return turned + _sum(tangent.motion_slope, tangent.series, df, stride, k + 1, 1)


@inlined
def _leaning_change(model, tangent, block, k, force, changes):
    """Change of beta R of order k without beta_0 dR_k (lanes), R being the series ``force`` and
    ``changes`` its changes, [block][order][8]."""
    chain = chain_at(tangent, block, 0)
    by_force = _sum(tangent.motion_slope, changes, chain, WIDTH, k, 1)
    by_slope = _sum(force, tangent.slope, chain, WIDTH, k, 0)
    return (by_force + by_slope) * (1.0 / model.r_0)


@inlined
def _friction_change(model, series, tangent, block, k):
    """Change of T of order k without q_0 dR_k (lanes), where friction depends on the speed."""
    chain = chain_at(tangent, block, 0)
    df = order_at(tangent, block, 0) + slider_place(model, PHI_RATE) * WIDTH
    by_speed = _sum(series.sensitivity, tangent.series, df, tangent.rows * WIDTH, k, 0)
    return by_speed + _sum(series.coefficient, tangent.force, chain, WIDTH, k, 1)


@inlined
def _compression_change(model, series, tangent, block, k):
    """Change of V = (w - u) / compliance of order k (lanes)."""
    here = order_at(tangent, block, k)
    dw, _, _ = point_change(model, tangent.series, here, 0.0, 0.0)
    compression = dw - entry(tangent.series, here, slider_place(model, U))
    change = compression * (1.0 / model.compliance)
    if has_inputs(tangent, block):
        d_compliance = entry(tangent.inputs, inputs_at(tangent, block), D_COMPLIANCE)
        change = change - series.V[k] * d_compliance
    return change


@inlined
def _forces_in_slip(model, series, tangent, block, k, law, free, slider):
    """Changes of order k of V and H (lanes); enters those of the contact force and of T.

    law : `contact.SlipLaw` of the motion
    free : change of u'' but for forces and f'
    slider : `SliderLoads`
    """
    T = splat(0.0)
    leaning_R = splat(0.0)
    leaning_T = splat(0.0)
    if model.has_varying_friction:
        T = _friction_change(model, series, tangent, block, k)
    if model.has_normal_force:
        leaning_R = _leaning_change(model, tangent, block, k, series.P, tangent.force)
        leaning_T = law.friction * leaning_R
        if model.has_varying_friction:
            leaning_T = _leaning_change(model, tangent, block, k, series.friction, tangent.friction)
    known = known_of(model, law, T, leaning_R, leaning_T)
    if model.has_compliance:
        numerator = _compression_change(model, series, tangent, block, k) + known.V
    else:
        numerator = slider.vertical + model.m * free + tangent.motion_slope[0] * slider.pull
        if model.has_normal_force or model.has_varying_friction:
            numerator = numerator + known_numerator(model, law, known)
    R = numerator * (1.0 / law.denominator)
    store(tangent.force, chain_at(tangent, block, k), R)
    if model.has_varying_friction:
        store(tangent.friction, chain_at(tangent, block, k), law.friction * R + known.T)
    return law.share_V * R - known.V, law.share_H * R + known.H


@inlined
def _forces_in_stick(model, series, tangent, block, k, free, slider):
    """Changes of order k of V and H (lanes), H being 0 where the surface does not move."""
    if model.has_compliance:
        V = _compression_change(model, series, tangent, block, k)
    else:
        mobility = 1.0 + model.m * model.inverse_effective_mass
        V = (model.m * free + slider.vertical) * (1.0 / mobility)
    H = splat(0.0)
    if model.has_moving_surface:
        H = slider.pull * (model.r_0 / surface_mobility(model, model.m))
    return V, H
