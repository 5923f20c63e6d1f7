"""Statements of Section 4.3 judged by made-up cases."""

import math

import pytest

from disc_model.paper.model import FALSE, PART, TRUE, Answer
from disc_model.paper.section43 import critical_speed

NAN = math.nan


def judged(*times: tuple[float, float]) -> Answer:
    """Judge the printed speed of 15 rad/s by speeds and times of first separation.

    The case of the paper separates after 100 s, and all end after 500 s.
    """
    known = {"N": 385.0, "first_separation": 100.0}
    cases = [
        {"Omega": speed, "first_separation": time, "time_reached": 500.0} for speed, time in times
    ]
    return critical_speed(known, *cases, printed=15.0, within=0.5)


@pytest.mark.parametrize(
    ("times", "verdict", "lower"),
    [
        ([(15.0, 80.0), (14.0, NAN)], TRUE, []),
        ([(15.0, 100.0), (14.0, NAN)], TRUE, []),
        ([(15.0, 120.0), (14.0, NAN)], FALSE, []),  # after the horizon
        ([(15.0, NAN), (16.0, 20.0)], FALSE, []),
        ([(16.0, 20.0), (15.0, 80.0), (14.0, 90.0)], PART, [14.0]),
        ([(15.0, 80.0), (14.0, 120.0)], TRUE, []),
        ([(15.0, 80.0), (14.6, 90.0)], TRUE, []),  # within what is printed
        ([(15.0, 80.0), (14.4, 90.0), (13.0, 100.0)], PART, [13.0, 14.4]),
        ([(15.0, 120.0), (14.0, 90.0)], FALSE, [14.0]),
        ([(15.0, 80.0), (16.0, 20.0)], TRUE, []),
    ],
)
def test_the_lowest_speed_that_separates_within_the_horizon_is_critical(
    times: list[tuple[float, float]], verdict: str, lower: list[float]
) -> None:
    found = judged(*times)
    assert found.verdict == verdict
    assert found.values["lower"] == lower
    assert found.values["never"] == sorted(speed for speed, time in times if math.isnan(time))
    known = sorted((speed, time) for speed, time in times if not math.isnan(time))
    assert found.values["rows"] == known
    assert found.values["horizon"] == 100.0
    assert found.values["end"] == 500.0
