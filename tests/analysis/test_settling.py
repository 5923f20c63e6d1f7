"""Whether a record shows that a motion has settled."""

import numpy as np
import pytest

from disc_model.analysis.classify import SLOWEST, Settled, settling

TIME = np.arange(0.0, 1000.0, 0.05)
BEAT = np.sin(2 * np.pi * TIME * 0.618) * (1 + 0.1 * np.sin(2 * np.pi * TIME / 7))
NOISE = np.random.default_rng(1).standard_normal(TIME.size)


@pytest.mark.parametrize(
    ("values", "answer"),
    [
        (BEAT, Settled.SETTLED),
        (0.3 + 0.0 * TIME, Settled.SETTLED),
        (np.tile([1.0, 2.0], TIME.size // 2), Settled.SETTLED),
        (1 + 1e-5 * BEAT * np.exp(-TIME / 100), Settled.SETTLED),  # what changes is 1e-5 of the value
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
    """At 200 N the motion decays at 0.009/s; two segments of 1.5 s were alike, and it was called steady."""
    decay, short = BEAT * np.exp(-0.009 * TIME), TIME < 3
    assert settling(TIME[short], decay[short]).answer is Settled.UNDECIDED
    found = settling(TIME[TIME < 100], decay[TIME < 100])
    assert (found.answer, found.rate) == (Settled.CHANGING, pytest.approx(-0.006, rel=0.2))  # of the greatest width


def test_events_that_become_rarer_are_a_change() -> None:
    assert settling(1e4 * np.log1p(TIME / 1e4), BEAT).answer is Settled.CHANGING


@pytest.mark.parametrize("rate", [-10 * SLOWEST, 10 * SLOWEST])
def test_changes_are_found_in_irregular_motions_and_their_absence_is_not_taken_for_one(rate: float) -> None:
    rng = np.random.default_rng(1)
    found = [settling(TIME, rng.standard_normal(TIME.size) * np.exp(rate * TIME)).answer for _ in range(30)]
    assert found.count(Settled.CHANGING) >= 28
    still = [settling(TIME, rng.standard_normal(TIME.size)).answer for _ in range(30)]
    assert still.count(Settled.CHANGING) <= 2


def test_a_motion_has_settled_since_its_transient_is_over() -> None:
    found = settling(TIME, np.where(TIME < 400, 2.0, 1.0) * BEAT)
    assert found.answer is Settled.SETTLED
    assert 350 <= found.since <= 500
