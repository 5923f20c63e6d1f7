"""Taylor coefficients of the three phases (docs/model.md: Slip, Stick, Separation), eight lanes at
a time.

The contact force of order k needs a sum over all modes, and every quantity of order k + 1 needs the
contact force. This chain would leave the arithmetic units idle.  The sum is therefore taken over
the terms known before P_{k-1}, whose contribution is a known constant (``damped_inverse_mass``),
and terms from order k - 1 are collected while that order is processed ("pending"). The convolutions
of f with z and e, nearly all of the work, are computed for two orders at once.

With C = 2 f_0 slope - force damping and s_k = sum_{j=1..k} f_{k-j} z_j, the disc's part of u'' at
order k is

    sum(C e_k + f_0 bend s_k - force stiffness z_k + slope (E_k + (k+1) Z_k))
        + f_k (sum(slope e_0) + f_0 sum(bend z_0) + (k+1) sum(slope z_1))

where E_k, Z_k are the inner terms of the convolutions sum f_{k-i} e_i, sum f_{k-i} z_{i+1}, 1 <= i
<= k - 1.
"""

from collections import namedtuple

import numpy as np

from . import layout
from .jit import inlined, simd
from .jit.packing import packed
from .jit.simd import (
    WIDTH,
    add,
    fma,
    item,
    load,
    low_halves,
    mul,
    put,
    splat,
    spread,
    store,
    sub,
    total,
)
from .laws import friction_coefficient, slip_denominator
from .layout import ROWS, Model, padded

# Rows of Series.modes where e and scratch begin (z begins at 0). Rows of scratch: inner terms (e,
# z) of a pair's second order, s_k, the constant C, and in a-lanes that of the displacements, in
# b-lanes f_0 bend; FORCES times T / V, where that is constant, in b-lanes.
E, SCRATCH = ROWS, 2 * ROWS
_E_HIGH, _Z_HIGH, _CARRIED, _CORIOLIS, _BENT, _PUSHED, _MODES_END = range(SCRATCH, SCRATCH + 7)
# Offsets of the slider's series in Series.slider, and its end.
PSI_SERIES, F_SERIES, U_SERIES, V_SERIES, P_SERIES, SWITCH, SWITCH2, _POWERS, UP, DOWN = (
    ROWS * i for i in range(10)
)
SLOPE_SERIES, DRIVE_SERIES, LOAD_SERIES, NORMAL_SERIES, FRICTION_SERIES = (
    ROWS * i for i in range(10, 15)
)
COEFFICIENT_SERIES, WEAKENING_SERIES, _SLIDER_END = (ROWS * i for i in range(15, 18))
_ROOT_ROWS = 7 * WIDTH


@packed
class Series(
    namedtuple(
        "Series", "modes slider z e y g psi f u v P switch switch2 powers up down roots amplitudes"
    )
):
    """Taylor coefficients of one step: coefficient k multiplies (time / unit)**k, so that none
    overflows, however stiff the disc is. Those of pairs are stored as [order][lane], all others as
    [quantity][order].

    z and e are views of ``modes``, whose end is scratch; psi to down of ``slider``. Behind them
    stand those of B / r_0 (normal force), of Omega and N (ramp), R of stick (normal force and
    couple), T of that or of slip under falling friction, with its coefficient, and the change of T
    with f.

    switch: direction * f in slip, gap in separation, forward release function in stick; switch2:
    the backward one; up: unit / (k + 1) integrates; down: (k + 1) / unit differentiates; roots:
    work space of the root finder; amplitudes: of the modes of stick, real parts, imaginary parts,
    then those at a later time
    """


def build_series(model: Model, order: int) -> Series:
    """Empty series of degree ``order`` for ``model``."""
    width, n0 = len(model.shift), len(model.mode_amplitude0)
    sizes = _MODES_END * width, _SLIDER_END, ROWS * n0, ROWS * n0, 4 * len(model.modes.gain)
    modes, slider, y, g, amplitudes = map(simd.aligned, sizes)
    roots = simd.aligned(_ROOT_ROWS * (padded(order + 1) + WIDTH)).reshape(_ROOT_ROWS, -1)
    rows, from_1 = slider.reshape(-1, ROWS), np.arange(1.0, ROWS + 1.0)
    np.divide(model.unit, from_1, out=rows[UP // ROWS])
    np.divide(from_1, model.unit, out=rows[DOWN // ROWS])
    z, e = modes[: E * width], modes[E * width : SCRATCH * width]
    return Series._make(
        (modes, slider, z, e, y, g, *rows[: SLOPE_SERIES // ROWS], roots, amplitudes)
    )


@inlined
def lane_count(model):
    """Number of lanes; a constant for the compiler if there is one block."""
    return len(model.shift) if model.wide else WIDTH


@inlined
def drive(model, s):  # Omega at the start of the step
    return s.slider[DRIVE_SERIES] if model.ramped else model.Omega


@inlined
def load_at(model, s):  # N at the start of the step
    return s.slider[LOAD_SERIES] if model.ramped else model.N


@inlined
def _row(model, row, b):
    return load(model.lanes, row * lane_count(model) + b)


@inlined
def _block(s, width, row, b):
    """Block of a row of ``Series.modes``: displacements of order k are row k, velocities E + k;
    then comes scratch."""
    return load(s.modes, row * width + b)


@inlined
def _push(model, impulse, friction):
    """Minus the impulses of V, in a-lanes, and of friction T, in b-lanes: what multiplies row
    ``FORCES`` (lanes)."""
    return low_halves(splat(-impulse), splat(-friction)) if model.coupled else splat(-impulse)


@inlined
def _modal_sum(model, s, row, k):
    """Sum of a row of the model times row k of ``Series.modes``."""
    width, lanes = lane_count(model), splat(0.0)
    for b in range(0, width, WIDTH):
        lanes = fma(_row(model, row, b), _block(s, width, k, b), lanes)
    return total(lanes)


@inlined
def velocity_size(model, s, k):
    """Largest modulus among the modal velocities of order k."""
    width, n, biggest = lane_count(model), len(model.mode_amplitude0), splat(0.0)
    for j in range(k * width, (k + 1) * width, WIDTH):
        biggest = simd.maximum(biggest, simd.absolute(load(s.modes, E * width + j)))
    size = simd.largest(biggest)
    for j in range(n):
        size = max(size, abs(s.g[j * ROWS + k]))
    return size


@inlined
def _disc_point(model, s):
    """u, u' and the slope B of the disc under the slider, from the coefficients 0."""
    B, u = _modal_sum(model, s, layout.DW_DTHETA, 0), _modal_sum(model, s, layout.AMPLITUDE_ROW, 0)
    v = _modal_sum(model, s, layout.AMPLITUDE_ROW, E) + s.slider[F_SERIES] * B
    for j in range(len(model.mode_amplitude0)):
        u += model.mode_amplitude0[j] * s.y[j * ROWS]
        v += model.mode_amplitude0[j] * s.g[j * ROWS]
    return u, v, B


@inlined
def _products(s, width, b, k, f_high, e_low, z_low):
    """Sums with f_{k-i} e_i and f_{k-i} z_{i+1}, 2 <= i <= k - 2, of an odd order k and of k + 1;
    f_high: f_{k-1}."""
    e_high, z_high, at = splat(0.0), splat(0.0), 2 * width + b
    for i in range(2, k - 1):
        f_low = spread(s.slider, F_SERIES + k - i)
        e, z = load(s.modes, E * width + at), load(s.modes, at + width)
        e_low, z_low = fma(f_low, e, e_low), fma(f_low, z, z_low)
        e_high, z_high = fma(f_high, e, e_high), fma(f_high, z, z_high)
        f_high = f_low
        at += width
    return e_low, z_low, e_high, z_high


@inlined
def _products_apart(s, width, b, k, f_high, e_low, z_low):
    """As ``_products``, with separate sums for even and odd i: too many registers where lanes do
    not fit into one."""
    e_high, z_high, at = splat(0.0), splat(0.0), 2 * width + b
    e_low2, z_low2, e_high2, z_high2 = splat(0.0), splat(0.0), splat(0.0), splat(0.0)
    for i in range(2, k - 1, 2):
        f_mid, f_low = spread(s.slider, F_SERIES + k - i), spread(s.slider, F_SERIES + k - i - 1)
        e, z = load(s.modes, E * width + at), load(s.modes, at + width)
        e_low, z_low = fma(f_mid, e, e_low), fma(f_mid, z, z_low)
        e_high, z_high = fma(f_high, e, e_high), fma(f_high, z, z_high)
        e, z = load(s.modes, E * width + at + width), load(s.modes, at + 2 * width)
        e_low2, z_low2 = fma(f_low, e, e_low2), fma(f_low, z, z_low2)
        e_high2, z_high2 = fma(f_mid, e, e_high2), fma(f_mid, z, z_high2)
        f_high = f_low
        at += 2 * width
    return add(e_low, e_low2), add(z_low, z_low2), add(e_high, e_high2), add(z_high, z_high2)


@inlined
def _inner_terms(s, width, b, k, e_last, z_last):
    """Inner terms of order k for e and z; ``e_last``, ``z_last`` are e_{k-1} and z_k. An odd order
    also computes the terms of the next order, except the first and the last, which need f_k and
    e_k. It keeps them in scratch."""
    e_low, z_low = splat(0.0), splat(0.0)
    if k % 2 == 0:
        e_low, z_low = _block(s, width, _E_HIGH, b), _block(s, width, _Z_HIGH, b)
        if k > 2:
            f = splat(s.slider[F_SERIES + k - 1])
            e_low, z_low = (
                fma(f, _block(s, width, E + 1, b), e_low),
                fma(f, _block(s, width, 2, b), z_low),
            )
        f = splat(s.slider[F_SERIES + 1])
        return fma(f, e_last, e_low), fma(f, z_last, z_low)
    e_high, z_high = e_low, z_low
    if k > 1:
        f = splat(s.slider[F_SERIES + k - 1])
        e_low, z_low = mul(f, _block(s, width, E + 1, b)), mul(f, _block(s, width, 2, b))
        if simd.ONE_REGISTER:
            e_low, z_low, e_high, z_high = _products_apart(s, width, b, k, f, e_low, z_low)
        else:
            e_low, z_low, e_high, z_high = _products(s, width, b, k, f, e_low, z_low)
        f_low, f_high = splat(s.slider[F_SERIES + 1]), splat(s.slider[F_SERIES + 2])
        e_low, z_low = fma(f_low, e_last, e_low), fma(f_low, z_last, z_low)
        e_high, z_high = fma(f_high, e_last, e_high), fma(f_high, z_last, z_high)
    store(s.modes, _E_HIGH * width + b, e_high)
    store(s.modes, _Z_HIGH * width + b, z_high)
    return e_low, z_low


@inlined
def _pending(s, width, b, e, z, carried):
    """A block's part of u'' of an order, as far as the order before determines it (lanes)."""
    known = mul(_block(s, width, _BENT, b), low_halves(z, carried))
    return fma(_block(s, width, _CORIOLIS, b), e, known)


@inlined
def _order(model, s, width, b, k, f, f0, push):
    """One block of order k >= 1; ``f`` is f_k, ``push`` is that of P_{k-1} unit / k and T_{k-1}
    unit / k.

    Takes e_k without P_{k-1}, s_k, e_{k-1} and z_k; finds e_k, z_{k+1}, s_{k+1}, and e_{k+1}
    without P_k.  Returns (lanes) the block's part of u'' of order k beyond the pending one, and
    what it leaves pending for order k + 1. Terms with P come last in every sum: that chain sets the
    pace.
    """
    e, carried = _block(s, width, E + k, b), _block(s, width, _CARRIED, b)
    e_last, z_last = _block(s, width, E + k - 1, b), _block(s, width, k, b)
    e_inner, z_inner = _inner_terms(s, width, b, k, e_last, z_last)
    part = mul(_row(model, layout.SLOPE_RATE + k, b), simd.high_halves(z_inner, e_inner))
    shift, damping = _row(model, layout.SHIFT, b), _row(model, layout.DAMPING, b)
    up, f, first = splat(s.slider[UP + k]), splat(f), splat(f0)
    e = fma(
        push, _block(s, width, _PUSHED, b) if model.coupled else _row(model, layout.FORCES, b), e
    )
    turned = simd.swap_halves(fma(f, _block(s, width, 0, b), carried))
    z_next = mul(fma(shift, turned, e), up)
    carried = fma(first, z_next, fma(f, _block(s, width, 1, b), z_inner))
    free = fma(_row(model, layout.STIFFNESS, b), z_last, mul(damping, e))
    turned = simd.swap_halves(fma(first, e, fma(f, _block(s, width, E, b), e_inner)))
    e_next = mul(sub(mul(shift, turned), free), up)
    store(s.modes, (E + k) * width + b, e)
    store(s.modes, (k + 1) * width + b, z_next)
    store(s.modes, (E + k + 1) * width + b, e_next)
    store(s.modes, _CARRIED * width + b, carried)
    return part, _pending(s, width, b, e_next, z_next, carried)


@inlined
def _axisymmetric_mode(model, s, k, j, impulse):
    at, up, force, damping = (
        j * ROWS + k,
        s.slider[UP + k],
        item(model.mode_amplitude0, j),
        item(model.damping0, j),
    )
    g, pull = item(s.g, at), item(model.stiffness0, j) * item(s.y, at)
    part = -force * (damping * g + pull)
    g -= force * impulse
    put(s.g, at, g)
    put(s.y, at + 1, g * up)
    put(s.g, at + 1, -(damping * g + pull) * up)
    return part


@inlined
def _axisymmetric(model, s, k, impulse):
    """Modes without nodal diameter, which only feel P, order k.  Returns their part of u'' without
    P_{k-1}."""
    n = len(model.mode_amplitude0)
    if n == 1:  # the usual case; a loop costs as much again
        return _axisymmetric_mode(model, s, k, 0, impulse)
    part = 0.0
    for j in range(n):
        part += _axisymmetric_mode(model, s, k, j, impulse)
    return part


@inlined
def _begin_orders(model, s, f0, braked):
    """Order 0 of all modes: z_1, s_1, and e_1 without P_0. ``braked`` is T / V, or 1 where that is
    not constant: under the normal force, or if friction falls. Returns u'' without P and f', the
    part of u'' pending for order 1 (lanes), and the factors of f_k and of (k + 1) f_k in u''."""
    width, zero = lane_count(model), splat(0.0)
    now, pending, by_e, by_z, by_z1 = zero, zero, zero, zero, zero
    first, up = splat(f0), splat(s.slider[UP])
    for b in range(0, width, WIDTH):
        z, e, shift = _block(s, width, 0, b), _block(s, width, E, b), _row(model, layout.SHIFT, b)
        slope, bend = _row(model, layout.DW_DTHETA, b), _row(model, layout.BEND, b)
        if model.coupled:
            forces = mul(low_halves(splat(1.0), splat(braked)), _row(model, layout.FORCES, b))
            store(s.modes, _PUSHED * width + b, forces)
        z_next = mul(fma(first, mul(shift, simd.swap_halves(z)), e), up)
        bound = fma(_row(model, layout.DAMPING, b), e, mul(_row(model, layout.STIFFNESS, b), z))
        e_next = mul(sub(mul(first, mul(shift, simd.swap_halves(e))), bound), up)
        carried = mul(first, z_next)
        store(s.modes, width + b, z_next)
        store(s.modes, (E + 1) * width + b, e_next)
        store(s.modes, _CARRIED * width + b, carried)
        coriolis = fma(splat(2.0 * f0), slope, _row(model, layout.MINUS_AMPLITUDE_DAMPING, b))
        bent = fma(first, simd.swap_halves(bend), _row(model, layout.MINUS_AMPLITUDE_STIFFNESS, b))
        store(s.modes, _CORIOLIS * width + b, coriolis)
        store(s.modes, _BENT * width + b, bent)
        pending = add(pending, _pending(s, width, b, e_next, z_next, carried))
        now = add(now, _pending(s, width, b, e, z, zero))
        by_e, by_z, by_z1 = fma(slope, e, by_e), fma(bend, z, by_z), fma(slope, z_next, by_z1)
    swing = total(by_e)
    by_f, by_f_rate = swing + f0 * total(by_z), total(by_z1)
    # C contains the Coriolis term once too often, because z_1 in by_f_rate includes it already
    acceleration = (
        total(now) + _axisymmetric(model, s, 0, 0.0) + f0 * (s.slider[DOWN] * by_f_rate - swing)
    )
    return acceleration, pending, by_f, by_f_rate


@inlined
def _next_order(model, s, k, f, f0, impulse, friction, pending):
    """Order k >= 1 of all modes; ``impulse``, ``friction``: P_{k-1} unit / k and T_{k-1} unit / k.
    Returns the parts of u'' of the pairs (lanes) and of the other modes, and the part pending for
    order k + 1."""
    width, push, rest = lane_count(model), splat(-impulse), splat(0.0)
    if model.normal or model.decaying:
        push = _push(model, impulse, friction)
    for b in range(0, width, WIDTH):
        more, more_rest = _order(model, s, width, b, k, f, f0, push)
        pending, rest = add(pending, more), add(rest, more_rest)
    return pending, _axisymmetric(model, s, k, impulse), rest


@inlined
def _spring(model, s, k):  # F of order k
    F_k = model.k_p * s.slider[PSI_SERIES + k] - model.c_p * s.slider[F_SERIES + k]
    if model.ramped:
        return F_k + model.c_p * s.slider[DRIVE_SERIES + k]
    return F_k + model.c_p * model.Omega if k == 0 else F_k


@inlined
def _move_slider(model, s, k, f_rate, acceleration):
    """psi, f, u, u' of order k + 1 from the rates of order k."""
    up = s.slider[UP + k]
    driven = drive(model, s) if k == 0 else 0.0
    if model.ramped and k == 1:
        driven = s.slider[DRIVE_SERIES + 1]
    s.slider[PSI_SERIES + k + 1] = (driven - s.slider[F_SERIES + k]) * up
    s.slider[F_SERIES + k + 1] = f_rate * up
    s.slider[U_SERIES + k + 1] = s.slider[V_SERIES + k] * up
    s.slider[V_SERIES + k + 1] = acceleration * up


@inlined
def _last_force(model, s, order, impulse, friction):
    """Put the last contact force and friction into the velocities of the highest order."""
    width, push = lane_count(model), _push(model, impulse, friction)
    for b in range(0, width, WIDTH):
        forced = add(_block(s, width, E + order, b), mul(push, _row(model, layout.FORCES, b)))
        store(s.modes, (E + order) * width + b, forced)
    for j in range(len(model.mode_amplitude0)):
        s.g[j * ROWS + order] -= model.mode_amplitude0[j] * impulse


@inlined
def _end_slip(model, s, order, direction, impulse, friction):
    """Complete the highest order, set the event function, and clear the order beyond the known
    ones."""
    _last_force(model, s, order, impulse, friction)
    for j in range(0, order + 1, WIDTH):
        store(s.switch, j, mul(splat(direction), load(s.f, j)))
    # remains of an earlier step in another phase
    s.slider[SWITCH + order + 1] = s.slider[P_SERIES + order] = 0.0


@inlined
def slip_series(model, s, order, direction):
    """Slip with sgn(f) = ``direction``.  Returns the denominator of P, whose zero is Painleve's
    paradox. Fills ``s`` (coefficients 0 are given) up to degree ``order``, P up to ``order - 1``,
    and the event function direction * f."""
    f0, psi = s.slider[F_SERIES], s.slider[PSI_SERIES]
    u, v, dw_dtheta = _disc_point(model, s)
    s.slider[U_SERIES], s.slider[V_SERIES] = u, v
    friction = direction * model.mu_k / model.r_0
    denominator = 1.0 + model.m * model.inverse_effective_mass + friction * dw_dtheta
    inverse, braking = 1.0 / denominator, friction / model.m
    recoil = model.inverse_effective_mass + braking * dw_dtheta
    spring, damper = model.k_p / model.m, model.c_p / model.m
    braked, damped = direction * model.mu_k, model.damped_inverse_mass
    if model.coupled:  # 2 l f_0 beta
        damped -= 2.0 * f0 * model.couple_swing * braked
    acceleration, pending, by_f, by_f_rate = _begin_orders(model, s, f0, braked)
    pull = spring * psi + damper * (drive(model, s) - f0)
    vertical = load_at(model, s) + model.k * (u - model.u_0) + model.c * v
    P = (vertical + model.m * (acceleration + dw_dtheta * pull)) * inverse
    s.slider[P_SERIES] = P
    psi = (drive(model, s) - f0) * s.slider[UP]
    by_u, by_v, by_pull, weight = (
        inverse * model.k,
        inverse * model.c,
        inverse * model.m * dw_dtheta,
        inverse * model.m,
    )
    for k in range(1, order + 1):
        up = s.slider[UP + k - 1]
        impulse, f_hat = P * up, pull * up
        u, v = v * up, acceleration * up + f_hat * dw_dtheta - recoil * impulse
        f = f_hat - braking * impulse
        s.slider[F_SERIES + k], s.slider[PSI_SERIES + k] = f, psi
        s.slider[U_SERIES + k], s.slider[V_SERIES + k] = u, v
        if k == order:
            break
        pairs, single, pending = _next_order(model, s, k, f, f0, impulse, braked * impulse, pending)
        by_speed = by_f + by_f_rate * s.slider[DOWN + k]
        acceleration = total(pairs) + (single + f * by_speed + impulse * damped)
        pull = spring * psi - damper * f
        P = weight * acceleration + (by_u * u + by_v * v + by_pull * pull)
        psi = -f * s.slider[UP + k]
        if model.ramped and k == 1:
            psi += s.slider[DRIVE_SERIES + 1] * s.slider[UP + 1]
            more_pull = damper * s.slider[DRIVE_SERIES + 1]
            pull += more_pull
            P += s.slider[LOAD_SERIES + 1] * inverse + by_pull * more_pull
        s.slider[P_SERIES + k] = P
    impulse = P * s.slider[UP + order - 1]
    _end_slip(model, s, order, direction, impulse, braked * impulse)
    return denominator


@inlined
def _stick_pending(model, b, e, z):
    """As ``_pending`` in stick, where f = 0."""
    by_z = mul(_row(model, layout.MINUS_AMPLITUDE_STIFFNESS, b), z)
    return fma(_row(model, layout.MINUS_AMPLITUDE_DAMPING, b), e, by_z)


@inlined
def _stick_order(model, s, width, b, k, push):
    """One block of order k in stick, from z_k, and e_k without what ``push`` gives. Returns its
    pending share."""
    up, z = splat(s.slider[UP + k]), _block(s, width, k, b)
    e = fma(push, _row(model, layout.FORCES, b), _block(s, width, E + k, b))
    z_next = mul(e, up)
    bound = fma(_row(model, layout.DAMPING, b), e, mul(_row(model, layout.STIFFNESS, b), z))
    e_next = sub(splat(0.0), mul(bound, up))
    store(s.modes, (E + k) * width + b, e)
    store(s.modes, (k + 1) * width + b, z_next)
    store(s.modes, (E + k + 1) * width + b, e_next)
    return _stick_pending(model, b, e_next, z_next)


@inlined
def _stick_friction(model, s, k):
    """T of order k in stick, V being known: r_0 F; under the normal force r_0 F - beta R, with R =
    V + beta T."""
    T = 0.0
    if k == 0:
        T = model.r_0 * (model.k_p * s.slider[PSI_SERIES] + model.c_p * drive(model, s))
    elif k == 1:
        T = model.r_0 * model.k_p * drive(model, s) * model.unit
        if model.ramped:
            T += model.r_0 * model.c_p * s.slider[DRIVE_SERIES + 1]
    elif model.ramped and k == 2:
        T = model.r_0 * model.k_p * s.slider[DRIVE_SERIES + 1] * s.slider[UP + 1]
    if model.normal:
        s.slider[SLOPE_SERIES + k] = _slope(model, s, k)
        beta, V = s.slider[SLOPE_SERIES], s.slider[P_SERIES + k] + _leverage(s, k, FRICTION_SERIES)
        T = (T - _leverage(s, k, NORMAL_SERIES) - beta * V) / (1.0 + beta * beta)
        s.slider[FRICTION_SERIES + k], s.slider[NORMAL_SERIES + k] = T, V + beta * T
    return T


@inlined
def stick_series(model, s, order):
    """Stick: f = 0, the slider rests on the disc.  Fills both release functions mu_s P -/+ r_0
    F."""
    width, zero = lane_count(model), splat(0.0)
    u, v, _ = _disc_point(model, s)
    s.slider[U_SERIES], s.slider[V_SERIES] = u, v
    inverse = 1.0 / (1.0 + model.m * model.inverse_effective_mass)
    weight = model.m * inverse
    by_force = inverse * (
        model.m * model.damped_inverse_mass - model.c * model.inverse_effective_mass
    )
    pending, impulse, friction, vertical = (
        zero,
        0.0,
        0.0,
        load_at(model, s) + model.k * (u - model.u_0) + model.c * v,
    )
    for b in range(0, width, WIDTH):
        pending = add(
            pending, _stick_pending(model, b, _block(s, width, E, b), _block(s, width, 0, b))
        )
    for k in range(order):
        push, part, pending = _push(model, impulse, friction), pending, zero
        for b in range(0, width, WIDTH):
            pending = add(pending, _stick_order(model, s, width, b, k, push))
        single, up = _axisymmetric(model, s, k, impulse), s.slider[UP + k]
        modes = total(part)
        acceleration = modes + (single + impulse * model.damped_inverse_mass)
        P = impulse * by_force + (weight * modes + (vertical + model.m * single) * inverse)
        s.slider[P_SERIES + k] = P
        s.slider[SWITCH + k] = s.slider[SWITCH2 + k] = model.mu_s * P
        impulse = P * up
        if model.coupled:
            friction = _stick_friction(model, s, k) * up
        u, v_hat = v * up, acceleration * up
        v = v_hat - model.inverse_effective_mass * impulse
        s.slider[U_SERIES + k + 1], s.slider[V_SERIES + k + 1] = u, v
        s.slider[F_SERIES + k], s.slider[PSI_SERIES + k + 1] = 0.0, 0.0
        # without P_k, whose share is in by_force
        vertical = model.k * u + model.c * v_hat
        if model.ramped and k == 0:
            vertical += s.slider[LOAD_SERIES + 1]
    _last_force(model, s, order, impulse, friction)
    s.slider[F_SERIES + order] = s.slider[P_SERIES + order] = s.slider[SWITCH + order] = s.slider[
        SWITCH2 + order
    ] = 0.0
    s.slider[PSI_SERIES + 1] = drive(model, s) * model.unit
    start = model.r_0 * (model.k_p * s.slider[PSI_SERIES] + model.c_p * drive(model, s))
    growth = model.r_0 * model.k_p * s.slider[PSI_SERIES + 1]
    if model.ramped:
        s.slider[PSI_SERIES + 2] = s.slider[DRIVE_SERIES + 1] * s.slider[UP + 1]
        growth += model.r_0 * model.c_p * s.slider[DRIVE_SERIES + 1]
        bend = model.r_0 * model.k_p * s.slider[PSI_SERIES + 2]
        s.slider[SWITCH + 2] -= bend
        s.slider[SWITCH2 + 2] += bend
    s.slider[SWITCH] -= start
    s.slider[SWITCH2] += start
    s.slider[SWITCH + 1] -= growth
    s.slider[SWITCH2 + 1] += growth


@inlined
def separation_series(model, s, order):
    """No contact: P = 0, disc and slider move independently.  Fills the gap u - w."""
    n, f0, weight = (
        len(model.mode_amplitude0),
        s.slider[F_SERIES],
        load_at(model, s) - model.k * model.u_0,
    )
    pull = model.k_p * s.slider[PSI_SERIES] + model.c_p * (drive(model, s) - f0)
    _, pending, _, _ = _begin_orders(model, s, f0, 0.0)
    for k in range(order + 1):
        if k > 0:
            # not by _spring: in the branches there, sums would be rounded otherwise
            pull, weight = (
                model.k_p * s.slider[PSI_SERIES + k] - model.c_p * s.slider[F_SERIES + k],
                0.0,
            )
            if model.ramped:
                pull, weight = (
                    pull + model.c_p * s.slider[DRIVE_SERIES + k],
                    s.slider[LOAD_SERIES + k],
                )
            _, _, pending = _next_order(model, s, k, s.slider[F_SERIES + k], f0, 0.0, 0.0, pending)
        gap = s.slider[U_SERIES + k] - _modal_sum(model, s, layout.AMPLITUDE_ROW, k)
        for j in range(n):
            gap -= model.mode_amplitude0[j] * s.y[j * ROWS + k]
        s.slider[SWITCH + k], s.slider[P_SERIES + k] = gap, 0.0
        vertical = weight + model.k * s.slider[U_SERIES + k] + model.c * s.slider[V_SERIES + k]
        _move_slider(model, s, k, pull / model.m, -vertical / model.m)


# ---- Contact beyond the paper: compliant, by a force normal to the bent disc, with friction that
# falls with the speed Compliant: V = (w - u) / compliance follows from the state, so that each
# order of V is known before its convolutions. Normal, with beta = B / r_0 and s = sgn(f): in slip
# the disc feels V = R (1 - s mu_k beta). The in-plane motion is braked by R (s mu_k + beta). Stick
# holds while abs(r_0 F - beta V) <= mu_s (V + r_0 F beta). Products of series with beta are the
# cost.  Rigid stick moves as under the vertical force. Falling friction: q in place of s mu_k is a
# series, T = q R. Each order of T but for q_0 R_k is known before R_k.


@inlined
def _deflection(model, s, k):
    w = _modal_sum(model, s, layout.AMPLITUDE_ROW, k)
    for j in range(len(model.mode_amplitude0)):
        w += model.mode_amplitude0[j] * s.y[j * ROWS + k]
    return w


@inlined
def _slope(model, s, k):
    return _modal_sum(model, s, layout.DW_DTHETA, k) / model.r_0


@inlined
def _closing(model, s, k):
    """Order k of the disc's velocity under the slider from the orders before: without V_{k-1} and
    f_k."""
    width = lane_count(model)
    swing = mul(_row(model, layout.DW_DTHETA, 0), _block(s, width, _CARRIED, 0))
    lanes = fma(_row(model, layout.AMPLITUDE_ROW, 0), _block(s, width, E + k, 0), swing)
    for b in range(WIDTH, width, WIDTH):
        lanes = fma(_row(model, layout.AMPLITUDE_ROW, b), _block(s, width, E + k, b), lanes)
        lanes = fma(_row(model, layout.DW_DTHETA, b), _block(s, width, _CARRIED, b), lanes)
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
def _leverage(s, k, force=P_SERIES, lever=SLOPE_SERIES):
    """Order k of beta R without beta_0 R_k, R being ``force`` and beta ``lever``, in two sums:
    neither waits."""
    odd, even = 0.0, 0.0
    for j in range(1, k, 2):
        odd += s.slider[lever + j] * s.slider[force + k - j]
        even += s.slider[lever + j + 1] * s.slider[force + k - j - 1]
    if k % 2 == 1:
        odd += s.slider[lever + k] * s.slider[force]
    return odd + even


@inlined
def _falling_part(model, s, k, direction):
    """Order k of T without q_0 R_k, where friction falls with the speed; enters that of its
    coefficient q, by (1 + d s f) (q - s mu_k) = s (mu_s - mu_k) with the model's ``decay`` d and s
    = ``direction``."""
    f0, q = s.slider[F_SERIES], COEFFICIENT_SERIES
    if k == 0:
        s.slider[q] = friction_coefficient(model, direction, f0)
        return 0.0
    change = _leverage(s, k, q, F_SERIES) - s.slider[F_SERIES + k] * direction * model.mu_k
    s.slider[q + k] = -direction * model.decay / (1.0 + direction * model.decay * f0) * change
    return _leverage(s, k, P_SERIES, q)


@inlined
def weakening(model, s, k, direction):
    """Order k of the change of T with f at the same R, where friction falls with the speed; enters
    it in the series. It is R dq/df, and (1 + d s f) dq/df = -d s (q - s mu_k)."""
    fall, at = direction * model.decay, WEAKENING_SERIES + k
    excess = s.slider[FRICTION_SERIES + k] - direction * model.mu_k * s.slider[P_SERIES + k]
    excess += _leverage(s, k, WEAKENING_SERIES, F_SERIES)
    s.slider[at] = -fall * excess / (1.0 + fall * s.slider[F_SERIES])
    return s.slider[at]


@inlined
def compliant_slip_series(model, s, order, direction):
    """Slip on a compliant contact. Returns V / R, whose zero is a jammed contact; 1 under the
    vertical force. Fills ``s`` (coefficients 0 are given) up to degree ``order``; ``P`` is R, up to
    ``order - 1``."""
    stiffness, friction = (
        1.0 / model.compliance,
        friction_coefficient(model, direction, s.slider[F_SERIES]),
    )
    lightness, lever = 1.0 / model.m, 1.0 / (model.m * model.r_0)
    f0, ratio, share, beta, V, impulse, braked, part = (
        s.slider[F_SERIES],
        1.0,
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
    )
    w, slope = _deflection(model, s, 0), model.r_0 * _slope(model, s, 0)
    closing = _modal_sum(
        model, s, layout.AMPLITUDE_ROW, E
    )  # and below, order 0 of w' but for f_0 B
    for j in range(len(model.mode_amplitude0)):
        closing += model.mode_amplitude0[j] * s.g[j * ROWS]
    share_of_V = 1.0 if model.normal or model.decaying else friction
    _, pending, _, _ = _begin_orders(model, s, f0, share_of_V)
    for k in range(order):
        f = s.slider[F_SERIES + k]
        V = (w - s.slider[U_SERIES + k]) * stiffness
        # computed before the modes: every order would wait for their sum
        w = (closing + f * slope - impulse * model.inverse_effective_mass) * s.slider[UP + k]
        if model.decaying:
            part = _falling_part(model, s, k, direction)
        if model.normal:
            s.slider[SLOPE_SERIES + k] = _slope(model, s, k)
            if k == 0:
                beta = s.slider[SLOPE_SERIES]
                ratio = 1.0 - friction * beta
                share = 1.0 / ratio
            h = _leverage(s, k)
            if model.decaying:
                R = (V + beta * part + _leverage(s, k, FRICTION_SERIES)) * share
            else:
                R = (V + friction * h) * share
            held = (friction + beta) * R + h
        else:
            R, held = V, friction * V
        T = friction * R
        if model.decaying:
            T, held = T + part, held + part
            s.slider[FRICTION_SERIES + k] = T
        s.slider[P_SERIES + k] = R
        rate = _spring(model, s, k) * lightness - held * lever
        _move_slider(model, s, k, rate, (V - _weight(model, s, k)) * lightness)
        if k > 0:
            _, _, pending = _next_order(model, s, k, f, f0, impulse, braked, pending)
        closing = _closing(model, s, k + 1)
        impulse, braked = V * s.slider[UP + k], T * s.slider[UP + k]
    _end_slip(model, s, order, direction, impulse, braked)
    return ratio


@inlined
def compliant_stick_series(model, s, order):
    """Stick on a compliant contact; ``P`` is V.  Fills both release functions."""
    width, stiffness, lightness = lane_count(model), 1.0 / model.compliance, 1.0 / model.m
    impulse, friction = 0.0, 0.0
    for k in range(order + 1):
        s.slider[F_SERIES + k], s.slider[PSI_SERIES + k + 1] = 0.0, 0.0
    s.slider[PSI_SERIES + 1] = drive(model, s) * model.unit
    if model.ramped:
        s.slider[PSI_SERIES + 2] = s.slider[DRIVE_SERIES + 1] * s.slider[UP + 1]
    for k in range(order):
        V, up = (_deflection(model, s, k) - s.slider[U_SERIES + k]) * stiffness, s.slider[UP + k]
        s.slider[P_SERIES + k] = V
        s.slider[U_SERIES + k + 1] = s.slider[V_SERIES + k] * up
        s.slider[V_SERIES + k + 1] = (V - _weight(model, s, k)) * lightness * up
        push = _push(model, impulse, friction)
        for b in range(0, width, WIDTH):
            _stick_order(model, s, width, b, k, push)
        _axisymmetric(model, s, k, impulse)
        impulse = V * up
        if model.coupled:
            friction = _stick_friction(model, s, k) * up
    _last_force(model, s, order, impulse, friction)
    s.slider[P_SERIES + order] = 0.0
    release_series(model, s, order)


@inlined
def release_series(model, s, order):
    """Release functions mu_s press -/+ pull of stick from V in ``P``: see ``laws.stick_loads``. If
    only the slope pulls at a slider that may leave the disc, divided by the common factor V: mu_s
    +/- beta."""
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
            s.slider[SWITCH + k], s.slider[SWITCH2 + k] = (
                s.slider[SLOPE_SERIES + k],
                -s.slider[SLOPE_SERIES + k],
            )
        s.slider[SWITCH] += model.mu_s
        s.slider[SWITCH2] += model.mu_s


@inlined
def rigid_slip_series(model, s, order, direction):
    """Slip in rigid contact under other laws than the paper's; ``P`` is R.  Returns the denominator
    of R.

    The recurrence is that of ``slip_series``. Under the normal force, with h_k, order k of beta R
    without beta_0 R_k,

        R_k D = (N + k (u - u_0) + c u' + m A + B F)_k + h_k ((1 + m S2) s mu_k - beta_0)

    Where friction falls with the speed, with g_k, order k of T without q_0 R_k, and j_k, that of beta T without
    beta_0 T_k, the last term is (1 + m S2) (beta_0 g_k + j_k) - beta_0 (g_k + h_k), or under the vertical force
    -beta_0 g_k.
    """
    f0, mobility, part = s.slider[F_SERIES], 1.0 + model.m * model.inverse_effective_mass, 0.0
    friction = friction_coefficient(model, direction, f0)
    s.slider[U_SERIES], s.slider[V_SERIES], slope = _disc_point(model, s)
    beta = slope / model.r_0
    s.slider[SLOPE_SERIES] = beta
    denominator = slip_denominator(model, model.m, friction, slope)
    inverse, lightness, lever = 1.0 / denominator, 1.0 / model.m, 1.0 / (model.m * model.r_0)
    inertia, pending, by_f, by_f_rate = _begin_orders(model, s, f0, 1.0)
    h, impulse, braked = 0.0, 0.0, 0.0
    for k in range(order):
        f = s.slider[F_SERIES + k]
        if model.decaying:
            part = _falling_part(model, s, k, direction)
        if k > 0:
            if model.normal:
                s.slider[SLOPE_SERIES + k] = _slope(model, s, k)
                h = _leverage(s, k)
            pairs, single, pending = _next_order(model, s, k, f, f0, impulse, braked, pending)
            by_speed = by_f + by_f_rate * s.slider[DOWN + k]
            inertia = total(pairs) + single + f * by_speed + impulse * model.damped_inverse_mass
            if model.coupled:
                inertia -= 2.0 * f0 * model.couple_swing * braked
        spring = _spring(model, s, k)
        top = _weight(model, s, k) + model.m * inertia + slope * spring
        if model.decaying:
            twist = 0.0
            if model.normal:
                twist = _leverage(s, k, FRICTION_SERIES)
                top += mobility * (beta * part + twist)
            R = (top - beta * (part + h)) * inverse
            T = friction * R + part
            V, held = R, T
            if model.normal:
                V, held = R - beta * T - twist, T + beta * R + h
            s.slider[FRICTION_SERIES + k] = T
        else:
            R = (top + h * (mobility * friction - beta)) * inverse
            V, T = R * (1.0 - friction * beta) - friction * h, friction * R
            held = (friction + beta) * R + h
        s.slider[P_SERIES + k] = R
        rate = spring * lightness - held * lever
        _move_slider(model, s, k, rate, inertia + rate * slope - model.inverse_effective_mass * V)
        impulse, braked = V * s.slider[UP + k], T * s.slider[UP + k]
    _end_slip(model, s, order, direction, impulse, braked)
    return denominator
