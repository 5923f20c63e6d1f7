"""Motions are named rightly for signals whose nature is known."""

import numpy as np
import pytest
from scipy import stats

from disc_model.analysis import classify
from disc_model.analysis.classify import motion_of, separation_location, share, zero_one
from disc_model.data.variables import Outcome


def logistic(r: float, n: int) -> np.ndarray:
    x = np.empty(n)
    x[0] = 0.3
    for i in range(1, n):
        x[i] = r * x[i - 1] * (1 - x[i - 1])
    return x[n // 4 :]


def wandering(period: int, times: int = 4) -> np.ndarray:
    """Intervals that repeat after so many."""
    return np.tile(0.03 + 0.02 * np.random.default_rng(period).standard_normal(period), times)


@pytest.mark.parametrize("period", [2, 3, 8, 12, 45, 180, 280, 499])
def test_periods_are_found_and_named(period: int) -> None:
    """The search used to end at 12 releases; motions of the paper repeat after 45, 180 and 280."""
    intervals = wandering(period, 20)[: max(2 * period + 7, 40)]
    motion = motion_of(intervals + 1e-12 * np.cos(np.arange(intervals.size)))
    assert (motion.kind, motion.period) == (Outcome.OTHER_CYCLE, period)
    assert motion.closure < 1e-8
    assert str(motion) == f"periodic, repeats after {period} releases"


def test_a_period_has_to_be_seen_twice() -> None:
    intervals = wandering(300, 2)
    assert motion_of(intervals).period == 300
    cut = motion_of(intervals[:-1])
    assert (cut.period, cut.longest) == (0, 299)


@pytest.mark.parametrize("size", [2e-5, 1e-9 * 3])
def test_the_near_returns_of_a_quasi_periodic_motion_are_no_period(size: float) -> None:
    """A rotation by (167 + 1e-3) / 1000: after 1000 steps it misses by 6e-3 of its size, to 1e-7 s."""
    alpha = (167 + 1e-3 * np.sqrt(2)) / 1000
    intervals = 7e-3 + size * np.cos(2 * np.pi * alpha * np.arange(8000))
    found = motion_of(intervals)
    assert classify.closure(intervals, 1000) < 1e-2 * size
    if size > 1e-8:
        assert (found.kind, found.period, found.longest) == (Outcome.QUASI_PERIODIC, 0, 4000)
    else:  # smaller than what a period has to close to
        assert (found.kind, found.period) == (Outcome.OTHER_CYCLE, 1)


def test_a_slow_approach_to_a_period_is_periodic_only_to_its_tolerance() -> None:
    intervals = 0.01 + 1e-4 * np.exp(-np.arange(200) / 50)
    assert motion_of(intervals, 1e-5).period == 1
    assert motion_of(intervals, 1e-9).period == 0


J = np.arange(3000)
GOLDEN = (5**0.5 - 1) / 2


@pytest.mark.parametrize(
    ("varied", "kind"),
    [
        (2e-3 * np.cos(2 * np.pi * GOLDEN * J), Outcome.QUASI_PERIODIC),
        (1e-3 * np.cos(2**0.5 * J) + 1e-3 * np.sin(3**0.5 * J), Outcome.QUASI_PERIODIC),
        (5e-3 * logistic(4.0, 3000), Outcome.IRREGULAR),
        (5e-3 * np.random.default_rng(3).random(2000), Outcome.IRREGULAR),
    ],
    ids=["two frequencies", "three frequencies", "logistic", "random"],
)
def test_what_does_not_repeat_is_quasi_periodic_or_irregular(varied: np.ndarray, kind: Outcome) -> None:
    motion = motion_of(0.01 + varied)
    assert (motion.kind, motion.period) == (kind, 0)
    assert motion.spread == pytest.approx(np.std(varied) / (0.01 + np.mean(varied)))


@pytest.mark.parametrize(("r", "expected"), [(3.55, 0.0), (3.9, 1.0), (4.0, 1.0)])
def test_zero_one_test_on_the_logistic_map(r: float, expected: float) -> None:
    assert zero_one(logistic(r, 3000)) == pytest.approx(expected, abs=0.1)


@pytest.mark.parametrize(
    ("angle", "kind", "height"),
    [
        (0.0, "rising", 0.5),
        (np.pi / 2, "at the highest position", 1.0),
        (np.pi, "falling", 0.5),
        (3 * np.pi / 2, "at the lowest position", 0.0),
        (3 * np.pi / 2 - 0.4, "at the lowest position", 0.04),
        (3 * np.pi / 2 + 0.4, "at the lowest position", 0.04),
        (3 * np.pi / 2 - 0.1 * np.pi, "at the lowest position", 0.0245),
        (3 * np.pi / 2 - 0.9, "falling", 0.19),
        (3 * np.pi / 2 + 0.9, "rising", 0.19),
    ],
)
def test_where_a_sine_loses_contact(angle: float, kind: str, height: float) -> None:
    f, rate = 100.0, 100_000.0
    time = np.arange(0, 0.2, 1 / rate)
    starts = np.round((np.arange(2, 17) + angle / (2 * np.pi)) / f * rate).astype(int)
    found = separation_location(time, 3e-3 * np.sin(2 * np.pi * f * time), starts)
    assert found.kind == kind
    assert found.height == pytest.approx(height, abs=0.01)
    ahead = np.sin(angle + np.linspace(0, np.pi, 10_000))
    assert found.to_lowest == pytest.approx((ahead[0] - ahead.min()) / 2, abs=1e-3)


# ---- shares


def test_a_share_has_wilsons_interval() -> None:
    z = stats.norm.ppf(0.95)  # two-sided, 0.9
    for k, n in ((9, 40), (1, 3), (0, 7), (7, 7)):
        centre, half = (k + z**2 / 2) / (n + z**2), z / (n + z**2) * np.sqrt(k * (n - k) / n + z**2 / 4)
        # the ends at 0 and 1 cancel to roundings here
        expected = pytest.approx((k / n, centre - half, centre + half), rel=1e-12, abs=1e-15)
        assert share(k, n, confidence=0.9) == expected
    assert share(0, 40).low == 0
    assert share(40, 40).high == 1


def test_what_is_unknown_counts_against_both_ends() -> None:
    found = share(9, 40, unknown=5)
    assert found.value == 9 / 40
    assert found.low == share(9, 45).low < share(9, 40).low
    assert found.high == share(14, 45).high > share(9, 40).high
    assert share(0, 0, unknown=3)[1:] == (0, 1)
