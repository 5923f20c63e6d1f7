"""Steps at which the stick-slip frequency jumps from one kind of cycle to another."""

import numpy as np
import pytest

from disc_model.analysis.frequency_jumps import frequency_jumps

GAP = np.nan

NO_JUMPS = {
    "a line": [10.0, 20.0, 30.0, 40.0],
    "flattens out": [19.8, 36.9, 50.9, 63.2, 73.4, 82.3],
    "flattens out in wide steps": [73.4, 104.8, 118.6, 124.7, 127.4],
    "wide steps from an end": [73.4, 118.5, 127.0],
    "a smooth maximum": [20.0, 24.0, 25.0, 24.5, 22.0],
    "scatters a little": [124.7, 125.4, 125.6, 125.8, 126.0, 126.5, 126.7],
    "a single step that is small": [GAP, 20.0, 21.0, GAP],
}


@pytest.mark.parametrize("name", NO_JUMPS)
def test_a_frequency_that_goes_on_does_not_jump(name: str) -> None:
    frequency = np.array(NO_JUMPS[name])
    assert not frequency_jumps(np.arange(frequency.size, dtype=float), frequency).any()


@pytest.mark.parametrize(
    ("frequency", "places"),
    [
        ([20.0, 21.0, 27.0, 28.0, 29.0], [1]),
        ([19.8, 21.0, 27.1, 23.0, 24.1], [1, 2]),
        ([GAP, 20.0, 25.0, 25.3, 25.6], [1]),
        ([GAP, 147.0, 174.0, GAP], [1]),
        ([60.0, 61.0, 62.0, 30.5, 31.0, 31.5], [2]),
    ],
    ids=["upwards", "a point by itself", "at an end", "a single step", "to half"],
)
def test_a_frequency_jumps_where_it_does_not_go_on(
    frequency: list[float], places: list[int]
) -> None:
    """It was joined there."""
    speeds = np.arange(len(frequency), dtype=float)
    assert np.flatnonzero(frequency_jumps(speeds, np.array(frequency))).tolist() == places
