"""Motions are named rightly for signals whose nature is known; whether a record shows that one has
settled."""

import numpy as np
import pytest
from scipy import stats

from disc_model.analysis import classify
from disc_model.analysis.classify import (
    Settled,
    motion_of,
    separation_location,
    settling,
    share,
    stages,
    zero_one,
)
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
    assert motion.kind == Outcome.OTHER_CYCLE
    assert motion.period == period
    assert motion.closure < 1e-8
    assert str(motion) == f"periodic, repeats after {period} intervals"


def test_a_period_has_to_be_seen_twice() -> None:
    intervals = wandering(300, 2)
    assert motion_of(intervals).period == 300
    cut = motion_of(intervals[:-1])
    assert cut.period == 0


@pytest.mark.parametrize("size", [2e-5, 1e-9 * 3])
def test_the_near_returns_of_a_quasi_periodic_motion_are_no_period(size: float) -> None:
    """A rotation by (167 + 1e-3) / 1000: after 1000 steps it misses by 6e-3 of its size, to 1e-7
    s."""
    alpha = (167 + 1e-3 * np.sqrt(2)) / 1000
    intervals = 7e-3 + size * np.cos(2 * np.pi * alpha * np.arange(8000))
    found = motion_of(intervals)
    assert classify.closure(intervals, 1000) < 1e-2 * size
    if size > 1e-8:
        assert found.kind == Outcome.QUASI_PERIODIC
        assert found.period == 0
    else:  # smaller than what a period has to close to
        assert found.kind == Outcome.OTHER_CYCLE
        assert found.period == 1


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
def test_what_does_not_repeat_is_quasi_periodic_or_irregular(
    varied: np.ndarray, kind: Outcome
) -> None:
    motion = motion_of(0.01 + varied)
    assert motion.kind == kind
    assert motion.period == 0


@pytest.mark.parametrize(("r", "expected"), [(3.55, 0.0), (3.9, 1.0), (4.0, 1.0)])
def test_zero_one_test_on_the_logistic_map(r: float, expected: float) -> None:
    assert zero_one(logistic(r, 3000)) == pytest.approx(expected, abs=0.1)


@pytest.mark.parametrize(
    ("angle", "share_of_range"),
    [
        (0.0, 0.5),
        (np.pi / 2, 1.0),
        (np.pi, 0.5),
        (3 * np.pi / 2, 0.0),
        (3 * np.pi / 2 - 0.4, 0.04),
        (3 * np.pi / 2 + 0.4, 0.04),
        (3 * np.pi / 2 - 0.9, 0.19),
    ],
)
def test_where_a_sine_loses_contact(angle: float, share_of_range: float) -> None:
    f = 100.0
    rate = 100_000.0
    time = np.arange(0, 0.2, 1 / rate)
    turn = 2 * np.pi
    share = angle / turn
    periods = np.arange(2, 17) + share
    starts = np.round(periods / f * rate).astype(int)
    found = separation_location(3e-3 * np.sin(2 * np.pi * f * time), starts)
    assert found == pytest.approx(share_of_range, abs=0.01)


def test_the_range_is_that_of_one_period_around_the_loss() -> None:
    """Contact is lost at the top, half a period before the amplitude grows to three times as much:
    the next top is three times as high, and outside that period."""
    f = 100.0
    rate = 100_000.0
    time = np.arange(0, 0.2, 1 / rate)
    amplitude = np.where(time < 0.105, 1.0, 3.0)
    start = round(0.1025 * rate)
    found = separation_location(amplitude * np.sin(2 * np.pi * f * time), np.array([start]))
    assert found == pytest.approx(1.0, abs=1e-3)
    with pytest.raises(ValueError, match="no separation"):
        separation_location(time, np.array([], dtype=int))


def test_the_period_is_that_of_the_dominant_oscillation() -> None:
    """Four periods of a sine that leaves at its top: half of one lies on either side, of which the
    next has three times the height."""
    share = np.arange(4000) / 4000
    height = np.where(share < 0.45, 1.0, 3.0) * np.sin(2 * np.pi * 4 * share)
    top = round(4000 * 0.3125)  # of the second period; the third begins at 0.5
    assert separation_location(height, np.array([top])) == pytest.approx(1.0, abs=1e-3)


# ---- shares


def test_a_share_has_wilsons_interval() -> None:
    z = stats.norm.ppf(0.95)  # two-sided, 0.9
    for k, n in ((9, 40), (1, 3), (0, 7), (7, 7)):
        centre = (k + z**2 / 2) / (n + z**2)
        variance = k * (n - k) / n
        quarter = z**2 / 4
        root = np.sqrt(variance + quarter)
        half = z / (n + z**2) * root
        # the ends at 0 and 1 cancel to roundings here
        expected = pytest.approx((k / n, centre - half, centre + half), rel=1e-12, abs=1e-15)
        assert share(k, n, confidence=0.9) == expected
    assert share(0, 40)[1] == 0
    assert share(40, 40)[2] == 1


def test_what_is_unknown_counts_against_both_ends() -> None:
    value, low, high = share(9, 40, unknown=5)
    assert value == 9 / 40
    assert low == share(9, 45)[1] < share(9, 40)[1]
    assert high == share(14, 45)[2] > share(9, 40)[2]
    assert share(0, 0, unknown=3)[1:] == (0, 1)


# ---- whether a record shows that a motion has settled

TIME = np.arange(0.0, 1000.0, 0.05)
TURN = 2 * np.pi
FAST = np.sin(TURN * TIME * 0.618)
SLOW = np.sin(TURN * TIME / 7)
BEAT = FAST * (1 + 0.1 * SLOW)
NOISE = np.random.default_rng(1).standard_normal(TIME.size)


@pytest.mark.parametrize(
    ("values", "answer"),
    [
        (BEAT, Settled.SETTLED),
        (0.3 + 0.0 * TIME, Settled.SETTLED),
        (np.tile([1.0, 2.0], TIME.size // 2), Settled.SETTLED),
        (
            1 + 1e-5 * BEAT * np.exp(-TIME / 100),
            Settled.SETTLED,
        ),  # what changes is 1e-5 of the value
        (BEAT * np.exp(-5e-4 * TIME), Settled.CHANGING),
        (BEAT * np.exp(5e-4 * TIME), Settled.CHANGING),
        (BEAT + 1e-3 * TIME, Settled.CHANGING),
        (NOISE * np.sin(2 * np.pi * TIME / 400), Settled.UNDECIDED),  # slower than the windows
    ],
)
def test_what_settled_means(values: np.ndarray, answer: Settled) -> None:
    found = settling(TIME, values)
    assert found.answer is answer
    assert found.least >= 0.01 / np.ptp(TIME) * (1 - 1e-12)


def test_a_decay_is_not_seen_in_a_record_that_is_much_shorter() -> None:
    """At 200 N the motion decays at 0.009/s; two segments of 1.5 s were alike, and it was called
    steady."""
    decay = BEAT * np.exp(-0.009 * TIME)
    short = TIME < 3
    assert settling(TIME[short], decay[short]).answer is Settled.UNDECIDED
    found = settling(TIME[TIME < 100], decay[TIME < 100])
    # of the greatest width
    assert found.answer == Settled.CHANGING
    assert found.rate == pytest.approx(-0.006, rel=0.2)


def test_events_that_become_rarer_are_a_change() -> None:
    assert settling(1e4 * np.log1p(TIME / 1e4), BEAT).answer is Settled.CHANGING


@pytest.mark.parametrize("size", [1e-6, 1e6])
def test_whether_a_motion_has_settled_does_not_depend_on_its_unit(size: float) -> None:
    drifting = BEAT + 1e-3 * TIME
    known = settling(TIME, drifting)
    found = settling(TIME, size * drifting)
    assert found.answer is known.answer is Settled.CHANGING
    assert found.rate == pytest.approx(known.rate, rel=1e-9)
    assert found.least == pytest.approx(known.least, rel=1e-9)


def test_the_rate_of_a_change_is_that_of_a_clear_one() -> None:
    """The number of samples changes faster than the mean, but only by its scatter, which was the least
    rate that the record was said to show."""
    sizes = [60, 200, 60, 200, 60, 200, 60, 260]
    windows = [100 * i + 100 * np.arange(n) / n for i, n in enumerate(sizes)]
    time = np.concatenate(windows)
    alternating = np.where(np.arange(time.size) % 2, 1.0, -1.0)
    found = settling(time, alternating + 8e-4 * time)
    assert found.answer is Settled.CHANGING
    # over the width of the motion, 2; windows of few samples have means that are a little off
    assert found.rate == pytest.approx(4e-4, rel=0.01)
    assert found.least < found.rate
    # an unclear change may be faster by more than 1/s
    quick = settling(time / 4000, alternating + 8e-4 * time)
    assert quick.rate == pytest.approx(4000 * found.rate, rel=1e-6)


def test_the_rate_of_a_drift_is_over_the_width_of_the_motion() -> None:
    """Twice the standard deviation of a sine, sqrt(2) of its amplitude."""
    sine = np.sin(TURN * TIME)  # a whole number of periods in each window
    found = settling(TIME, 3.0 * sine + 1e-3 * TIME)
    # within a window the drift itself adds to the width
    assert found.rate == pytest.approx(1e-3 / (3 * 2**0.5), rel=1e-3)


def test_the_error_of_a_slope_is_that_of_students_distribution() -> None:
    """At 99 %, of a line through the values in the windows."""
    freedom = classify.WINDOWS - 2
    assert stats.t.ppf(0.995, freedom) == pytest.approx(classify.QUANTILE, abs=1e-3)


def test_the_least_rate_is_the_error_of_the_slope() -> None:
    """Of means that deviate from a line, over twice the standard deviation within each window."""
    time = np.linspace(0.0, 160.0, 8000)
    alternating = np.where(np.arange(time.size) % 2, 1.0, -1.0)
    means = 0.1 * np.array([1, -1, -1, 1, 1, -1, -1, 1])
    found = settling(time, alternating + np.repeat(means, 1000))
    middles = 10.0 + 20.0 * np.arange(8)
    error = stats.linregress(middles, means / 2).stderr
    # the quantile has four digits
    assert found.least == pytest.approx(stats.t.ppf(0.995, 6) * error, rel=1e-3)


@pytest.mark.parametrize("rate", [-10 * classify.SLOWEST, 10 * classify.SLOWEST])
def test_changes_are_found_in_irregular_motions_and_their_absence_is_not_taken_for_one(
    rate: float,
) -> None:
    rng = np.random.default_rng(1)
    found = [
        settling(TIME, rng.standard_normal(TIME.size) * np.exp(rate * TIME)).answer
        for _ in range(30)
    ]
    assert found.count(Settled.CHANGING) >= 28
    still = [settling(TIME, rng.standard_normal(TIME.size)).answer for _ in range(30)]
    assert still.count(Settled.CHANGING) <= 2


def test_a_motion_has_settled_since_its_transient_is_over() -> None:
    found = settling(TIME, np.where(TIME < 400, 2.0, 1.0) * BEAT)
    assert found.answer is Settled.SETTLED
    assert 350 <= found.since <= 500


# ---- sections of known motions, and the stages of a run

PHASE = np.array([0, 1, 2, 1, 2, 0], dtype=np.int8)
SIX = np.arange(6.0)


def test_stages_before_and_after_the_first_separation() -> None:
    found = [np.flatnonzero(mask).tolist() for mask in stages(SIX, PHASE, 1.5, 6.0)]
    assert found == [[0, 1], [3, 5], [2, 4]]


def test_stages_without_separation_tell_what_has_settled() -> None:
    contact = np.zeros(6, dtype=np.int8)
    found = [np.flatnonzero(mask).tolist() for mask in stages(SIX, contact, np.nan, 3.0)]
    assert found == [[0, 1, 2], [3, 4, 5], []]
    assert stages(SIX, contact, np.nan, np.nan)[0].all()


def around(turns: float, count: int) -> np.ndarray:
    """Points of an ellipse, so many turns apart."""
    angle = 2 * np.pi * turns * np.arange(count)
    return np.column_stack([np.cos(angle), 30 * np.sin(angle)]) + 1e-5


@pytest.mark.parametrize(
    ("points", "least", "most"),
    [
        (np.empty((0, 2)), 0, 0),
        *((around(1 / period, 500), period, period) for period in (1, 2, 5)),
        (around(0.618034, 3000), 151, 399),
        (np.random.default_rng(0).random((3000, 2)), 1001, 3000),
    ],
    ids=["none", "period 1", "period 2", "period 5", "closed curve", "cloud"],
)
def test_a_section_has_as_many_points_as_its_motion_shows(
    points: np.ndarray, least: int, most: int
) -> None:
    assert least <= classify.distinct_points(points) <= most


def test_a_decaying_transient_does_not_lie_on_the_curve_on_which_it_ends() -> None:
    curve = around(0.618034, 3000)
    turns = np.arange(3000)
    spiral = (1 + 0.5 * np.exp(-turns / 100))[:, None] * curve
    # 0.5 exp(-t) falls to the tolerance between 0.01 of the curve's width and 0.01 of its radius, two and one
    assert (
        100 * np.log(0.5 / 0.02) - 50 < classify.first_settled(spiral) <= 100 * np.log(0.5 / 0.01)
    )
    assert classify.first_settled(curve) == 0
    assert classify.first_settled(spiral, 2000) == 2000


@pytest.mark.parametrize("outside", [1, 2, 17])
def test_a_motion_has_settled_from_the_first_point_after_the_last_one_outside(outside: int) -> None:
    """Points on a circle, after some far from it."""
    turn = 2 * np.pi * GOLDEN
    angle = turn * np.arange(400)
    x = np.cos(angle)
    y = np.sin(angle)
    points = np.column_stack([x, y])
    points[:outside] += 1.0
    assert classify.first_settled(points) == outside
    assert classify.first_settled(points, start=outside + 5) == outside + 5


# ---- Sections


@pytest.mark.parametrize("settles", [0, 1, 17, 40])
def test_points_have_settled_from_the_first_that_lies_on_the_set_of_the_later_half(
    settles: int,
) -> None:
    """A transient comes down to a cycle of three points: its last point away is before."""
    cycle = np.tile([[0.0, 0.0], [1.0, 0.5], [0.3, 1.0]], (40, 1))
    transient = np.zeros((120, 2))
    transient[:settles] = 5.0
    assert classify.first_settled(cycle + transient) == settles
    # not before the motion is known to have settled
    assert classify.first_settled(cycle + transient, start=30) == max(settles, 30)


def test_points_count_as_one_within_a_hundredth_of_the_range_along_every_axis() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 10.0], [1.0, 10.0]])
    near = square + np.array([0.009, 0.09])
    far = square + np.array([0.0, 0.12])
    assert classify.distinct_points(square) == 4
    assert classify.distinct_points(np.vstack([square, near])) == 4
    assert classify.distinct_points(np.vstack([square, far])) == 8
    assert classify.distinct_points(square, extent=np.array([200.0, 20.0])) == 2
    assert classify.distinct_points(np.zeros((0, 2))) == 0
    constant = np.column_stack([np.full(4, 3.0) + 1e-15 * np.arange(4), [0.0, 0, 1, 1]])
    assert classify.distinct_points(constant) == 2


def test_a_motion_has_settled_since_the_part_of_the_record_that_shows_it() -> None:
    time = np.arange(50.0, 1050.0, 0.05)
    steady = np.cos(time)
    whole = settling(time, steady)
    assert whole.answer == Settled.SETTLED
    assert whole.since == 50.0
    # its first tenth is a transient of another width
    before = np.where(time < 150, 3.0, 1.0)
    later = settling(time, before * steady)
    assert later.answer is Settled.SETTLED
    # parts begin 7 % of the rest apart
    assert 150 <= later.since < 150 + 0.08 * 900


def test_points_have_settled_on_the_later_half_of_those_from_the_start() -> None:
    """Two places, each for some time: before the start of the search the first one counts for nothing."""
    points = np.zeros((80, 2))
    points[70:] = 1.0
    points[1::2] += 0.5
    assert classify.first_settled(points, start=60) == 70


@pytest.mark.parametrize(
    ("motion", "text"),
    [
        (classify.Motion(Outcome.OTHER_CYCLE, 1), "periodic"),
        (classify.Motion(Outcome.OTHER_CYCLE, 3), "periodic, repeats after 3 intervals"),
        (classify.Motion(Outcome.QUASI_PERIODIC), "quasi-periodic"),
    ],
)
def test_a_motion_is_told_in_words(motion: classify.Motion, text: str) -> None:
    assert str(motion) == text


@pytest.mark.parametrize(
    ("settling", "text"),
    [
        (classify.Settling(Settled.CHANGING, 0.2, 0.01), "changing at 0.2/s"),
        (
            classify.Settling(Settled.UNDECIDED, -0.002, least=0.01),
            "undecided, since the record cannot show changes below 0.01/s",
        ),
        (
            classify.Settling(),
            "undecided, since a part of the record has too few events to show a change",
        ),
    ],
)
def test_whether_a_motion_has_settled_is_told_with_what_the_record_shows(
    settling: classify.Settling, text: str
) -> None:
    assert str(settling) == text


def test_twenty_intervals_are_enough_to_classify_a_motion() -> None:
    same = np.full(20, 0.1)
    found = classify.motion_of(same)
    assert found.period == 1
    with pytest.raises(ValueError, match=r"^19 intervals: at least 20 are needed$"):
        classify.motion_of(same[1:])
