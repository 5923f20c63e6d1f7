"""The range at which contact is lost, against forces over time and against flights that are
integrated."""

import math

import numpy as np
import pytest

from disc_model.analysis.contact_loss import excess_of_flights, pinned_range
from disc_model.parameters import Parameters
from tests.refusals import refusal

CASE = Parameters(N=250, Omega=20)


def least_force(p: Parameters, omega: float, extent: float) -> float:
    """Least force that contact needs in a vibration of a range, from its values over a period, N."""
    angle = np.linspace(0, 2 * np.pi, 100_001)
    height = extent / 2 * np.cos(angle)
    velocity = -omega * extent / 2 * np.sin(angle)
    acceleration = -(omega**2) * height
    return float(np.min(p.N + p.k * height + p.c * velocity + p.m * acceleration))


@pytest.mark.parametrize(
    ("changes", "frequency"),
    [
        ({}, 135.42),
        ({"m": 0.01}, 300.0),  # held down by its spring
        ({"c": 20.0, "k": 2e4}, 108.0),
        ({"c": 20.0, "m": 0.05}, 159.155),  # spring and mass balance: the damper alone counts
    ],
)
def test_the_least_force_of_a_vibration_of_the_pinned_range_is_zero(
    changes: dict[str, float], frequency: float
) -> None:
    p = CASE.replace(**changes)
    extent = pinned_range(p, frequency)
    # the greatest error of a minimum among 100,000 samples is 5e-10 of the amplitude
    assert least_force(p, 2 * math.pi * frequency, extent) == pytest.approx(0, abs=1e-6)


def test_a_slider_whose_spring_and_mass_balance_never_leaves() -> None:
    omega = 2 * math.pi * 135.42
    balanced = CASE.replace(k=CASE.m * omega**2)
    assert pinned_range(balanced, 135.42) == math.inf


@pytest.mark.parametrize("frequency", [0, -1.0, math.inf, math.nan, "135 kg"])
def test_a_frequency_that_is_none_is_refused(frequency: object) -> None:
    with refusal(r"frequency=.*must be "):
        pinned_range(CASE, frequency)  # type: ignore[arg-type]


@pytest.mark.parametrize(("excess", "tolerance"), [(1e-4, 1e-3), (0.01, 0.02)])
def test_the_time_apart_gives_the_excess_of_a_vibration(excess: float, tolerance: float) -> None:
    """A flight is integrated: the gap accelerates by the missing force 1 - (1 + e) cos(t). The
    formula is the limit of a small excess e; its error is of the order of e."""
    begin = -math.acos(1 / (1 + excess))
    time = np.linspace(begin, begin + 6 * abs(begin), 400_001)
    step = time[1] - time[0]
    missing = (1 + excess) * np.cos(time) - 1
    velocity = np.concatenate([[0], np.cumsum(0.5 * step * (missing[1:] + missing[:-1]))])
    gap = np.concatenate([[0], np.cumsum(0.5 * step * (velocity[1:] + velocity[:-1]))])
    closed = int(np.flatnonzero((gap[1:] <= 0) & (time[1:] > 0))[0]) + 1
    apart = (time[closed] - begin) / (2 * math.pi)
    assert excess_of_flights(apart) == pytest.approx(excess, rel=tolerance)
