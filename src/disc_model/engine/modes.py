"""The recurrence of the disc's modes: Taylor coefficients of one order from those before, eight
lanes at a time.

In slip and separation the modes turn with the place of contact on the material, at the rate g of the
state, here called f, so that their equations have products of series with f. In stick they are
linear. The vertical force V acts on both, and the horizontal force H where the surface moves
(docs/model.md, Disc in the slider's frame and Friction on the surface). Displacements of the pairs,
a and b in lanes, are called z, their velocities, alpha and beta, e; those of the modes without
nodal diameter y and g.

The contact force of order k needs u'' of the disc under the slider, a sum over all modes, and every
quantity of order k + 1 needs the contact force. This chain would leave the arithmetic units idle.
The sum is therefore taken over the terms known before V_{k-1}, whose contribution is a known
constant (``damped_inverse_mass``), and terms from order k - 1 are collected while that order is
processed ("pending"). The convolutions of f with z and e, nearly all of the work, are computed for
two orders at once.

With C = 2 f_0 slope - amplitude damping and s_k = sum_{j=1..k} f_{k-j} z_j, the disc's part of u''
at order k is

    sum(C e_k + f_0 bend s_k - amplitude stiffness z_k + slope (E_k + (k+1) Z_k))
        + f_k (sum(slope e_0) + f_0 sum(bend z_0) + (k+1) sum(slope z_1))

where E_k, Z_k are the inner terms of the convolutions sum f_{k-i} e_i, sum f_{k-i} z_{i+1}, 1 <= i
<= k - 1. Where the surface moves, its acceleration along the path is gathered in the same way, and
called "along": the part of G at order k is

    sum((tangential damping + f_0 turn) e_k + tangential stiffness z_k + turn E_k) + f_k sum(turn e_0)

Rows of the model are named as in `model`.
"""

from typing import NamedTuple

from .jit import inlined, simd
from .jit.simd import WIDTH, item, load, low_halves, put, splat, spread, swap_halves, total
from .model import (
    AMPLITUDE,
    BEND,
    DAMPING,
    FORCES,
    MINUS_AMPLITUDE_DAMPING,
    MINUS_AMPLITUDE_STIFFNESS,
    ROWS,
    SHIFT,
    SLOPE,
    SLOPE_RATE,
    STIFFNESS,
    TANGENTIAL,
    TANGENTIAL_DAMPING,
    TANGENTIAL_STIFFNESS,
    TANGENTIAL_TURN,
    constants,
    is_rigid,
    lane_count,
)
from .series import (
    ALONG_BY_VELOCITY,
    BY_DISPLACEMENT,
    BY_VELOCITY,
    CARRIED,
    INNER_DISPLACEMENT,
    INNER_VELOCITY,
    ORDER,
    displacement,
    hand_on,
    handed_on,
    put_displacement,
    put_velocity,
    velocity,
    velocity_at,
)
from .stretching import membrane_force, membrane_force0, membrane_order

# ---- Sums over all modes


@inlined
def _sum_of_displacements(model, series, row, k):
    """Sum of a row of the model times the displacements of the pairs of order k."""
    lanes = splat(0.0)
    for b in range(0, lane_count(model), WIDTH):
        lanes = lanes + constants(model, row, b) * displacement(series, k, b)
    return total(lanes)


@inlined
def deflection(model, series, k):
    """w, the disc's displacement under the slider, of order k."""
    w = _sum_of_displacements(model, series, AMPLITUDE, k)
    for j in range(len(model.mode_amplitude0)):
        w += model.mode_amplitude0[j] * series.y[j * ROWS + k]
    return w


@inlined
def slope(model, series, k):
    """B, the disc's slope dw/dtheta under the slider, of order k."""
    return _sum_of_displacements(model, series, SLOPE, k)


@inlined
def rest_on_disc(model, series, B):
    """Set u, u' of order 0 to those of the disc under the slider, on the slope B, if contact is
    rigid."""
    if is_rigid(model):
        velocities = splat(0.0)
        for b in range(0, lane_count(model), WIDTH):
            velocities = velocities + constants(model, AMPLITUDE, b) * velocity(series, 0, b)
        v = total(velocities) + series.f[0] * B
        for j in range(len(model.mode_amplitude0)):
            v += model.mode_amplitude0[j] * series.g[j * ROWS]
        series.u[0] = deflection(model, series, 0)
        series.v[0] = v


@inlined
def largest_velocity(model, series, k):
    """Largest modulus among the modal velocities of order k."""
    biggest = splat(0.0)
    for b in range(0, lane_count(model), WIDTH):
        biggest = simd.maximum(biggest, simd.absolute(velocity(series, k, b)))
    size = simd.largest(biggest)
    for j in range(len(model.mode_amplitude0)):
        size = max(size, abs(series.g[j * ROWS + k]))
    return size


# ---- Slip and separation


class Parts(NamedTuple):
    """Parts of an order of the accelerations of the disc's point under the slider (lanes)."""

    up: object  # of u''
    along: object  # of the surface along the path; zero if that does not move


class Turning(NamedTuple):
    """What the first order of the modes gives to the accelerations of the disc under the slider."""

    acceleration: float  # u'' of order 0 without V and f'
    along: float  # that of the surface along the path without H
    pending: Parts  # of order 1, as far as order 0 determines them
    by_f: float  # factor of f_k in u'' of order k
    by_f_rate: float  # factor of (k + 1) f_k / unit in u'' of order k
    along_by_f: float  # factor of f_k in the acceleration along the path of order k


@inlined
def begin_turning(model, series):
    """Order 0 of all modes: their displacements of order 1, and their velocities but for V_0 and
    H_0. Returns `Turning`."""
    f_0 = series.f[0]
    up = series.up[0]
    zero = splat(0.0)
    if model.has_stretching:
        membrane_order(model, series, 0)
    now = zero
    now_along = zero
    pending = zero
    pending_along = zero
    by_e = zero
    turning = zero
    by_z = zero
    by_z1 = zero
    for b in range(0, lane_count(model), WIDTH):
        z = displacement(series, 0, b)
        e = velocity(series, 0, b)
        shift = constants(model, SHIFT, b)
        slopes = constants(model, SLOPE, b)
        bend = constants(model, BEND, b)

        # the modes' own equations
        bound = constants(model, DAMPING, b) * e + constants(model, STIFFNESS, b) * z
        if model.has_stretching:
            bound = bound + membrane_force(series.membrane, ROWS, 0, b)
            now, now_along = _pulled_back(model, series, 0, b, now, now_along)
        z_next = (e + f_0 * (shift * swap_halves(z))) * up
        e_next = (f_0 * (shift * swap_halves(e)) - bound) * up
        carried = f_0 * z_next
        put_displacement(series, 1, b, z_next)
        put_velocity(series, 1, b, e_next)
        hand_on(series, CARRIED, b, carried)

        # factors of e_k, and of z_k and s_k, in u'' of order k
        by_velocity = constants(model, MINUS_AMPLITUDE_DAMPING, b) + (2.0 * f_0) * slopes
        by_displacement = constants(model, MINUS_AMPLITUDE_STIFFNESS, b) + f_0 * swap_halves(bend)
        hand_on(series, BY_VELOCITY, b, by_velocity)
        hand_on(series, BY_DISPLACEMENT, b, by_displacement)
        pending = pending + _known_acceleration(model, series, b, e_next, z_next, carried)
        now = now + _known_acceleration(model, series, b, e, z, zero)
        by_e = by_e + slopes * e
        by_z = by_z + bend * z
        by_z1 = by_z1 + slopes * z_next
        if model.has_moving_surface:
            turn = constants(model, TANGENTIAL_TURN, b)
            hand_on(
                series, ALONG_BY_VELOCITY, b, constants(model, TANGENTIAL_DAMPING, b) + f_0 * turn
            )
            now_along = _known_along(model, series, b, e, z, now_along)
            pending_along = _known_along(model, series, b, e_next, z_next, pending_along)
            turning = turning + turn * e
    swing = total(by_e)
    by_f = swing + f_0 * total(by_z)
    by_f_rate = total(by_z1)
    single = axisymmetric_order(model, series, 0, 0.0)
    # C contains the Coriolis term once too often, because z_1 in by_f_rate includes it already
    coriolis = f_0 * (series.down[0] * by_f_rate - swing)
    return Turning(
        acceleration=total(now) + single + coriolis,
        along=total(now_along),
        pending=Parts(pending, pending_along),
        by_f=by_f,
        by_f_rate=by_f_rate,
        along_by_f=total(turning),
    )


@inlined
def next_turning(model, series, k, f_k, V_impulse, H_impulse, pending):
    """Order k >= 1 of all modes, from the forces V and H of order k - 1 times unit / k.

    Returns the `Parts` of order k of the pairs but for the terms with f_k and with these forces, u''
    of the modes without nodal diameter but for V_{k-1}, and what is pending for order k + 1.
    """
    push = pushed(model, V_impulse, H_impulse)
    up, along = pending
    if model.has_stretching:
        membrane_order(model, series, k)
    next_up = splat(0.0)
    next_along = splat(0.0)
    for b in range(0, lane_count(model), WIDTH):
        here, following = _turning_block(model, series, b, k, f_k, push, next_along)
        up = up + here.up
        next_up = next_up + following.up
        if model.has_moving_surface:
            along = along + here.along
            next_along = following.along
    single = axisymmetric_order(model, series, k, V_impulse)
    return Parts(up, along), single, Parts(next_up, next_along)


@inlined
def _turning_block(model, series, b, k, f_k, push, next_along):
    """One block of order k >= 1.

    Takes e_k without the forces of order k - 1, s_k, e_{k-1} and z_k; finds e_k, z_{k+1}, s_{k+1},
    and e_{k+1} without the forces of order k. Returns the block's `Parts` of order k beyond the
    pending ones, and those which it leaves pending for order k + 1, along the path added to
    ``next_along`` of the blocks before. Terms with ``push`` come last in every sum: that chain sets
    the pace.
    """
    e = velocity(series, k, b)
    carried = handed_on(series, CARRIED, b)
    e_last = velocity(series, k - 1, b)
    z_last = displacement(series, k, b)
    e_inner, z_inner = _inner_terms(series, b, k, e_last, z_last)
    part = constants(model, SLOPE_RATE + k, b) * simd.high_halves(z_inner, e_inner)
    along = splat(0.0)
    if model.has_moving_surface:
        along = constants(model, TANGENTIAL_TURN, b) * e_inner
    if model.has_stretching:
        part, along = _pulled_back(model, series, k, b, part, along)

    # velocities of order k, displacements of order k + 1
    shift = constants(model, SHIFT, b)
    damping = constants(model, DAMPING, b)
    up = series.up[k]
    f_0 = series.f[0]
    e = e + push * constants(model, FORCES, b)
    turned = swap_halves(carried + f_k * displacement(series, 0, b))
    z_next = (e + shift * turned) * up
    carried = z_inner + f_k * displacement(series, 1, b) + f_0 * z_next

    # velocities of order k + 1
    bound = damping * e + constants(model, STIFFNESS, b) * z_last
    if model.has_stretching:
        bound = bound + membrane_force(series.membrane, ROWS, k, b)
    turned = swap_halves(e_inner + f_k * velocity(series, 0, b) + f_0 * e)
    e_next = (shift * turned - bound) * up
    put_velocity(series, k, b, e)
    put_displacement(series, k + 1, b, z_next)
    put_velocity(series, k + 1, b, e_next)
    hand_on(series, CARRIED, b, carried)
    next_up = _known_acceleration(model, series, b, e_next, z_next, carried)
    if model.has_moving_surface:
        next_along = _known_along(model, series, b, e_next, z_next, next_along)
    return Parts(part, along), Parts(next_up, next_along)


@inlined
def _pulled_back(model, series, k, b, up, along):
    """What the membrane's force on a block changes of the `Parts` of order k, added to these."""
    force = membrane_force(series.membrane, ROWS, k, b)
    up = up - constants(model, AMPLITUDE, b) * force
    if model.has_moving_surface:
        along = along - constants(model, TANGENTIAL, b) * force
    return up, along


@inlined
def _known_acceleration(model, series, b, e, z, carried):
    """A block's part of u'' of an order, as far as the order before determines it (lanes)."""
    known = handed_on(series, BY_DISPLACEMENT, b) * low_halves(z, carried)
    # in this order: the first of two products is added to the second one, which does not wait for e
    return handed_on(series, BY_VELOCITY, b) * e + known


@inlined
def _known_along(model, series, b, e, z, others):
    """As `_known_acceleration` for the acceleration along the path, added to that of ``others``."""
    known = others + constants(model, TANGENTIAL_STIFFNESS, b) * z
    return known + handed_on(series, ALONG_BY_VELOCITY, b) * e


@inlined
def _inner_terms(series, b, k, e_last, z_last):
    """Inner terms of order k for e and z; ``e_last``, ``z_last`` are e_{k-1} and z_k. Orders are
    taken in pairs: an odd one computes most of the next one's terms, too."""
    if k % 2 == 0:
        return _inner_of_second(series, b, k, e_last, z_last)
    return _inner_of_first(series, b, k, e_last, z_last)


@inlined
def _inner_of_first(series, b, k, e_last, z_last):
    """As `_inner_terms` for an odd order. The terms of the next order but for the first and the
    last, which need f_k and e_k, are handed on."""
    e_low = splat(0.0)
    z_low = splat(0.0)
    e_high = e_low
    z_high = z_low
    if k > 1:
        f = splat(series.f[k - 1])
        e_low = f * velocity(series, 1, b)
        z_low = f * displacement(series, 2, b)
        if simd.ONE_REGISTER:
            e_low, z_low, e_high, z_high = _products_apart(series, b, k, f, e_low, z_low)
        else:
            e_low, z_low, e_high, z_high = _products(series, b, k, f, e_low, z_low)
        e_low = e_low + series.f[1] * e_last
        z_low = z_low + series.f[1] * z_last
        e_high = e_high + series.f[2] * e_last
        z_high = z_high + series.f[2] * z_last
    hand_on(series, INNER_VELOCITY, b, e_high)
    hand_on(series, INNER_DISPLACEMENT, b, z_high)
    return e_low, z_low


@inlined
def _inner_of_second(series, b, k, e_last, z_last):
    """As `_inner_terms` for an even order: what was handed on, with the first and the last term."""
    e_inner = handed_on(series, INNER_VELOCITY, b)
    z_inner = handed_on(series, INNER_DISPLACEMENT, b)
    if k > 2:
        f = series.f[k - 1]
        e_inner = e_inner + f * velocity(series, 1, b)
        z_inner = z_inner + f * displacement(series, 2, b)
    return e_inner + series.f[1] * e_last, z_inner + series.f[1] * z_last


@inlined
def _products(series, b, k, f_high, e_low, z_low):
    """Sums with f_{k-i} e_i and f_{k-i} z_{i+1}, 2 <= i <= k - 2, of an odd order k, added to
    ``e_low``, ``z_low``, and of k + 1; f_high: f_{k-1}."""
    e_high = splat(0.0)
    z_high = splat(0.0)
    at = velocity_at(2, b)
    for i in range(2, k - 1):
        f_low = spread(series.f, k - i)
        e = load(series.modes, at)
        z = load(series.modes, at + WIDTH)
        e_low = e_low + f_low * e
        z_low = z_low + f_low * z
        e_high = e_high + f_high * e
        z_high = z_high + f_high * z
        f_high = f_low
        at += ORDER
    return e_low, z_low, e_high, z_high


@inlined
def _products_apart(series, b, k, f_high, e_low, z_low):
    """As `_products`, with separate sums for even and odd i, so that none waits for its last term:
    too many registers where lanes do not fit into one."""
    zero = splat(0.0)
    e_high = zero
    z_high = zero
    e_low2 = zero
    z_low2 = zero
    e_high2 = zero
    z_high2 = zero
    at = velocity_at(2, b)
    for i in range(2, k - 1, 2):
        f_mid = spread(series.f, k - i)
        f_low = spread(series.f, k - i - 1)
        e = load(series.modes, at)
        z = load(series.modes, at + WIDTH)
        e_low = e_low + f_mid * e
        z_low = z_low + f_mid * z
        e_high = e_high + f_high * e
        z_high = z_high + f_high * z
        e = load(series.modes, at + ORDER)
        z = load(series.modes, at + ORDER + WIDTH)
        e_low2 = e_low2 + f_low * e
        z_low2 = z_low2 + f_low * z
        e_high2 = e_high2 + f_mid * e
        z_high2 = z_high2 + f_mid * z
        f_high = f_low
        at += 2 * ORDER
    return e_low + e_low2, z_low + z_low2, e_high + e_high2, z_high + z_high2


# ---- Stick


@inlined
def begin_stick(model, series):
    """`Parts` of order 0 that the pairs give without V and H."""
    up = splat(0.0)
    along = splat(0.0)
    for b in range(0, lane_count(model), WIDTH):
        z = displacement(series, 0, b)
        e = velocity(series, 0, b)
        up = up + _acceleration_in_stick(model, b, e, z)
        if model.has_moving_surface:
            along = along + _along_in_stick(model, b, e, z)
    return Parts(up, along)


@inlined
def stretched_stick(model, series, k, parts):
    """Enter the membrane's force of order k in stick. Returns the `Parts` of order k with what it
    changes."""
    up, along = parts
    if model.has_stretching:
        membrane_order(model, series, k)
        for b in range(0, lane_count(model), WIDTH):
            up, along = _pulled_back(model, series, k, b, up, along)
    return Parts(up, along)


@inlined
def next_stick(model, series, k, V_impulse, H_impulse):
    """Order k of all modes in stick, from the forces V and H of order k - 1 times unit / k.

    Returns u'' of order k of the modes without nodal diameter but for V_{k-1}, and the `Parts` of
    the pairs for order k + 1 but for V_k and H_k.
    """
    push = pushed(model, V_impulse, H_impulse)
    up = series.up[k]
    next_up = splat(0.0)
    next_along = splat(0.0)
    for b in range(0, lane_count(model), WIDTH):
        z = displacement(series, k, b)
        e = velocity(series, k, b) + push * constants(model, FORCES, b)
        bound = constants(model, DAMPING, b) * e + constants(model, STIFFNESS, b) * z
        if model.has_stretching:
            bound = bound + membrane_force(series.membrane, ROWS, k, b)
        z_next = e * up
        e_next = 0.0 - bound * up
        put_velocity(series, k, b, e)
        put_displacement(series, k + 1, b, z_next)
        put_velocity(series, k + 1, b, e_next)
        next_up = next_up + _acceleration_in_stick(model, b, e_next, z_next)
        if model.has_moving_surface:
            next_along = next_along + _along_in_stick(model, b, e_next, z_next)
    return axisymmetric_order(model, series, k, V_impulse), Parts(next_up, next_along)


@inlined
def _acceleration_in_stick(model, b, e, z):
    """A block's part of u'' in stick (lanes)."""
    by_z = constants(model, MINUS_AMPLITUDE_STIFFNESS, b) * z
    return constants(model, MINUS_AMPLITUDE_DAMPING, b) * e + by_z


@inlined
def _along_in_stick(model, b, e, z):
    """A block's part of the acceleration along the path in stick (lanes)."""
    by_z = constants(model, TANGENTIAL_STIFFNESS, b) * z
    return constants(model, TANGENTIAL_DAMPING, b) * e + by_z


# ---- In every phase


@inlined
def surface_velocity(model, series):
    """v_s, the surface's velocity along the path, of order 0; 0 if that does not move."""
    velocities = splat(0.0)
    if model.has_moving_surface:
        for b in range(0, lane_count(model), WIDTH):
            e = velocity(series, 0, b)
            velocities = velocities + constants(model, TANGENTIAL, b) * e
    return total(velocities)


@inlined
def pushed(model, V_impulse, H_impulse):
    """Minus the impulse of V, in lanes of a, and that of H, in lanes of b: what multiplies the row
    ``FORCES`` (lanes)."""
    if model.has_moving_surface:
        return low_halves(splat(-V_impulse), splat(H_impulse))
    return splat(-V_impulse)


@inlined
def axisymmetric_order(model, series, k, V_impulse):
    """Order k of the modes without nodal diameter, which only feel V. Returns their part of u''
    without V_{k-1}."""
    n = len(model.mode_amplitude0)
    if n == 1:  # the usual case; a loop costs as much again
        return _axisymmetric_mode(model, series, k, 0, V_impulse)
    part = 0.0
    for j in range(n):
        part += _axisymmetric_mode(model, series, k, j, V_impulse)
    return part


@inlined
def _axisymmetric_mode(model, series, k, j, V_impulse):
    at = j * ROWS + k
    up = series.up[k]
    amplitude = item(model.mode_amplitude0, j)
    damping = item(model.damping0, j)
    pull = item(model.stiffness0, j) * item(series.y, at)
    if model.has_stretching:
        pull += membrane_force0(model, series.membrane, ROWS, k, j)
    g = item(series.g, at)
    part = -amplitude * (damping * g + pull)
    g -= amplitude * V_impulse
    put(series.g, at, g)
    put(series.y, at + 1, g * up)
    put(series.g, at + 1, -(damping * g + pull) * up)
    return part


@inlined
def put_last_forces(model, series, order, V_impulse, H_impulse):
    """Put the last forces V and H into the velocities of the highest order."""
    push = pushed(model, V_impulse, H_impulse)
    for b in range(0, lane_count(model), WIDTH):
        e = velocity(series, order, b) + push * constants(model, FORCES, b)
        put_velocity(series, order, b, e)
    for j in range(len(model.mode_amplitude0)):
        series.g[j * ROWS + order] -= model.mode_amplitude0[j] * V_impulse
