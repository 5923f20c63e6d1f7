"""Motions are named rightly for signals whose nature is known; whether a record shows that one has
settled."""

from typing import Any

import numpy as np
import pytest
from scipy import stats

from disc_model.analysis import classify
from disc_model.analysis.classify import Settled, motion_of, settling
from disc_model.data.variables import Outcome

GOLDEN = (5**0.5 - 1) / 2
J = np.arange(3000)


def logistic(r: float, size: int = 3000) -> np.ndarray:
    x = np.full(size, 0.3)
    for i in range(1, x.size):
        x[i] = r * x[i - 1] * (1 - x[i - 1])
    return x[750:]


def wandering(period: int, count: int) -> np.ndarray:
    """Intervals that repeat after so many, but for 1e-12 s."""
    one = 0.03 + 0.02 * np.random.default_rng(period).standard_normal(period)
    return np.resize(one, count) + 1e-12 * np.cos(np.arange(count))


NEAR = np.cos(2 * np.pi * (167 + 1e-3 * np.sqrt(2)) / 1000 * np.arange(8000))
"""A rotation that misses after 1000 steps by 6e-3 of its size."""


@pytest.mark.parametrize(
    ("intervals", "kind", "period"),
    [
        *((wandering(n, max(2 * n, 40)), "other_cycle", n) for n in (2, 12, 45, 280, 499)),
        (wandering(300, 599), "undecided", 0),  # a period has to be seen twice
        (7e-3 + 2e-5 * NEAR, "quasi_periodic", 0),
        (7e-3 + 3e-9 * NEAR, "other_cycle", 1),  # smaller than what a period has to close to
        (0.01 + 2e-3 * np.cos(2 * np.pi * GOLDEN * J), "quasi_periodic", 0),
        (0.01 + 1e-3 * (np.cos(2**0.5 * J) + np.sin(3**0.5 * J)), "quasi_periodic", 0),
        (0.01 + 5e-3 * logistic(4.0), "irregular", 0),
        (0.01 + 5e-3 * np.random.default_rng(3).random(2000), "irregular", 0),
        (np.full(20, 0.1), "other_cycle", 1),  # the fewest intervals
    ],
)
def test_the_kind_and_the_period_of_a_motion(intervals: Any, kind: str, period: int) -> None:
    motion = motion_of(intervals)
    assert motion.period == period
    if kind != "undecided":
        assert motion.kind == Outcome(kind)
    if period:
        assert motion.closure < classify.CLOSES


def test_fewer_intervals_are_refused() -> None:
    with pytest.raises(ValueError, match=r"^19 intervals: at least 20 are needed$"):
        motion_of(np.full(19, 0.1))


@pytest.mark.parametrize(("r", "expected"), [(3.55, 0.0), (3.9, 1.0), (4.0, 1.0)])
def test_zero_one_test_on_the_logistic_map(r: float, expected: float) -> None:
    assert classify.zero_one(logistic(r)) == pytest.approx(expected, abs=0.1)


# ---- where contact is lost

RATE = 100_000.0
T = np.arange(0, 0.2, 1 / RATE)
SINE = np.sin(2 * np.pi * 100 * T)


@pytest.mark.parametrize(
    ("height", "turns", "share_of_range"),
    [
        *((SINE, np.arange(2, 17) + x, y) for x, y in ((0, 0.5), (0.25, 1), (0.5, 0.5), (0.75, 0))),
        (SINE, np.arange(2, 17) + 0.75 - 0.9 / (2 * np.pi), 0.19),
        # at a top, half a period before the amplitude grows to three times as much
        (np.where(T < 0.105, 1.0, 3.0) * SINE, np.array([10.25]), 1.0),
    ],
)
def test_where_a_sine_loses_contact(height: Any, turns: Any, share_of_range: float) -> None:
    starts = np.round(turns / 100 * RATE).astype(int)
    found = classify.separation_location(3e-3 * height, starts)
    assert found == pytest.approx(share_of_range, abs=0.01)


# ---- shares


@pytest.mark.parametrize(("k", "n"), [(9, 40), (1, 3), (0, 7), (7, 7)])
def test_a_share_has_wilsons_interval(k: int, n: int) -> None:
    z = stats.norm.ppf(0.975)  # two-sided
    centre = (k + z**2 / 2) / (n + z**2)
    half = z / (n + z**2) * np.sqrt(k * (n - k) / n + z**2 / 4)
    # the ends at 0 and 1 cancel to roundings here
    expected = pytest.approx((k / n, centre - half, centre + half), rel=1e-12, abs=1e-15)
    assert classify.share(k, n) == expected


def test_what_is_unknown_counts_against_both_ends() -> None:
    share = classify.share
    assert share(9, 40, unknown=5) == (9 / 40, share(9, 45)[1], share(14, 45)[2])
    assert share(0, 0, unknown=3)[1:] == (0, 1)


# ---- whether a record shows that a motion has settled

TIME = np.arange(0.0, 1000.0, 0.05)
TURN = 2 * np.pi
BEAT = np.sin(TURN * TIME * 0.618) * (1 + 0.1 * np.sin(TURN * TIME / 7))
NOISE = np.random.default_rng(1).standard_normal(TIME.size)
WIDTH = 2**0.5  # of a sine, twice its standard deviation


@pytest.mark.parametrize(
    ("time", "values", "answer", "rate"),
    [
        (TIME, BEAT, "settled", None),
        (TIME, 0.3 + 0.0 * TIME, "settled", None),
        (TIME, np.resize([1.0, 2.0], TIME.size), "settled", None),
        # what changes is 1e-5 of the value
        (TIME, 1 + 1e-5 * BEAT * np.exp(-TIME / 100), "settled", None),
        (TIME, BEAT * np.exp(-5e-4 * TIME), "changing", None),
        (TIME, NOISE * np.exp(5e-4 * TIME), "changing", None),
        (TIME, 3 * np.sin(TURN * TIME) + 1e-3 * TIME, "changing", 1e-3 / (3 * WIDTH)),
        (TIME, 3e6 * np.sin(TURN * TIME) + 1e3 * TIME, "changing", 1e-3 / (3 * WIDTH)),
        # at 200 N the motion decays at 0.009/s; of the greatest width that is less
        (TIME[:2000], (BEAT * np.exp(-0.009 * TIME))[:2000], "changing", -0.0061),
        (TIME[:60], (BEAT * np.exp(-0.009 * TIME))[:60], "undecided", None),  # too short
        (1e4 * np.log1p(TIME / 1e4), BEAT, "changing", None),  # events become rarer
        (TIME, NOISE * np.sin(TURN * TIME / 400), "undecided", None),  # slower than windows
        (TIME, NOISE, "undecided", None),
    ],
)
def test_what_settled_means(time: Any, values: Any, answer: str, rate: float | None) -> None:
    found = settling(time, values)
    if not np.array_equal(values, NOISE):
        assert found.answer == Settled(answer)
    assert found.answer == "changing" or found.least >= 0.0099 / np.ptp(time)
    if rate is not None:
        assert found.rate == pytest.approx(rate, rel=0.02)


def test_the_rate_of_a_change_is_that_of_a_clear_one() -> None:
    """The number of samples changes faster than the mean, but only by its scatter."""
    sizes = [60, 200, 60, 200, 60, 200, 60, 260]
    time = np.concatenate([100 * i + 100 * np.arange(n) / n for i, n in enumerate(sizes)])
    found = settling(time, np.resize([-1.0, 1.0], time.size) + 8e-4 * time)
    assert found.answer is Settled.CHANGING
    assert found.rate == pytest.approx(4e-4, rel=0.01)
    assert found.least < found.rate


def test_the_least_rate_is_the_error_of_the_slope() -> None:
    """At 99 % by Student's distribution, of means that deviate from a line."""
    time = np.linspace(0.0, 160.0, 8000)
    means = 0.1 * np.array([1, -1, -1, 1, 1, -1, -1, 1])
    found = settling(time, np.resize([-1.0, 1.0], time.size) + np.repeat(means, 1000))
    error = stats.linregress(10.0 + 20.0 * np.arange(8), means / 2).stderr
    # the quantile has four digits
    assert found.least == pytest.approx(stats.t.ppf(0.995, 6) * error, rel=1e-3)


@pytest.mark.parametrize(("until", "width"), [(0.0, 1.0), (400.0, 2.0), (100.0, 3.0)])
def test_a_motion_has_settled_since_the_part_of_the_record_that_shows_it(
    until: float, width: float
) -> None:
    found = settling(TIME, np.where(until > TIME, width, 1.0) * BEAT)
    assert found.answer is Settled.SETTLED
    # parts begin 7 % of the rest apart
    assert until <= found.since <= until + 0.08 * (1000 - until) * (until > 0)


CYCLE = np.tile([[0.0, 0.0], [1.0, 0.5], [0.3, 1.0]], (40, 1))


@pytest.mark.parametrize("start", [0, 30])
@pytest.mark.parametrize("settles", [0, 1, 17, 40])
def test_points_have_settled_from_the_first_on_the_set_of_the_later_half(
    settles: int, start: int
) -> None:
    points = CYCLE + 5.0 * (np.arange(120) < settles)[:, None]
    assert classify.first_settled(points, start) == max(settles, start)


def test_a_decaying_transient_does_not_lie_on_the_curve_on_which_it_ends() -> None:
    angle = TURN * GOLDEN * J
    curve = np.column_stack([np.cos(angle), 30 * np.sin(angle)])
    spiral = (1 + 0.5 * np.exp(-J / 100))[:, None] * curve
    # it falls to the tolerance between 0.01 of the curve's width and 0.01 of its radius
    assert 270 < classify.first_settled(spiral) <= 100 * np.log(0.5 / 0.01)


@pytest.mark.parametrize("bins", [False, True])
def test_a_run_has_settled_since_both_bodies_have(bins: bool) -> None:
    """Where its section shows nothing, as on a cycle that is locked to the drive, widths of bins do."""
    after = np.where(TIME < 300, 2.0, 1.0)
    names = [f"{name}{of}" for name in classify.SECTIONS for of in ("", "_velocity")]
    section = {"time": TIME, **dict.fromkeys(names, after * BEAT)}
    envelope = {"time": TIME, "w_point_max": after, "w_point_min": -after}
    envelope |= {"psi_max": after, "psi_min": -after}
    if bins:  # their number changes
        section = {name: x[TIME % 1 < TIME / 1e3] for name, x in section.items()}
    found = classify.settled_since(section, envelope if bins else None)
    assert 295 <= found <= 370
    few = {name: x[:20] for name, x in section.items()}
    assert np.isnan(classify.settled_since(few, None))


@pytest.mark.parametrize(
    ("found", "text"),
    [
        (classify.Motion(Outcome.OTHER_CYCLE, 1), "periodic"),
        (classify.Motion(Outcome.OTHER_CYCLE, 3), "periodic, repeats after 3 intervals"),
        (classify.Motion(Outcome.QUASI_PERIODIC), "quasi-periodic"),
        (classify.Settling(Settled.CHANGING, 0.2, 0.01), "changing at 0.2/s"),
    ],
)
def test_answers_in_words(found: object, text: str) -> None:
    assert str(found) == text
