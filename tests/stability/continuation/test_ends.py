"""Which event tells why a branch ends."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from disc_model.stability.continuation import ends
from disc_model.stability.continuation.ends import Event, _first_difference
from disc_model.stability.return_map import Counts

RELEASE = Event("stick_to_slip", 0.1)
STOP = Event("slip_to_stick", 0.5)
LOSS = Event("separation", 0.3)


@pytest.mark.parametrize(
    ("beyond", "words"),
    [
        ([RELEASE, STOP], ""),
        ([RELEASE, Event("slip_to_stick", 0.504)], ""),  # it has moved a little
        ([RELEASE, LOSS, STOP], "contact is lost: the contact force touches zero"),
        ([RELEASE], "stick vanishes: the cycle touches zero slip speed"),
        ([STOP], "a grazing release: the pull touches friction's limit where stick ends"),
        ([RELEASE, STOP, Event("stick_to_slip", 0.9)], "a grazing release: during stick the pull"),
        ([RELEASE, Event("slip_to_stick", 0.4)], "a grazing stop: the cycle touches zero slip"),
    ],
)
def test_the_first_event_that_only_one_motion_has_is_told(beyond: list[Event], words: str) -> None:
    found = _first_difference([RELEASE, STOP], beyond)
    assert found.startswith(words)
    assert bool(found) is bool(words)


@pytest.mark.parametrize(
    ("releases", "backward", "period", "beyond"),
    [
        (1, 1, 1.001, 1),  # one of two forward releases has turned
        (3, -1, 0.999, 3),  # a backward one has
        (1, 0, 1.0, 0),  # a release is gone
        (1, 1, 0.5, 0),  # another motion
    ],
)
def test_a_release_that_turns_round_changes_the_number_of_releases(
    releases: int, backward: int, period: float, beyond: int
) -> None:
    def follow(_z: np.ndarray, *, tangent: bool, releases: int) -> SimpleNamespace:
        assert not tangent
        turned = releases == wanted
        counts = Counts(releases, 4 + backward, 0, 0, 2)
        return SimpleNamespace(returned=turned, period=period, counts=counts)

    wanted = releases
    problem: Any = SimpleNamespace(order=Counts(2, 4, 0, 0, 2), follow=follow)
    orbit = SimpleNamespace(period=1.0, counts=problem.order)
    last: Any = SimpleNamespace(z=np.zeros(2), tangent=np.ones(2), orbit=orbit)
    assert ends._releases_beyond_turn(problem, last, ends.SAME_TIME) == beyond


def test_an_event_of_the_cycle_that_comes_first_has_vanished() -> None:
    found = _first_difference([RELEASE, LOSS, STOP], [RELEASE, STOP])
    assert found == "a separation vanishes: the contact force touches zero"
