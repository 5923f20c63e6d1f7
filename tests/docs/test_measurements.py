"""The page on measurements says what the comparisons give."""

import re

import numpy as np
import pytest
from docs.measurements import report, resonances, signals

NUMBERS = re.compile(r"\d+(?:\.\d+)?")


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
@pytest.mark.parametrize(
    ("table", "column", "shown"),
    [
        ("thresholds", 3, (1.34, 2.19)),
        ("frequencies", 7, (0.906, 0.980)),
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


def test_two_close_modes_are_found_from_responses() -> None:
    """A split pair with four nodal diameters, turned by 10 degrees against the hammer."""
    frequency = np.arange(2820.0, 2880.0, 0.3333)
    angles = np.radians(np.arange(0, 180, 15))
    turned = np.radians(10)
    around = 4 * (angles - turned)
    shapes = [np.cos(around), np.sin(around)]
    omega = 2 * np.pi * frequency[:, None]
    response = np.zeros((frequency.size, angles.size), dtype=complex)
    for natural, ratio, shape in zip((2848.5, 2859.0), (0.0055, 0.0049), shapes, strict=True):
        own = 2 * np.pi * natural
        stiffness = own**2 - omega**2
        damping = 2j * ratio * own * omega
        mode = -(omega**2) / (stiffness + damping)
        response = response + mode * shape[0] * shape

    found = resonances.resonances(frequency, response, 2)
    assert found.frequency == pytest.approx([2848.5, 2859.0], abs=1e-3)
    assert found.damping == pytest.approx([0.0055, 0.0049], rel=1e-3)
    assert found.rest < 1e-6
    total = resonances.residues(found, frequency, response).sum(axis=0)
    shape = resonances.harmonic(4, angles)
    assert resonances.shape_error(total / total[0], shape) < 1e-4

    # one mode neither fits nor has a shape that is real
    one = resonances.resonances(frequency, response, 1)
    assert one.rest > 0.02
    alone = resonances.residues(one, frequency, response)[0]
    assert resonances.shape_error(alone / alone[0], shape) > 0.02
