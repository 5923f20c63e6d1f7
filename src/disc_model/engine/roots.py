"""First root of a polynomial on an interval, without missing any.

An event function is the polynomial sum_j c[low + j] x^j on (0, x_end]: ``low`` is the multiplicity
of its known root at x = 0, divided out.  A bound settles most steps. The others need the Bernstein
form, whose sign changes bound the number of roots from above; with more than one the interval is
halved, left half first (Descartes' rule, de Casteljau's algorithm).

With S the sum of the moduli of all terms at x_end, the polynomial is nowhere below -2e-15 S before
the root returned, or before x_end if there is none; and at that root it is not above 2e-15 S.  A
root in x_end may be left to the next step, which starts there.
"""

import math

import numpy as np

from .jit import helper, inlined
from .jit.simd import (
    WIDTH,
    item,
    load,
    maximum,
    minimum,
    powers_of,
    put,
    splat,
    spread,
    store,
    total,
)
from .model import ROWS

NO_ROOT = -1.0
# Halley's method ends at a step of this relative size, or at one whose cube, the next step, is
# rounding, if the curvature over it is this small.
_SETTLED = 4e-16
_SMALL = 1e-5
_STRAIGHT = 1e-4
_MOST_STEPS = 80
_NARROWEST = 2.0**-50  # in a narrower cell the sign pattern is rounding, and the cell's end decides
_MOST_HALVINGS = 20
_COUNT = np.arange(float(ROWS))
_HALVES = 0.5**_COUNT
# j over i at [i, j]
_BINOMIALS = np.array([[math.comb(j, i) for j in range(ROWS)] for i in range(ROWS)], dtype=float)
# Flat, in whole blocks of lanes: j over i at i * ROWS + j; one over (n over j), or 0 for j > n, at
# n * ROWS + j.
_CHOOSE = _BINOMIALS.ravel()
_ONE_OVER_CHOOSE = np.divide(
    1.0, _BINOMIALS.T, out=np.zeros((ROWS, ROWS)), where=_BINOMIALS.T > 0.0
).ravel()
_ONES = np.repeat([1.0, 0.0], ROWS)


# ---- Powers and values


@inlined
def set_powers(powers, x, n):
    """Set powers[j] = x^j for j <= n, and 0 up to the end of its block of lanes."""
    fourth = x * x * (x * x)
    stride = splat(fourth * fourth)
    block = powers_of(x)
    for j in range(0, n + 1, WIDTH):
        store(powers, j, block * load(_ONES, ROWS - 1 - n + j))
        block = block * stride


@inlined
def dot(c, first, powers, n):
    """Return sum_{j=0..n} c[first + j] x^j."""
    sums = splat(0.0)
    for j in range(0, n + 1, WIDTH):
        sums = sums + load(c, first + j) * load(powers, j)
    return total(sums)


@inlined
def _sum_of(d, n):
    """Value at 1 of the polynomial with the coefficients d[0..n]."""
    sums = splat(0.0)
    blocks = (n + 1) // WIDTH * WIDTH
    for j in range(0, blocks, WIDTH):
        sums = sums + load(d, j)
    value = total(sums)
    for j in range(blocks, n + 1):
        value += item(d, j)
    return value


@inlined
def _scale(d, by, first, n, out):
    """Set out[j] = d[j] by[first + j] for j <= n, in whole blocks of lanes."""
    for j in range(0, n + 1, WIDTH):
        store(out, j, load(d, j) * load(by, first + j))


# ---- The Bernstein form


@helper
def _sign_changes(b, n):
    """Return the number of sign changes in b[0..n], at most two; zeros count as positive."""
    changes = 0
    positive = True
    for j in range(n + 1):
        if (b[j] >= 0.0) != positive:
            positive = not positive
            changes += 1
            if changes == 2:
                return 2
    return changes


@inlined
def _raised(c, n, b):
    """Lanes b..b+7 of sum_i (j over i) c[i], i <= n, equal to ``n`` rounds of adding neighbours."""
    last = min(n, b + WIDTH - 1)
    # a sum's next term waits for its last one
    even = splat(0.0)
    odd = splat(0.0)
    for i in range(0, last, 2):
        even = even + spread(c, i) * load(_CHOOSE, i * ROWS + b)
        odd = odd + spread(c, i + 1) * load(_CHOOSE, (i + 1) * ROWS + b)
    if last % 2 == 0:
        even = even + spread(c, last) * load(_CHOOSE, last * ROWS + b)
    return even + odd


@helper
def _halve(cell, left, n, work):
    """Halve the interval: ``left`` becomes the left half's coefficients, ``cell`` the right half's,
    which are those of the left half of the reversed cell; work: shape of a cell."""
    for j in range(0, n + 1, WIDTH):
        store(left, j, _raised(cell, n, j) * load(_HALVES, j))
    for j in range(n + 1):
        put(work, j, item(cell, n - j))
    # last block first: a block needs those before it
    for j in range(n - n % WIDTH, -1, -WIDTH):
        store(work, j, _raised(work, n, j) * load(_HALVES, j))
    for j in range(n + 1):
        put(cell, n - j, item(work, j))


# ---- A root that is known to be alone


@inlined
def _polish(d, n, low, high, x):
    """Root between ``low`` (positive) and ``high`` (not positive), from the guess x: Halley in a
    shrinking bracket."""
    for _ in range(_MOST_STEPS):
        # value, slope and half the curvature
        p = item(d, n)
        slope = 0.0
        curve = 0.0
        for j in range(n - 1, -1, -1):
            curve = curve * x + slope
            slope = slope * x + p
            p = p * x + item(d, j)
        # in one statement: the processor cannot predict which of the two it will be
        low, high = (x, high) if p > 0.0 else (low, x)

        # Halley: p p' / (p'^2 - p p''/2)
        new = x - p * slope / (slope * slope - p * curve)
        enough = _SETTLED
        if not (low <= new <= high):
            new = 0.5 * (low + high)
        elif abs(p * curve) <= _STRAIGHT * slope * slope:
            enough = _SMALL
        if abs(new - x) <= enough * x:
            return new
        x = new
    return x


@inlined
def _crossing(b, n):
    """Zero, between 0 and 1, of the polygon through b[0..n], which changes sign once."""
    i = 1
    while item(b, i) >= 0.0:
        i += 1
    before = item(b, i - 1)
    after = item(b, i)
    return (i - 1 + before / (before - after)) / n


# ---- The first root


@inlined
def first_root(c, low, n, x_end, powers, work):
    """Smallest x in (0, x_end] where the polynomial stops being positive (0 if it is negative
    there), or NO_ROOT.

    c: coefficients; low: known multiplicity of the root at 0; powers: x_end**j, zero beyond n; both
    padded to whole blocks of lanes; work: shape (>= 54, whole blocks for n + 1 coefficients and two
    more).
    """
    zero = splat(0.0)
    negative = zero
    for j in range(0, n + 1 - low, WIDTH):
        negative = negative + minimum(zero, load(c, low + j) * load(powers, j))
    if max(0.0, c[low]) + total(negative) > 0.0:  # with all negative terms at the interval's end
        return NO_ROOT
    return _search(c, low, n, x_end, powers, work)


@helper
def _search(c, low, n, x_end, powers, work):
    """As `first_root`, where the bound does not settle it."""
    # exactly zero at the start: the first other coefficient says which way it leaves
    while c[low] == 0.0:
        low += 1
        if low > n:
            return NO_ROOT
    if c[low] < 0.0:
        return 0.0

    # the polynomial on [0, 1]
    degree = n - low
    d = work[0]
    half = work[1]
    for j in range(0, degree + 1, WIDTH):
        store(d, j, load(c, low + j) * load(powers, j))
    end = _sum_of(d, degree)

    # a left half with a non-positive end holds the first root: far cheaper than halving the
    # Bernstein form
    for _ in range(_MOST_HALVINGS):
        _scale(d, _HALVES, 0, degree, half)
        middle = _sum_of(half, degree)
        if middle > 0.0:
            break
        for j in range(0, degree + 1, WIDTH):
            store(d, j, load(half, j))
        x_end = 0.5 * x_end
        end = middle

    if _falls_throughout(d, degree):
        if end > 0.0:
            return NO_ROOT
        return x_end * _polish(d, degree, 0.0, 1.0, d[0] / (d[0] - end))
    root = _leftmost(d, degree, work)
    if root == NO_ROOT:
        # to within rounding in the end itself: the last Bernstein coefficient, the same sum in
        # another order, is >= 0
        return x_end if end <= 0.0 else NO_ROOT
    return x_end * root


@inlined
def _falls_throughout(d, n):
    """Whether the slope is negative all over [0, 1], even with all its positive terms."""
    zero = splat(0.0)
    rising = zero
    for j in range(0, n + 1, WIDTH):
        rising = rising + maximum(zero, load(d, j) * load(_COUNT, j))
    return d[1] + total(rising) < 0.0


@helper
def _leftmost(d, n, work):
    """First root in (0, 1] of the polynomial with the coefficients d; NO_ROOT if there is none.

    work[2:] becomes a stack of cells, leftmost on top: coefficients of the Bernstein form on the
    cell in whole blocks of lanes, left end, width.
    """
    spare = work[1]
    _scale(d, _ONE_OVER_CHOOSE, n * ROWS, n, spare)
    for j in range(0, n + 1, WIDTH):
        store(work[2], j, _raised(spare, n, j))
    top = 2
    start = work.shape[1] - 2
    work[top, start] = 0.0
    work[top, start + 1] = 1.0
    while top >= 2:
        cell = work[top]
        low = cell[start]
        width = cell[start + 1]
        changes = _sign_changes(cell, n)
        if cell[0] < 0.0:
            return low
        if changes == 1:
            return _polish(d, n, low, low + width, low + _crossing(cell, n) * width)
        if changes == 2 and width > _NARROWEST:
            # the left half on top of the right one
            top += 1
            left = work[top]
            _halve(cell, left, n, spare)
            width *= 0.5
            left[start] = low
            left[start + 1] = width
            cell[start] = low + width
            cell[start + 1] = width
        elif changes == 2 and cell[n] < 0.0:
            return low + width
        else:
            top -= 1
    return NO_ROOT
