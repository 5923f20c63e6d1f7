"""First root of a polynomial on an interval, without missing any.

A switch function is the polynomial sum_j c[low + j] x^j on (0, x_end]: ``low`` is the multiplicity of the root it is
known to have at x = 0, divided out.  Most steps are settled by a bound; the rest by the Bernstein form, whose sign
changes count roots from above: none means no root, one means exactly one, more means halve and look again, left
half first (Descartes' rule, de Casteljau's algorithm).
"""

from __future__ import annotations

from .compile import inlined, kernel
from .lanes import WIDTH, add, item, load, minimum, mul, splat, store, total

NO_ROOT = -1.0
_NARROWEST = 2.0**-50  # in a narrower cell the sign pattern is rounding, and the cell's end decides


@inlined
def value(c, low, n, x):
    """sum_{j=low..n} c[j] x^(j-low)."""
    p = item(c, n)
    for j in range(n - 1, low - 1, -1):
        p = p * x + item(c, j)
    return p


@inlined
def set_powers(powers, x):
    """powers[j] = x^j."""
    power = 1.0
    for j in range(WIDTH):
        powers[j] = power
        power *= x
    stride, block = splat(power), load(powers, 0)
    for j in range(WIDTH, len(powers), WIDTH):
        block = mul(block, stride)
        store(powers, j, block)


@inlined
def surely_positive(c, low, n, powers):
    """True if c_0 + sum of the negative terms at the interval's end is positive: then there is no root.

    Coefficients beyond n have to be zero.
    """
    zero = splat(0.0)
    negative = zero
    for j in range(0, n + 1 - low, WIDTH):
        negative = add(negative, minimum(zero, mul(load(c, low + j), load(powers, j))))
    return max(0.0, c[low]) + total(negative) > 0.0


@kernel
def _sign_changes(b, n):
    """Number of sign changes in b[0..n], capped at two; zeros count as positive."""
    changes, positive = 0, True
    for j in range(n + 1):
        if (b[j] >= 0.0) != positive:
            positive = not positive
            changes += 1
            if changes == 2:
                return 2
    return changes


@kernel
def _to_bernstein(d, n, b):
    """Bernstein coefficients on [0, 1] of sum d_j x^j."""
    choose = 1.0
    for j in range(n + 1):
        b[j] = d[j] / choose
        choose *= (n - j) / (j + 1.0)
    for i in range(1, n + 1):
        for j in range(n, i - 1, -1):
            b[j] += b[j - 1]


@kernel
def _split(b, right, n):
    """Halve the interval: b becomes the left half's coefficients, ``right`` the right half's."""
    for i in range(n + 1):
        right[n - i] = b[n]
        for j in range(n, i, -1):
            b[j] = 0.5 * (b[j] + b[j - 1])


@inlined
def _polish(d, n, low, high, x):
    """Root between ``low`` (positive) and ``high`` (not positive), from the guess x: Halley in a shrinking bracket."""
    for _ in range(80):
        p, slope, curve = d[n], 0.0, 0.0
        for j in range(n - 1, -1, -1):
            curve = curve * x + slope
            slope = slope * x + p
            p = p * x + d[j]
        if p > 0.0:
            low = x
        else:
            high = x
        # Halley: p p' / (p'^2 - p p''/2), the loop's curve being p''/2
        new = x - p * slope / (slope * slope - p * curve)
        if not (low <= new <= high):
            new = 0.5 * (low + high)
        if abs(new - x) <= 4e-16 * x:
            return new
        x = new
    return x


@inlined
def _surely_falling(d, n):
    """True if the slope is negative all over [0, 1]: d_1 plus all positive later terms of the derivative is."""
    slope = d[1]
    for j in range(2, n + 1):
        slope += max(0.0, j * d[j])
    return slope < 0.0


@inlined
def first_root(c, low, n, x_end, powers, work):
    """Smallest x in (0, x_end] where the polynomial stops being positive, or NO_ROOT.

    c: coefficients, zero beyond n; low: known multiplicity of the root at 0; powers: x_end**j; both padded to whole
    blocks of lanes; work: shape (>= 54, >= n + 3).  A polynomial that is negative at 0 has its root there.
    """
    if surely_positive(c, low, n, powers):
        return NO_ROOT
    return _search(c, low, n, x_end, powers, work)


@kernel
def _search(c, low, n, x_end, powers, work):
    degree = n - low
    d = work[0]
    for j in range(degree + 1):
        d[j] = c[low + j] * powers[j]
    end = 0.0
    for j in range(degree + 1):
        end += d[j]
    if d[0] <= 0.0:
        return 0.0 if d[0] < 0.0 or end < 0.0 else NO_ROOT
    if _surely_falling(d, degree):
        # one root if the end is not positive, none otherwise
        return x_end * _polish(d, degree, 0.0, 1.0, d[0] / (d[0] - end)) if end <= 0.0 else NO_ROOT
    _to_bernstein(d, degree, work[2])
    root = _leftmost(d, degree, work)
    return NO_ROOT if root == NO_ROOT else x_end * root


@kernel
def _leftmost(d, n, work):
    """First root in (0, 1] of the polynomial whose Bernstein form is work[2]; NO_ROOT if there is none.

    work[2:] is a stack of cells, leftmost on top: n + 1 coefficients, left end, width.
    """
    top = 2
    work[top, n + 1], work[top, n + 2] = 0.0, 1.0
    while top >= 2:
        cell = work[top]
        low, width = cell[n + 1], cell[n + 2]
        changes = _sign_changes(cell, n)
        if cell[0] < 0.0:
            return low
        if changes == 1:
            return _polish(d, n, low, low + width, low + 0.5 * width)
        if changes == 2 and width > _NARROWEST:
            top += 1
            left = work[top]
            for j in range(n + 1):
                left[j] = cell[j]
            _split(left, cell, n)
            width *= 0.5
            left[n + 1], left[n + 2] = low, width
            cell[n + 1], cell[n + 2] = low + width, width
        elif changes == 2 and cell[n] < 0.0:
            return low + width
        else:
            top -= 1
    return NO_ROOT
