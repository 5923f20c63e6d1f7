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
    add,
    fma,
    item,
    load,
    maximum,
    minimum,
    mul,
    powers_of,
    put,
    splat,
    spread,
    store,
    total,
)
from .layout import ROWS

NO_ROOT = -1.0
# Halley's method ends at a step of this relative size, or at one whose cube, the next step, is
# rounding, if the curvature over it is this small.
_SETTLED, _SMALL, _STRAIGHT = 4e-16, 1e-5, 1e-4
_NARROWEST = 2.0**-50  # in a narrower cell the sign pattern is rounding, and the cell's end decides
_MOST_HALVINGS = 20
_COUNT = np.arange(float(ROWS))
_HALVES = 0.5**_COUNT
_BINOMIALS = np.array(
    [[float(math.comb(j, i)) for j in range(ROWS)] for i in range(ROWS)]
)  # j over i at [i, j]
# Flat, in whole blocks of lanes: j over i at i * ROWS + j; one over (n over j), or 0 for j > n, at
# n * ROWS + j.
_CHOOSE = _BINOMIALS.ravel()
_ONE_OVER_CHOOSE = np.divide(
    1.0, _BINOMIALS.T, out=np.zeros((ROWS, ROWS)), where=_BINOMIALS.T > 0.0
).ravel()
_ONES = np.repeat([1.0, 0.0], ROWS)


@inlined
def set_powers(powers, x, n):
    """powers[j] = x^j for j <= n, and 0 up to the end of its block of lanes."""
    block, fourth = powers_of(x), x * x * (x * x)
    stride = splat(fourth * fourth)
    for j in range(0, n + 1, WIDTH):
        store(powers, j, mul(block, load(_ONES, ROWS - 1 - n + j)))
        block = mul(block, stride)


@inlined
def dot(c, first, powers, n):
    """sum_{j=0..n} c[first + j] x^j."""
    sums = splat(0.0)
    for j in range(0, n + 1, WIDTH):
        sums = fma(load(c, first + j), load(powers, j), sums)
    return total(sums)


@helper
def _sign_changes(b, n):
    """Number of sign changes in b[0..n], at most two; zeros count as positive."""
    changes, positive = 0, True
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
    even, odd = splat(0.0), splat(0.0)  # a sum's next term waits for its last one
    for i in range(0, last, 2):
        even = fma(spread(c, i), load(_CHOOSE, i * ROWS + b), even)
        odd = fma(spread(c, i + 1), load(_CHOOSE, (i + 1) * ROWS + b), odd)
    if last % 2 == 0:
        even = fma(spread(c, last), load(_CHOOSE, last * ROWS + b), even)
    return add(even, odd)


@helper
def _halve(cell, left, n, work):
    """Halve the interval: ``left`` becomes the left half's coefficients, ``cell`` the right half's,
    which are those of the left half of the reversed cell; work: shape of a cell."""
    for j in range(0, n + 1, WIDTH):
        store(left, j, mul(_raised(cell, n, j), load(_HALVES, j)))
    for j in range(n + 1):
        put(work, j, item(cell, n - j))
    # last block first: a block needs those before it
    for j in range(n - n % WIDTH, -1, -WIDTH):
        store(work, j, mul(_raised(work, n, j), load(_HALVES, j)))
    for j in range(n + 1):
        put(cell, n - j, item(work, j))


@inlined
def _polish(d, n, low, high, x):
    """Root between ``low`` (positive) and ``high`` (not positive), from the guess x: Halley in a
    shrinking bracket."""
    for _ in range(80):
        p, slope, curve = item(d, n), 0.0, 0.0
        for j in range(n - 1, -1, -1):
            curve = curve * x + slope
            slope = slope * x + p
            p = p * x + item(d, j)
        low, high = (x, high) if p > 0.0 else (low, x)
        # Halley: p p' / (p'^2 - p p''/2), the loop's curve being p''/2
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
    before, after = item(b, i - 1), item(b, i)
    return (i - 1 + before / (before - after)) / n


@inlined
def first_root(c, low, n, x_end, powers, work):
    """Smallest x in (0, x_end] where the polynomial stops being positive (0 if it is negative
    there), or NO_ROOT.

    c: coefficients, zero beyond n; low: known multiplicity of the root at 0; powers: x_end**j; both
    padded to whole blocks of lanes; work: shape (>= 54, whole blocks for n + 1 coefficients and two
    more).
    """
    zero = splat(0.0)
    negative = zero
    for j in range(0, n + 1 - low, WIDTH):
        negative = add(negative, minimum(zero, mul(load(c, low + j), load(powers, j))))
    if max(0.0, c[low]) + total(negative) > 0.0:  # with all negative terms at the interval's end
        return NO_ROOT
    return _search(c, low, n, x_end, powers, work)


@inlined
def _sum_of(d, n):
    sums, blocks = splat(0.0), (n + 1) // WIDTH * WIDTH
    for j in range(0, blocks, WIDTH):
        sums = add(sums, load(d, j))
    end = total(sums)
    for j in range(blocks, n + 1):
        end += item(d, j)
    return end


@helper
def _search(c, low, n, x_end, powers, work):
    while (
        c[low] == 0.0
    ):  # exactly zero at the start: the first other coefficient says which way it leaves
        low += 1
        if low > n:
            return NO_ROOT
    if c[low] < 0.0:
        return 0.0
    degree = n - low
    d = work[0]
    for j in range(0, degree + 1, WIDTH):
        store(d, j, mul(load(c, low + j), load(powers, j)))
    end = _sum_of(d, degree)
    # a left half with a non-positive end holds the first root: far cheaper than halving the
    # Bernstein form
    for _ in range(_MOST_HALVINGS):
        for j in range(0, degree + 1, WIDTH):
            store(work[1], j, mul(load(d, j), load(_HALVES, j)))
        middle = _sum_of(work[1], degree)
        if middle > 0.0:
            break
        for j in range(0, degree + 1, WIDTH):
            store(d, j, load(work[1], j))
        x_end, end = 0.5 * x_end, middle
    zero = splat(0.0)
    rising = zero
    for j in range(0, degree + 1, WIDTH):
        rising = add(rising, maximum(zero, mul(load(d, j), load(_COUNT, j))))
    if d[1] + total(rising) < 0.0:  # with all positive terms: the slope is negative all over [0, 1]
        # one root if the end is not positive, none otherwise
        return x_end * _polish(d, degree, 0.0, 1.0, d[0] / (d[0] - end)) if end <= 0.0 else NO_ROOT
    for j in range(0, degree + 1, WIDTH):
        store(work[1], j, mul(load(d, j), load(_ONE_OVER_CHOOSE, degree * ROWS + j)))
    for j in range(0, degree + 1, WIDTH):
        store(work[2], j, _raised(work[1], degree, j))
    root = _leftmost(d, degree, work)
    if root == NO_ROOT:
        # to within rounding in the end itself: the last Bernstein coefficient, the same sum in
        # another order, is >= 0
        return x_end if end <= 0.0 else NO_ROOT
    return x_end * root


@helper
def _leftmost(d, n, work):
    """First root in (0, 1] of the polynomial whose Bernstein form is work[2]; NO_ROOT if there is
    none. work[2:] is a stack of cells, leftmost on top: coefficients in whole blocks of lanes, left
    end, width."""
    top, start = 2, work.shape[1] - 2
    work[top, start], work[top, start + 1] = 0.0, 1.0
    while top >= 2:
        cell = work[top]
        low, width = cell[start], cell[start + 1]
        changes = _sign_changes(cell, n)
        if cell[0] < 0.0:
            return low
        if changes == 1:
            return _polish(d, n, low, low + width, low + _crossing(cell, n) * width)
        if changes == 2 and width > _NARROWEST:
            top += 1
            left = work[top]
            _halve(cell, left, n, work[1])
            width *= 0.5
            left[start], left[start + 1] = low, width
            cell[start], cell[start + 1] = low + width, width
        elif changes == 2 and cell[n] < 0.0:
            return low + width
        else:
            top -= 1
    return NO_ROOT
