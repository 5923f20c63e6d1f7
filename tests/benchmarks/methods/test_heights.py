"""The range of the disc under the slider, and runs that end at the first separation."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from disc_model.benchmarks import scenes
from disc_model.benchmarks.methods.base import Meter, Problem
from disc_model.benchmarks.registry import METHODS
from tests.benchmarks.methods.problems import BASE, task

ONE_MODE = SimpleNamespace(
    a=slice(0, 1), b=slice(1, 2), alpha=slice(2, 3), f=3, shape=np.array([2.0]), slope=np.array([1.0])
)
"""w = 2 a, w' = 2 alpha + f b."""
SEPARATING = [name for name, method in METHODS.items() if method.settings.get("separating") and not method.absent()]


def value_of(name: str) -> float:
    """A setting that is neither coarse nor dear."""
    return {"step": 1e-5, "epsilon": 1.0}.get(METHODS[name].setting, 1e-4 if name == "Radau" else 1e-6)


def test_turning_points_between_steps_are_seen() -> None:
    """A cubic is its own interpolant: its turning points come out whatever the steps."""
    cubic = np.polynomial.Polynomial([0.1, 1.0, -3.0, 2.0])
    times = np.array([0.0, 0.4, 1.1])
    states = np.column_stack([cubic(times) / 2, np.ones(3), (cubic.deriv()(times) - 0.5) / 2, np.full(3, 0.5)])
    seen = Meter(Problem(BASE, None, 1.0, watched=True), math.inf)
    seen.physics = ONE_MODE
    assert math.isnan(seen.low)
    seen.steps(times, states)
    # 6 x^2 - 6 x + 1 = 0
    turns = (3 + np.array([-1, 1]) * math.sqrt(3)) / 6
    ends = cubic(times)
    assert seen.high == pytest.approx(max(cubic(turns[0]), ends.max()), abs=1e-14)
    assert seen.low == pytest.approx(min(cubic(turns[1]), ends.min()), abs=1e-14)
    seen.steps(times[:1], states[:1])  # one instant only
    seen.steps(np.array([0.0, 0.0]), states[:2])  # no time at all


@pytest.mark.compiled
@pytest.mark.parametrize("name", SEPARATING)
def test_all_methods_see_the_same_range(name: str) -> None:
    whole = scenes.problem("separating")
    short = replace(whole, t_end=whole.start.time + 0.01, watched=True)
    low, high = METHODS["series"].solve(short, 1e-12).heights
    # some ten steps a turn, between which a cubic is right to 1e-4; the smooth model is another one
    tolerance = 0.03 if METHODS[name].setting == "epsilon" else 1e-3
    heights = METHODS[name].solve(short, value_of(name)).heights
    assert heights == pytest.approx((low, high), abs=tolerance * (high - low))


def test_a_motion_of_two_samples_has_a_range() -> None:
    """A bin of a single sample was refused."""
    low, high = METHODS["series"].solve(replace(task(span=5e-5), watched=True), 1e-9).heights
    assert low < high


@pytest.mark.compiled
@pytest.mark.parametrize("name", SEPARATING)
def test_a_run_ends_at_the_first_separation(name: str) -> None:
    """That which it finds itself: short ones are missed by many."""
    whole = scenes.problem("separating")
    problem = Problem(whole.parameters, whole.start, whole.start.time + 0.3)
    free, stopped = (METHODS[name].solve(replace(problem, stop=stop), value_of(name)) for stop in (False, True))
    count = free.kinds.index("separation") + 1
    assert stopped.kinds == free.kinds[:count]
    assert stopped.times == pytest.approx(free.times[:count], abs=1e-12)
    assert stopped.final.time == pytest.approx(free.times[count - 1], abs=1e-9)
    if METHODS[name].setting == "tol":  # the engine broke off where no sample had been reached
        METHODS[name].solve(replace(problem, stop=True, watched=True), value_of(name))


@pytest.mark.compiled
def test_a_disc_that_does_not_give_way_is_left_out() -> None:
    """The all but rigid disc gives way by 3e-9 of what the slider's spring does: left out at 1e-8, kept at 1e-10."""
    problem = scenes.problem("rigid")
    fewest, right = METHODS["series-fewest"], scenes.answer("rigid")
    result = fewest.solve(problem, 1e-8)
    found = scenes.errors(problem, right, result)
    assert found.verdict is scenes.Verdict.CONVERGED
    assert found.event_time < 1e-8
    assert result.work < 100
    assert result.final.a.shape == problem.start.a.shape
    soft = scenes.problem("stick_slip")
    short = replace(soft, t_end=0.01)
    assert fewest.solve(short, 1e-8).kinds == METHODS["series"].solve(short, 1e-8).kinds
