"""Measures of signals and sections, for those of known kinds."""

from typing import Any

import numpy as np
import pytest

from disc_model.analysis.spectra import Line, lines
from workflow.paper.signals import chance, coverage, distinct_points, power_share, strongest

TIME = np.arange(40_000) / 4000
NOISE = np.random.default_rng(3).standard_normal(TIME.size)


def sine(frequency: float) -> np.ndarray:
    return np.sin(2 * np.pi * frequency * TIME)


@pytest.mark.parametrize(
    ("values", "least", "most"),
    [
        (sine(67.63) + 0.1 * sine(135.3), 0.0, 0.06),
        (NOISE, 0.95, 1.0),
        (sine(9.5), 0.0, 0.0),  # the skirt of a line beside the band is no line of the band
    ],
)
def test_coverage_tells_lines_from_noise(values: Any, least: float, most: float) -> None:
    assert least <= coverage(TIME, values, 10, 300) <= most


def test_the_share_of_power_above_a_frequency() -> None:
    values = sine(50) + 3 * sine(500)
    assert power_share(TIME, values, above=200, reference=20) == pytest.approx(0.9, abs=1e-3)


def test_a_line_stands_out_or_it_is_noise() -> None:
    """Amplitudes of 0.02 are ten times the noise of unit variance in a bin."""
    values = NOISE + 0.2 * sine(100)
    assert chance(TIME, values, strongest(TIME, values, 100, 1), 1) < 1e-9
    found = [chance(TIME, NOISE, strongest(TIME, NOISE, f, 1), 1) for f in range(100, 400, 5)]
    assert min(found) > 1e-4  # the least of sixty is about 1/60
    assert np.median(found) > 0.1
    with pytest.raises(ValueError, match="no bin of the spectrum is 1 to 6 Hz from 100 Hz"):
        chance(TIME[:100], NOISE[:100], Line(100, 1), 1)


def test_what_stands_on_the_skirt_of_a_line_is_no_evidence() -> None:
    for off in (2.4, 2.7, 3.0):
        values = sine(206 - off) * np.exp(-TIME) + 1e-4 * NOISE
        for line in lines(TIME, values, above=204, below=208, floor=0.0):
            assert chance(TIME, values, line, 2) > 1e-3


SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 10.0], [1.0, 10.0]])
CONSTANT = np.column_stack([3.0 + 1e-15 * np.arange(4), [0.0, 0, 1, 1]])


@pytest.mark.parametrize(
    ("points", "share", "count"),
    [
        (np.zeros((0, 2)), 0.01, 0),
        (np.vstack([SQUARE, np.add(SQUARE, [0.009, 0.09])]), 0.01, 4),
        (np.vstack([SQUARE, np.add(SQUARE, [0.0, 0.12])]), 0.01, 8),
        (SQUARE, 1.5, 1),
        (CONSTANT, 0.01, 2),
    ],
)
def test_points_count_as_one_within_a_share_of_the_range_along_every_axis(
    points: np.ndarray, share: float, count: int
) -> None:
    assert distinct_points(points, share) == count
