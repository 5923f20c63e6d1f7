"""The moving load and the frictionless oscillator, at small models."""

from __future__ import annotations

import numpy as np
import pytest

from disc_model import ParameterError, Parameters, plate_modes
from disc_model.stability.moving_load import critical_speed, rotating_oscillator_eigenvalues, unstable_speeds

P = Parameters(N=1, Omega=1, n_diameters=2)


def test_critical_speed_is_the_least_over_the_modes():
    modes = plate_modes(P).query("diameters > 0")
    speeds = modes["omega"] / modes["diameters"]
    found = critical_speed(P)
    assert found.speed == speeds.min()
    assert (found.circles, found.diameters) == (0, 2)
    with pytest.raises(ParameterError, match="n_diameters=0: must be >= 1"):
        critical_speed(P.replace(n_diameters=0))


def test_instability_begins_at_the_critical_speed_and_ends_where_growth_does():
    intervals = unstable_speeds(P, 1000.0, points=501)
    assert intervals[0].low == pytest.approx(critical_speed(P).speed, abs=0.01)
    assert intervals[0].divergence
    for interval in intervals:
        assert rotating_oscillator_eigenvalues(P, interval.low - 1.0)[0].real < 1e-6
        assert rotating_oscillator_eigenvalues(P, interval.worst)[0].real == interval.growth_rate > 0
        assert interval.low <= interval.worst <= interval.high
    assert intervals[-1].high <= 1000.0


def test_at_rest_nothing_grows():
    values = rotating_oscillator_eigenvalues(P, 0.0)
    assert len(values) == 2 * 4 + 2
    assert values.real.max() <= 0
    assert np.all(np.diff(values.real) <= 0)


def test_bad_input_is_named():
    with pytest.raises(ParameterError, match="top=-1, points=1: must be > 0 and >= 2"):
        unstable_speeds(P, -1, points=1)
