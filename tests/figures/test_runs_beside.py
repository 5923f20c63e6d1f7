"""Runs on a reader's axes: their times can be read, and several runs are seen in stretches alike."""

import functools
from typing import Any

import numpy as np
import pytest

import disc_model as dm

CASE = dm.Parameters(N=385, Omega=15, n_diameters=2)


@functools.cache
def run(speed: float, end: float) -> dm.Result:
    return dm.simulate(CASE.replace(Omega=speed), end, {"late": dm.Window(last=0.05, rate=1e4)})


def drawn_times(ax: Any) -> list[np.ndarray]:
    """The times of the lines of runs."""
    times = [np.asarray(line.get_xdata(), dtype=float) for line in ax.lines]
    return [time for time in times if time.size > 2]


def test_runs_of_two_lengths_by_the_time_before_their_ends() -> None:
    ax = run(15.0, 2).plot("late", variables=["u"])
    run(16.0, 3).plot("late", variables=["u"], ax=ax)
    for times in drawn_times(ax):
        assert times[-1] == 0.0
        assert times[0] == pytest.approx(-0.05, abs=1e-3)
    assert ax.get_xlim() == pytest.approx((-0.05, 0.0), abs=1e-3)
    assert ax.get_xlabel() == "Time before the end of each run (s)"


def test_runs_of_one_length_by_their_own_time() -> None:
    ax = run(15.0, 2).plot("late", variables=["u"])
    run(16.0, 2).plot("late", variables=["u"], ax=ax)
    assert ax.get_xlim() == pytest.approx((1.95, 2.0), abs=1e-3)
    assert ax.get_xlabel() == "Time (s)"
