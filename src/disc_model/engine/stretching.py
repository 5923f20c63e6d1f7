"""The force of a plate that stretches (von Karman's theory), a cubic form of the displacements q of
all modes, as Taylor coefficients and at an instant.

With the symmetric tensor T of the membrane energy V4 = T q q q q / 4,

    s_kl = q_k q_l,    K_ij = sum T_ijkl s_kl,    F_i = sum_j K_ij q_j,    dF_i = 3 sum_j K_ij dq_j

so that an order takes convolutions for s and F, eight side by side, and a linear map from s to K. A
vector of s and K has the products of eight "own" displacements, a block of lanes or eight times a
mode without nodal diameter, with those of a "partner": the lanes of a block exchanged, or such
a mode. Lane i of the partner r of a block is its lane i xor r, so that reflection and parity of
the nodal diameters, under which V4 does not change, leave most of T's vectors zero.

Work space is flat: F as [own][order][8], displacements as [own or partner][order][8], K as
[vector][order][8], and s as [vector][8]. That of a state has one order.
"""

from .jit import helper, inlined
from .jit.simd import (
    WIDTH,
    item,
    load,
    splat,
    spread,
    store,
    swap_halves,
    swap_pairs,
    swap_singles,
    total,
    whole,
)
from .model import MEMBRANE_GROUP, ROWS
from .series import displacement_at
from .state import displacement0_place

# ---- What others read; ``orders``: how many orders the work space has


@inlined
def membrane_force(work, orders, k, b):
    """The membrane's force of order k on the pairs of the block that begins at lane b (lanes)."""
    return load(work, b * orders + k * WIDTH)


@inlined
def membrane_force_on(work, orders, k, j):
    """The membrane's force of order k on lane j."""
    return item(work, (j - j % WIDTH) * orders + k * WIDTH + j % WIDTH)


@inlined
def membrane_force0(model, work, orders, k, j):
    """The membrane's force of order k on mode j without nodal diameter."""
    return total(membrane_force(work, orders, k, len(model.shift) + j * WIDTH))


# ---- Series and instants


@inlined
def membrane_order(model, series, k):
    """Enter the membrane's force of order k, from displacements up to that order."""
    z_at = displacement_at(k, 0)
    stride = displacement_at(0, WIDTH)
    _add_order(model, series.membrane, ROWS, k, series.modes, z_at, stride, series.y, k)


@helper
def membrane_at(model, state):
    """Enter the membrane's force at a state into its ``membrane``."""
    _add_order(model, state.membrane, 1, 0, state.z, 0, WIDTH, state.y, 0)


@inlined
def _add_order(model, work, orders, k, z, z_at, stride, y, y_at):
    """Enter displacements, s, K and F of order k.

    z, y : displacements of the pairs and of modes without nodal diameter
    z_at, y_at, stride : where they begin, and how far blocks of pairs are apart
    """
    at = model.membrane.displacements * orders + k * WIDTH
    for b in range(len(model.shift) // WIDTH):
        at = _enter_pairs(work, orders, at, load(z, z_at + b * stride))
    for j in range(len(model.mode_amplitude0)):
        store(work, at, spread(y, y_at + j * orders))
        at += orders * WIDTH
    _add_forces(model.membrane, work, orders, k)


@inlined
def _enter_pairs(work, orders, at, z):
    """Enter displacements of a block, and exchanged lanes of it. Returns the place of the next
    block."""
    stride = orders * WIDTH
    for _ in range(2):
        paired = swap_pairs(z)
        store(work, at, z)
        store(work, at + stride, swap_singles(z))
        store(work, at + 2 * stride, paired)
        store(work, at + 3 * stride, swap_singles(paired))
        z = swap_halves(z)
        at += 4 * stride
    return at


@helper
def _add_forces(m, work, orders, k):
    """Enter s, K and F of order k."""
    owns = len(m.owns)

    # s, and F without K of this order
    for own in range(owns):
        force = splat(0.0)
        for group in range(whole(m.groups, own), whole(m.groups, own + 1)):
            force = force + _group(m, work, orders, k, own, group * MEMBRANE_GROUP)
        store(work, (own * orders + k) * WIDTH, force)

    # K, and what it adds
    for own in range(owns):
        at = (own * orders + k) * WIDTH
        force = load(work, at)
        first = whole(m.groups, own) * MEMBRANE_GROUP
        for vector in range(first, whole(m.groups, own + 1) * MEMBRANE_GROUP):
            source = whole(m.sources, vector)
            K = _coefficient_at(m, orders, source) + k * WIDTH
            if source == vector:
                store(work, K, _mapped(m, work, orders, vector))
            partner = _displacement_at(m, orders, whole(m.partners, vector))
            force = force + load(work, K) * load(work, partner)
        store(work, at, force)


@inlined
def _displacement_at(m, orders, vector):
    """Place of order 0 of a vector of displacements."""
    return (m.displacements + vector * WIDTH) * orders


@inlined
def _coefficient_at(m, orders, vector):
    """Place of order 0 of a vector of K."""
    return (m.coefficients + vector * WIDTH) * orders


@inlined
def _group(m, work, orders, k, own, vector):
    """Enter s of order k for three vectors side by side. Returns the force on their own but for K
    of order k (lanes)."""
    q_at = _displacement_at(m, orders, whole(m.owns, own))
    p_first = _displacement_at(m, orders, whole(m.partners, vector)) + k * WIDTH
    p_second = _displacement_at(m, orders, whole(m.partners, vector + 1)) + k * WIDTH
    p_third = _displacement_at(m, orders, whole(m.partners, vector + 2)) + k * WIDTH
    K_first = _coefficient_at(m, orders, whole(m.sources, vector))
    K_second = _coefficient_at(m, orders, whole(m.sources, vector + 1))
    K_third = _coefficient_at(m, orders, whole(m.sources, vector + 2))
    zero = splat(0.0)
    s_first = zero
    s_second = zero
    s_third = zero
    f_first = zero
    f_second = zero
    f_third = zero
    end = k * WIDTH
    for i in range(0, end, WIDTH):
        q = load(work, q_at + i)
        p = load(work, p_first - i)
        s_first = s_first + q * p
        f_first = f_first + load(work, K_first + i) * p
        p = load(work, p_second - i)
        s_second = s_second + q * p
        f_second = f_second + load(work, K_second + i) * p
        p = load(work, p_third - i)
        s_third = s_third + q * p
        f_third = f_third + load(work, K_third + i) * p
    q = load(work, q_at + end)
    at = m.products * orders + vector * WIDTH
    store(work, at, s_first + q * load(work, p_first - end))
    store(work, at + WIDTH, s_second + q * load(work, p_second - end))
    store(work, at + 2 * WIDTH, s_third + q * load(work, p_third - end))
    return f_first + f_second + f_third


@inlined
def _mapped(m, work, orders, vector):
    """A vector of K from s (lanes)."""
    even = splat(0.0)
    odd = splat(0.0)
    products = m.products * orders
    for i in range(whole(m.begins, vector), whole(m.begins, vector + 1), 2):
        even = even + spread(work, products + whole(m.places, i)) * load(m.values, i * WIDTH)
        other = spread(work, products + whole(m.places, i + 1))
        odd = odd + other * load(m.values, (i + 1) * WIDTH)
    return even + odd


# ---- Changes


@helper
def membrane_change(model, work, orders, k, changes, at, stride, i):
    """Change of order k of the membrane's force on lane i, or on a mode without nodal diameter,
    which follow (lanes).

    changes : rows in the order of a column; at: of order k, orders being ``stride`` apart
    """
    m = model.membrane
    width = len(model.shift)
    n = width + len(model.mode_amplitude0)
    force = splat(0.0)
    for j in range(n):
        place = whole(m.table, i * n + j)
        K = _coefficient_at(m, orders, place // WIDTH) + place % WIDTH
        row = j if j < width else displacement0_place(model, j - width)
        force = force + _product(work, K, k, changes, at + row * WIDTH, stride)
    return 3.0 * force


@inlined
def _product(work, place, k, changes, at, stride):
    """Order k of a number's series times a change's (lanes); place: of order 0 of the former in
    ``work``; at: of order k of the latter, orders being ``stride`` apart."""
    lanes = splat(0.0)
    for _ in range(k + 1):
        lanes = lanes + spread(work, place) * load(changes, at)
        place += WIDTH
        at -= stride
    return lanes
