"""The root finder: no root missed, none invented, the first one taken."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from disc_model.engine import layout
from disc_model.engine.polynomial import NO_ROOT, dot, first_root, set_powers

DEGREE = 24


def first(coefficients, x_end: float = 1.0, low: int = 0) -> float:
    c, powers = layout.aligned(layout.ROWS), layout.aligned(layout.ROWS)
    c[: len(coefficients)] = coefficients
    set_powers(powers, x_end, DEGREE)
    return first_root(c, low, DEGREE, x_end, powers, np.zeros((56, layout.ROWS)))


def from_roots(roots) -> np.ndarray:
    """Coefficients, lowest first, positive at 0."""
    c = np.polynomial.polynomial.polyfromroots(roots)
    return c if c[0] > 0 else -c


roots_apart = st.lists(st.floats(-2, 3), min_size=1, max_size=6)


@given(roots_apart, st.floats(0.1, 3))
def test_first_of_well_separated_roots_is_found(roots: list[float], x_end: float) -> None:
    ordered = np.sort(roots)
    # what lies closer than this to another root or to an end cannot be told from rounding of the coefficients
    assume(
        np.all(np.diff(ordered) > 1e-3) and np.all(np.abs(ordered) > 1e-3) and np.all(np.abs(ordered - x_end) > 1e-6)
    )
    inside = ordered[(ordered > 0) & (ordered <= x_end)]
    got = first(from_roots(roots), x_end)
    if len(inside):
        # coefficients of size 3^6 with rounding 1e-16, slopes down to 1e-3^5: six digits
        assert got == pytest.approx(inside[0], abs=1e-6)
    else:
        assert got == NO_ROOT


def test_powers_beyond_the_order_are_zero_and_leave_what_stands_behind_a_series_out() -> None:
    powers, c = np.full(24, np.nan), np.arange(1.0, 25.0)
    set_powers(powers, 1.3, 18)
    # a power of 18 is the product of up to six rounded ones
    np.testing.assert_allclose(powers[:19], 1.3 ** np.arange(19), rtol=2e-15)
    assert (powers[19:] == 0).all()
    assert dot(c, 0, powers, 18) == pytest.approx(np.polyval(c[18::-1], 1.3), rel=1e-14)


@pytest.mark.parametrize("apart", [1e-2, 1e-4, 1e-6])
def test_a_short_dip_below_zero_is_not_stepped_over(apart: float) -> None:
    assert first(from_roots([0.7, 0.7 + apart])) == pytest.approx(0.7, abs=1e-9 / apart)


def test_a_dip_that_stays_above_zero_is_no_root() -> None:
    c = from_roots([0.7, 0.7])
    c[0] += 1e-12
    assert first(c) == NO_ROOT


def test_high_degree_oscillation() -> None:
    # cos(4 x) + 0.9 falls through zero once near x = 0.67, comes back, and so on
    k = np.arange(DEGREE + 1)
    factorial = np.cumprod(np.maximum(k, 1.0))
    c = np.where(k % 4 == 0, 1.0, np.where(k % 4 == 2, -1.0, 0.0)) * 4.0**k / factorial
    c[0] += 0.9
    assert first(c, 3.0) == pytest.approx(np.arccos(-0.9) / 4, abs=1e-12)


def test_the_last_step_to_a_root_is_small_enough() -> None:
    # half a bounce, sin(x) / x, which ends at pi; 24 terms of it are right to 4^25 / 25! = 7e-11
    k = np.arange(DEGREE)
    c = np.where(k % 2 == 0, (-1.0) ** (k // 2), 0.0) / np.cumprod(k + 1.0)
    root = first(c, 3.5)
    assert root == pytest.approx(np.pi, abs=1e-10)
    # a step of 1e-5 over which the slope changes by 1e-4 of itself leaves 1e-13 at most
    slope = np.polynomial.polynomial.polyval(root, np.polynomial.polynomial.polyder(c))
    assert abs(np.polynomial.polynomial.polyval(root, c) / slope) < 1e-13 * root


def test_known_root_at_the_start_is_divided_out() -> None:
    c = from_roots([0.5, 2.0])
    gap = np.concatenate(([0.0, 0.0, 0.0], c))  # x^3 (x - 1/2) (x - 2)
    assert first(gap, 1.0, low=3) == pytest.approx(0.5, abs=1e-14)
    assert first(gap, 0.4, low=3) == NO_ROOT


@pytest.mark.parametrize(("coefficients", "root"), [([-1.0, 3.0], 0.0), ([0.0], NO_ROOT), ([1.0, -1.0], 1.0)])
def test_roots_at_either_end_of_a_step_belong_to_it(coefficients: list[float], root: float) -> None:
    """Negative at the start is a root there; zero throughout is none."""
    assert first(coefficients) == pytest.approx(root, abs=1e-15)
