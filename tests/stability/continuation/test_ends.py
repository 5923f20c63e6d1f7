"""Which event tells why a branch ends."""

import pytest

from disc_model.stability.continuation.ends import Event, _first_difference

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


def test_an_event_of_the_cycle_that_comes_first_has_vanished() -> None:
    found = _first_difference([RELEASE, LOSS, STOP], [RELEASE, STOP])
    assert found == "a separation vanishes: the contact force touches zero"
