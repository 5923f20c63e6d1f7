"""Runs on a reader's axes: their times can be read, and several runs are seen in stretches alike."""

import functools
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.common_stretch import Shown, stretch_shown

CASE = dm.Parameters(N=385, Omega=15, n_diameters=2)


@functools.cache
def run(speed: float, end: float) -> dm.Result:
    return dm.simulate(CASE.replace(Omega=speed), end, {"late": dm.Window(last=0.05, rate=1e4)})


def drawn_times(ax: Any) -> list[np.ndarray]:
    """The times of the lines of runs."""
    times = [np.asarray(line.get_xdata(), dtype=float) for line in ax.lines]
    return [time for time in times if time.size > 2]


def test_panels_in_a_row_have_whole_times() -> None:
    _, axes = pyplot.subplots(1, 3, figsize=(6.85, 2.2), layout="constrained")
    run(15.0, 30).plot("late", variables=["P", "w", "u"], ax=axes)
    axes[0].figure.canvas.draw()
    for ax in axes:
        assert ax.xaxis.get_major_formatter().get_offset() == ""


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


def test_last_cycles_are_seen_where_all_runs_have_them() -> None:
    assert stretch_shown([(149.93, 150.0), (149.97, 150.0)]) == Shown(limits=(149.97, 150.0))


def test_stretches_that_overlap_are_seen_whole() -> None:
    assert stretch_shown([(0.0, 10.0), (0.0, 15.0)]) == Shown()


def test_words_of_a_title_are_broken_within_a_narrow_panel() -> None:
    _, axes = pyplot.subplots(2, 2, figsize=(3.31, 4), layout="constrained")
    bilateral = dm.simulate(dm.Parameters(N=385, Omega=15, contact="bilateral"), 1)
    for ax in axes.flat:
        bilateral.plot_phase_portrait(ax=ax, title=True)
    right = axes[0, 1]
    right.figure.canvas.draw()
    title = right.get_title(loc="left")
    assert "\nbilateral contact" in title
    assert right._left_title.get_window_extent().x1 <= right.figure.bbox.x1
