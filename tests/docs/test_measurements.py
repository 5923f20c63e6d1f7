"""The page on measurements says what the comparisons give."""

import re

import numpy as np
import pytest
from docs.measurements import report, signals

NUMBERS = re.compile(r"\d+(?:\.\d+)?")


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
@pytest.mark.parametrize(
    ("table", "column", "shown"),
    [
        ("thresholds", 3, (1.34, 2.19)),
        ("frequencies", 5, (0.906, 0.980)),
        ("damping", 3, (1.31, 14.66)),
        ("loads", 5, (1.43, 2.83)),
    ],
)
def test_numbers_of_the_page_are_computed(
    table: str, column: int, shown: tuple[float, float]
) -> None:
    """Least and greatest ratio of a table."""
    cells = [line.strip("| ").split("|") for line in report.SECTIONS[table]().splitlines()[2:]]
    ratios = [float(each) for row in cells for each in NUMBERS.findall(row[column])]
    assert (min(ratios), max(ratios)) == pytest.approx(shown, rel=0.02)


# ---- The methods of the comparisons


def test_slips_of_a_known_force_are_found() -> None:
    """A saw tooth that rises in 0.4 s and falls by 0.1 in a half wave of 20 ms."""
    rise = 800
    fall = 40
    periods = 5
    up = np.linspace(0.2, 0.3, rise, endpoint=False)
    angles = np.linspace(0, np.pi, fall, endpoint=False)
    down = 0.25 + 0.05 * np.cos(angles)
    force = np.tile(np.concatenate([up, down]), periods)
    force += 1e-3 * np.random.default_rng(0).normal(size=force.size)
    found = signals.slips(force)
    assert len(found) in (periods - 1, periods)  # the last one is not ended by a rise
    for slip in found:
        # noise of 0.001, of which the extremes of some samples are taken
        assert slip.before == pytest.approx(0.3, abs=4e-3)
        assert slip.after == pytest.approx(0.2, abs=4e-3)
        # from 5 to 95 % of a half wave: 1 - 2 acos(0.9) / pi of it; samples are 0.5 ms apart
        missed = 2 * np.arccos(0.9) / np.pi
        duration = 0.02 * (1 - missed)
        assert slip.duration == pytest.approx(duration, abs=2e-3)
