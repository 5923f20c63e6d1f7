"""The root finder: no root missed, none invented, the first one taken."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.polynomial import polynomial

from disc_model.engine.model import ROWS
from disc_model.engine.roots import NO_ROOT, first_root, set_powers
from disc_model.engine.state import aligned

DEGREE = 24


def first(coefficients, x_end: float = 1.0, low: int = 0, degree: int = DEGREE) -> float:
    c = aligned(ROWS)
    powers = aligned(ROWS)
    c[: len(coefficients)] = coefficients
    set_powers(powers, x_end, degree)
    return first_root(c, low, degree, x_end, powers, np.zeros((56, ROWS)))


def from_roots(roots) -> np.ndarray:
    """Coefficients, lowest first, positive at 0."""
    c = polynomial.polyfromroots(roots)
    if c[0] > 0:
        return c
    return -c


# ------------------------------------------------------------------------------------ against an
# exact count
ROUNDING = Fraction(2, 10**15)
"""Of the sum of the moduli of all terms: what the module promises."""


def number_of_roots(c: list[Fraction], x: Fraction) -> int:
    """Different real roots in (0, x], by Sturm's theorem; none of them at 0."""
    chain = [np.array(c, object), polynomial.polyder(np.array(c, object))]
    while len(chain[-1]) > 1 and (rest := polynomial.polydiv(chain[-2], chain[-1])[1]).any():
        chain.append(-rest)

    def changes(x: Fraction) -> int:
        signs = [v > 0 for v in (polynomial.polyval(x, each) for each in chain) if v != 0]
        return sum(one != two for one, two in pairwise(signs))

    return changes(Fraction()) - changes(x)


def multiplied(c: list[Fraction], d: list[Fraction]) -> list[Fraction]:
    return list(polynomial.polymul(np.array(c, object), np.array(d, object)))


@st.composite
def hidden_roots(draw: st.DrawFn) -> tuple[list[float], float]:
    """A polynomial and the end of a step; roots on halving points, other dyadic places, ends,
    double, nearly double."""
    x_end = Fraction(draw(st.sampled_from([0.5, 1.0, 2.0, 3.25]) | st.floats(0.1, 8)))
    k = draw(st.integers(1, 12))
    roots = [
        x_end
        * draw(st.sampled_from([Fraction(1, 2**k), Fraction(draw(st.integers(0, 2**k)), 2**k)]))
    ]
    for _ in range(draw(st.integers(0, 3))):
        shift = Fraction(draw(st.sampled_from([0.0, 2.0 ** -draw(st.integers(5, 45))])))
        ends = x_end * draw(st.integers(1, 16)) / 16, x_end * Fraction(draw(st.floats(-2, 2)))
        roots.append(draw(st.sampled_from([roots[0] * (1 + shift), *ends])))
    c = [Fraction(draw(st.sampled_from([-1, 1])))]
    for root in roots:
        c = multiplied(c, [-root, Fraction(1)])
    if draw(st.booleans()):  # a factor without real roots
        a, b = (x_end * Fraction(draw(st.floats(0.0, 1.0))) for _ in range(2))
        c = multiplied(c, [a**2 + b**2 + x_end / 64, -2 * a, Fraction(1)])
    if c[0] < 0:
        c = [-a for a in c]
    return [float(a) for a in c], float(x_end)


@given(hidden_roots())
@example(([1.0, 0.0, -1.0], 2.0))
@example(([1.0, 0.5, -1.5], 2.0))
@example(([0.0, -1.0, 1.0], 2.0))
@example(([0.0, 1.0, -1.0], 2.0))
# an excursion that is over at the end of the step
@example(
    (
        from_roots([2.4523032796565007, 4.131641397443826, 6.296469522248217]).tolist(),
        4.9046065593130015,
    )
)
def test_no_root_is_hidden(drawn: tuple[list[float], float]) -> None:
    """Roots on halving points were passed over with whole steps: the end of what was searched read
    as positive."""
    coefficients, x_end = drawn
    got = first(coefficients, x_end)
    c = [Fraction(a) for a in coefficients]
    while c[0] == 0:
        c.pop(0)
    if c[0] < 0:
        assert got == 0.0
        return
    last = got
    if got == NO_ROOT:
        last = x_end
    until = Fraction(last)
    rounding = ROUNDING * sum(abs(a) * Fraction(x_end) ** i for i, a in enumerate(c))
    assert until > 0
    assert number_of_roots([c[0] + rounding, *c[1:]], until) == 0
    if got != NO_ROOT:
        assert polynomial.polyval(until, np.array(c, object)) <= rounding


@pytest.mark.parametrize("degree", [3, 6, 7, 8, 15, 17])
def test_the_highest_terms_of_any_degree_count(degree: int) -> None:
    """Also where they do not fill a block of lanes, and where only they bring the function down."""
    late = np.zeros(degree + 1)
    late[0] = 1.0
    late[degree] = -(1.25**degree)
    late[1] = 0.1
    root = first(late, degree=degree)
    assert polynomial.polyval(root, late) == pytest.approx(0.0, abs=1e-14 * degree)
    assert 0.8 < root < 1.0

    # two roots, so that one sign does not decide
    both = np.zeros(degree + 1)
    both[:3] = [0.56, -1.5, 1.0]
    both[degree - 2 :] += [0.56, -1.5, 1.0]
    assert first(both, degree=degree) == pytest.approx(0.7, rel=1e-13)


def test_a_pair_of_roots_early_in_a_step_is_as_precise_as_others() -> None:
    assert first(from_roots([1e-4, 1.5e-4])) == pytest.approx(1e-4, rel=1e-13)


def test_known_root_at_the_start_is_divided_out() -> None:
    c = from_roots([0.5, 2.0])
    gap = np.concatenate(([0.0, 0.0, 0.0], c))  # x^3 (x - 1/2) (x - 2)
    assert first(gap, 1.0, low=3) == pytest.approx(0.5, abs=1e-14)
    assert first(gap, 0.4, low=3) == NO_ROOT


@pytest.mark.parametrize(
    ("coefficients", "root"), [([-1.0, 3.0], 0.0), ([0.0], NO_ROOT), ([1.0, -1.0], 1.0)]
)
def test_roots_at_either_end_of_a_step_belong_to_it(coefficients: list[float], root: float) -> None:
    """Negative at the start is a root there; zero throughout is none."""
    assert first(coefficients) == pytest.approx(root, abs=1e-15)
