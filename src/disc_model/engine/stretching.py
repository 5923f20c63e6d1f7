"""The force of a plate that stretches (docs/model.md, Stretching), a cubic form of the displacements q
of all modes, as Taylor coefficients and at an instant.

With the symmetric tensor T of the membrane energy V4 = T q q q q / 4,

    s_kl = q_k q_l,    K_ij = sum T_ijkl s_kl,    F_i = sum_j K_ij q_j,    dF_i = 3 sum_j K_ij dq_j

so that an order takes convolutions for s and F, eight side by side, and a linear map from s to K. A
vector of s and K has the products of eight "own" displacements, a block of lanes or of modes without
nodal diameter, with those of a "partner": the lanes of a block exchanged, or one displacement
in all lanes. Lane i of the partner r of a block is its lane i xor r, so that reflection and parity of
the nodal diameters, under which V4 does not change, leave most of T's vectors zero.

Work space is flat: F as [block][order][8], s as [vector][8], displacements as [own or
partner][order][8], and K as [vector][order][8].
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
)
from .model import MEMBRANE_GROUP, ROWS, lane_count
from .series import displacement
from .state import HALF, displacement0_place

# ---- Where numbers stand; ``orders``: how many orders the work space has


@inlined
def _own_at(model, orders, vector, k):
    """Place of order k of a vector of displacements, counted through all owns and partners."""
    return model.membrane.displacements * orders + (vector * orders + k) * WIDTH


@inlined
def _coefficients_at(model, orders, vector, k):
    """Place of order k of a vector of K."""
    return model.membrane.coefficients * orders + (vector * orders + k) * WIDTH


@inlined
def _coefficient_of(model, orders, i, j):
    """Place of K_ij of order 0; i, j: lanes of pairs, followed by the modes without nodal
    diameter."""
    width = len(model.shift)
    if i >= width > j:
        return _coefficient_of_lane(model, orders, j, i)
    return _coefficient_of_lane(model, orders, i, j)


@inlined
def _coefficient_of_lane(model, orders, i, j):
    """As `_coefficient_of`, where i is a lane or neither is."""
    m = model.membrane
    width = len(model.shift)
    lane = i % WIDTH
    if i >= width:
        lane = (i - width) % WIDTH
        vector = m.first_single + (i - width) // WIDTH * m.single_partners + (j - width)
    elif j >= width:
        vector = i // WIDTH * m.partners + j
    else:
        vector = i // WIDTH * m.partners + (j - j % WIDTH) + (lane ^ (j % WIDTH))
    return _coefficients_at(model, orders, vector, 0) + lane


@inlined
def membrane_force(model, work, orders, k, b):
    """The membrane's force of order k on the pairs of the block that begins at lane b (lanes)."""
    return load(work, b * orders + k * WIDTH)


@inlined
def membrane_force_on(work, orders, k, j):
    """The membrane's force of order k on lane j."""
    return item(work, (j - j % WIDTH) * orders + k * WIDTH + j % WIDTH)


@inlined
def membrane_force0(model, work, orders, k, j):
    """The membrane's force of order k on mode j without nodal diameter."""
    return membrane_force_on(work, orders, k, len(model.shift) + j)


# ---- Series and instants


@inlined
def membrane_order(model, series, k):
    """Enter the membrane's force of order k, from displacements up to that order."""
    work = series.membrane
    for b in range(0, lane_count(model), WIDTH):
        _enter_pairs(model, work, ROWS, k, b, displacement(series, k, b))
    for j in range(len(model.mode_amplitude0)):
        _enter_single(model, work, ROWS, k, j, item(series.y, j * ROWS + k))
    _add_order(model, work, ROWS, k)


@helper
def membrane_at(model, state):
    """Enter the membrane's force at a state into its ``membrane``."""
    work = state.membrane
    for b in range(0, len(model.shift), WIDTH):
        _enter_pairs(model, work, 1, 0, b, load(state.z, b))
    for j in range(len(model.mode_amplitude0)):
        _enter_single(model, work, 1, 0, j, state.y[j])
    _add_order(model, work, 1, 0)


@helper
def membrane_work(model, state):
    """Return the product of the membrane's force and the displacements at a state, which is four
    times the membrane's energy, J."""
    membrane_at(model, state)
    work = 0.0
    for j in range(len(model.shift)):
        work += state.membrane[j] * state.z[j]
    for j in range(len(model.mode_amplitude0)):
        work += membrane_force0(model, state.membrane, 1, 0, j) * state.y[j]
    return work


@inlined
def _enter_pairs(model, work, orders, k, b, z):
    """Enter displacements of a block, and exchanged lanes of it."""
    at = _own_at(model, orders, b, k)
    stride = orders * WIDTH
    for _ in range(2):
        store(work, at, z)
        store(work, at + stride, swap_singles(z))
        paired = swap_pairs(z)
        store(work, at + 2 * stride, paired)
        store(work, at + 3 * stride, swap_singles(paired))
        z = swap_halves(z)
        at += 4 * stride


@inlined
def _enter_single(model, work, orders, k, j, y):
    """Enter the displacement of mode j without nodal diameter."""
    store(work, _own_at(model, orders, len(model.shift) + j, k), splat(y))
    block = model.membrane.first_own + j // WIDTH
    work[_own_at(model, orders, block, k) + j % WIDTH] = y


@helper
def _add_order(model, work, orders, k):
    """Enter s, K and F of order k."""
    m = model.membrane
    width = len(model.shift)
    products = m.products * orders

    # s, and F without K of this order
    vector = 0
    for b in range(0, width, WIDTH):
        force = splat(0.0)
        for partner in range(0, m.partners, MEMBRANE_GROUP):
            force = force + _group(model, work, orders, k, b, partner, vector)
            vector += MEMBRANE_GROUP
        store(work, b * orders + k * WIDTH, force)
    for c in range(m.single_blocks):
        force = splat(0.0)
        for partner in range(width, width + m.single_partners, MEMBRANE_GROUP):
            force = force + _group(model, work, orders, k, m.first_own + c, partner, vector)
            vector += MEMBRANE_GROUP
        store(work, (width + c * WIDTH) * orders + k * WIDTH, force)

    # K, and what it adds
    vector = 0
    for b in range(0, width, WIDTH):
        at = b * orders + k * WIDTH
        force = load(work, at)
        for partner in range(m.partners):
            K = _mapped(m, work, products, vector)
            store(work, _coefficients_at(model, orders, vector, k), K)
            force = force + K * load(work, _own_at(model, orders, partner, 0))
            vector += 1
        store(work, at, force)
    for c in range(m.single_blocks):
        at = (width + c * WIDTH) * orders + k * WIDTH
        force = load(work, at)
        for partner in range(width, width + m.single_partners):
            K = _mapped(m, work, products, vector)
            store(work, _coefficients_at(model, orders, vector, k), K)
            force = force + K * load(work, _own_at(model, orders, partner, 0))
            vector += 1
        store(work, at, force)

    # the pairs' part of the force on modes without nodal diameter
    for j in range(len(model.mode_amplitude0)):
        block = width + j // WIDTH * WIDTH
        at = block * orders + k * WIDTH + j % WIDTH
        for b in range(0, width, WIDTH):
            work[at] += _force_by_pairs(
                model, work, orders, k, b, b // WIDTH * m.partners + width + j
            )


@inlined
def _group(model, work, orders, k, own, partner, vector):
    """Enter s of order k for an own and some partners. Returns the force on the own but for K of
    order k (lanes)."""
    left = _own_at(model, orders, own, 0)
    first = _own_at(model, orders, partner, k)
    second = first + orders * WIDTH
    third = second + orders * WIDTH
    first_K = _coefficients_at(model, orders, vector, 0)
    second_K = first_K + orders * WIDTH
    third_K = second_K + orders * WIDTH
    s_first = splat(0.0)
    s_second = s_first
    s_third = s_first
    f_first = s_first
    f_second = s_first
    f_third = s_first
    for _ in range(k):
        q = load(work, left)
        p = load(work, first)
        s_first = s_first + q * p
        f_first = f_first + load(work, first_K) * p
        p = load(work, second)
        s_second = s_second + q * p
        f_second = f_second + load(work, second_K) * p
        p = load(work, third)
        s_third = s_third + q * p
        f_third = f_third + load(work, third_K) * p
        left += WIDTH
        first -= WIDTH
        second -= WIDTH
        third -= WIDTH
        first_K += WIDTH
        second_K += WIDTH
        third_K += WIDTH
    q = load(work, left)
    at = model.membrane.products * orders + vector * WIDTH
    store(work, at, s_first + q * load(work, first))
    store(work, at + WIDTH, s_second + q * load(work, second))
    store(work, at + 2 * WIDTH, s_third + q * load(work, third))
    return f_first + f_second + f_third


@inlined
def _mapped(m, work, products, vector):
    """K of a vector from s, whose first vector stands at ``products`` (lanes)."""
    even = splat(0.0)
    odd = splat(0.0)
    i = m.begins[vector]
    end = m.begins[vector + 1]
    while i < end:
        even = even + spread(work, products + m.places[i]) * load(m.values, i * WIDTH)
        odd = odd + spread(work, products + m.places[i + 1]) * load(m.values, (i + 1) * WIDTH)
        i += 2
    return even + odd


@inlined
def _force_by_pairs(model, work, orders, k, b, vector):
    """Force of order k that the pairs of a block exert by a vector of K, whose partner is a mode
    without nodal diameter, on that mode."""
    own = _own_at(model, orders, b, k)
    K = _coefficients_at(model, orders, vector, 0)
    even = splat(0.0)
    odd = splat(0.0)
    for _ in range(0, k, 2):
        even = even + load(work, K) * load(work, own)
        odd = odd + load(work, K + WIDTH) * load(work, own - WIDTH)
        own -= 2 * WIDTH
        K += 2 * WIDTH
    if k % 2 == 0:
        even = even + load(work, K) * load(work, own)
    return total(even + odd)


# ---- Changes


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


@helper
def membrane_change(model, work, orders, k, changes, at, stride, j):
    """Changes of order k of the membrane's force on a and b of the pair whose a is in lane j
    (lanes).

    changes : rows in the order of a column; at: of order k, orders being ``stride`` apart
    """
    along = splat(0.0)
    across = splat(0.0)
    width = len(model.shift)
    for i in range(width):
        if model.shift[i] > 0.0:
            # four products side by side: none waits for its last term
            aa = _coefficient_of(model, orders, j, i)
            ab = _coefficient_of(model, orders, j, i + HALF)
            ba = _coefficient_of(model, orders, j + HALF, i)
            bb = _coefficient_of(model, orders, j + HALF, i + HALF)
            da_at = at + i * WIDTH
            by_aa = splat(0.0)
            by_ab = by_aa
            by_ba = by_aa
            by_bb = by_aa
            for _ in range(k + 1):
                da = load(changes, da_at)
                db = load(changes, da_at + HALF * WIDTH)
                by_aa = by_aa + spread(work, aa) * da
                by_ab = by_ab + spread(work, ab) * db
                by_ba = by_ba + spread(work, ba) * da
                by_bb = by_bb + spread(work, bb) * db
                aa += WIDTH
                ab += WIDTH
                ba += WIDTH
                bb += WIDTH
                da_at -= stride
            along = along + (by_aa + by_ab)
            across = across + (by_ba + by_bb)
    for i in range(len(model.mode_amplitude0)):
        dy = at + displacement0_place(model, i) * WIDTH
        place = _coefficient_of(model, orders, j, width + i)
        along = along + _product(work, place, k, changes, dy, stride)
        place = _coefficient_of(model, orders, j + HALF, width + i)
        across = across + _product(work, place, k, changes, dy, stride)
    return 3.0 * along, 3.0 * across


@helper
def membrane_change0(model, work, orders, k, changes, at, stride, j):
    """As `membrane_change`, on mode j without nodal diameter."""
    change = splat(0.0)
    width = len(model.shift)
    for i in range(width):
        if model.shift[i] != 0.0:
            place = _coefficient_of(model, orders, i, width + j)
            change = change + _product(work, place, k, changes, at + i * WIDTH, stride)
    for i in range(len(model.mode_amplitude0)):
        dy = at + displacement0_place(model, i) * WIDTH
        place = _coefficient_of(model, orders, width + j, width + i)
        change = change + _product(work, place, k, changes, dy, stride)
    return 3.0 * change
