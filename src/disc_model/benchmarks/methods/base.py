"""The contract of a method: its input, its result, and the events between phases for those that stop at each.

A method is a function ``(problem, value, budget, *arguments)`` that advances a `Problem`, with its one setting equal to
``value``, for at most about ``budget`` seconds, and returns a `MethodResult`, also if it failed on the way. Only the
integration is timed, in processor time, which other processes do not distort.
"""

from __future__ import annotations

import enum
import math
import time as clock
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.kernels import Array, Physics
from disc_model.data.variables import EVENT_KINDS, PHASES
from disc_model.parameters import Parameters
from disc_model.simulation.states import State


class RunStatus(enum.StrEnum):
    """Final status of a method."""

    FINISHED = "finished"  # reached t_end
    NON_FINITE = "non_finite"  # the numbers overflowed
    STALLED = "stalled"  # switches without the clock moving, over and over
    TOO_SLOW = "too_slow"  # the budget of seconds was used up
    FAILED = "failed"  # the integrator itself gave up, or the model has no solution


@dataclass(frozen=True, eq=False)
class Problem:
    """An initial-value problem: start and end of the motion."""

    parameters: Parameters
    start: State
    t_end: float  # s, absolute, greater than start.time
    stop: bool = False  # whether to end at the first separation
    watched: bool = False  # whether the range of the disc is requested, which costs some methods time
    max_step: float = math.inf  # s, longest step of methods that would miss events with longer ones

    @property
    def span(self) -> float:
        """Simulated time, s."""
        return self.t_end - self.start.time


@dataclass(frozen=True, eq=False)
class MethodResult:
    """Result of a method."""

    times: Array  # of events, s, (n_events,)
    kinds: tuple[str, ...]  # of events, words of `disc_model.data.variables.EVENT_KINDS`
    final: State  # at t_end, or where the method stopped
    seconds: float  # processor time of the integration
    work: int  # number of right-hand sides, or of steps for methods that work with series
    outcome: RunStatus
    message: str = ""
    longest_step: float = math.nan  # s; nan if not known
    heights: tuple[float, float] = (math.nan, math.nan)  # m, least and greatest w under the slider; nan if not watched
    glue: float = math.nan  # s of them spent in Python between compiled phases; nan where that was not measured


class GaveUp(Exception):
    """Raised inside a run that cannot go on: its status and the reason."""


class Meter:
    """The constants of a run, and what it comes to: right-hand sides, time and, if requested, the disc's range."""

    def __init__(self, problem: Problem, budget: float) -> None:
        self.problem, self.physics, self.budget = problem, Physics(problem.parameters), budget
        self.work, self.longest_step, self.low, self.high = 0, math.nan, math.nan, math.nan
        self.outcome, self.message = RunStatus.FINISHED, ""

    @contextmanager
    def running(self) -> Iterator[None]:
        """Time the integration; everything before was preparation."""
        self.began, wall = clock.thread_time(), clock.perf_counter()
        try:
            yield
        except GaveUp as reason:
            self.outcome, self.message = reason.args
        self.seconds, self.wall = clock.thread_time() - self.began, clock.perf_counter() - wall

    def result(self, times: Sequence[float] | Array, kinds: Sequence[str], final: State) -> MethodResult:
        """The result of a method with the meter's counts; times are those from the start on."""
        seconds, work, heights = self.seconds, self.work, (self.low, self.high)
        motion = self.problem.start.time + np.array(times), tuple(kinds), final
        return MethodResult(*motion, seconds, work, self.outcome, self.message, self.longest_step, heights)

    def steps(self, times: Array, states: Array) -> None:
        """Record the steps between successive ``times`` (s, shape (k,)) of one phase and the states there (k, size). If
        it is requested, they extend the range of w (m): between two it is the cubic with its values and rates there."""
        if len(times) > 1:
            self.longest_step = float(np.fmax(self.longest_step, np.max(np.diff(times))))
        if not self.problem.watched:
            return
        q = self.physics
        w = states[:, q.a] @ q.shape
        rate = states[:, q.alpha] @ q.shape + states[:, q.f] * (states[:, q.b] @ q.slope)
        steps = np.flatnonzero((np.diff(times, append=math.inf) > 0.0) & np.isfinite(w + rate))
        if len(steps) > 1:
            cubics = CubicHermiteSpline(times[steps], w[steps], rate[steps])
            w = np.concatenate([w, cubics(cubics.derivative().roots(extrapolate=False))])
        self.low, self.high = float(np.fmin.reduce(w, initial=self.low)), float(np.fmax.reduce(w, initial=self.high))

    def check(self) -> None:
        """Raise `GaveUp` if the time is used up."""
        if clock.thread_time() - self.began > self.budget:
            raise GaveUp(RunStatus.TOO_SLOW, f"not finished after {self.budget:g} s")

    def counted(self, function: Callable[[float, Array], Array]) -> Callable[[float, Array], Array]:
        """``function``, counting its calls and looking at the clock every 64 of them."""

        def wrapped(t: float, y: Array) -> Array:
            self.work += 1
            if self.work & 63 == 0:
                self.check()
            return function(t, y)

        return wrapped


# ---- Methods that integrate one phase at a time and stop at its end
CROWD = 50  # greatest number of events at one instant; with more the method is stuck
NOT_FINITE = "the state is no longer finite"
ENDS = (3, 2, 1)
"""By the number of a phase in `kernels`: functions of the state that end it where they fall through zero, ties in this
order: the contact force (1 if bonded) or the gap; f in slip, or the margins of friction forwards and backwards."""
Ended = tuple[int | None, float, Array]
"""Index of the function that ended a phase (None at t_end), local time (s), and a state that the caller may change."""
Advance = Callable[[int, int, float, Array, float], Ended]
"""Integrates a phase ``(phase, direction, t, y, t_end)``, given by its number in `kernels` and the sign of f in it (0
except in slip), from local time ``t`` (s, 0 at the start) on; ``y`` is not changed."""


def run_phases(advance: Advance, meter: Meter) -> MethodResult:
    """Integrate phase by phase to the end of the problem."""
    problem, physics, modes, c = meter.problem, meter.physics, meter.physics.modes, meter.physics.c
    phase, direction = PHASES.index(problem.start.phase), problem.start.direction
    t, y, span = 0.0, physics.pack(problem.start), problem.span
    new = np.zeros(2, np.int64)
    for compiled in (kernels.rate, kernels.switch_values):
        compiled(modes, c, 1, 1, y, np.empty_like(y))
    kernels.jacobian(modes, c, 1, 1, y, np.empty((len(y), len(y))))
    kernels.switch(modes, c, kernels.SEPARATION, 0, y.copy(), new)
    times: list[float] = []
    kinds: list[str] = []
    crowd = 0
    with meter.running():
        while True:
            if len(times) & 15 == 0:  # the clock takes as long as a phase of some methods
                meter.check()
            cause, t, y = advance(phase, direction, t, y, span)
            if cause is None:
                break
            phase, direction, added = kernels.switch(modes, c, phase, cause, y, new)
            if added < 0:
                raise GaveUp(RunStatus.NON_FINITE, NOT_FINITE)
            crowd = crowd + 1 if times and t - times[-1] < 1e-12 else 0  # s, at one instant
            for index in range(added):
                times.append(t)
                kinds.append(EVENT_KINDS[new[index]])
            if problem.stop and phase == kernels.SEPARATION:
                break
            if crowd > CROWD:
                raise GaveUp(RunStatus.STALLED, f"more than {CROWD} events at one instant")
        if not math.isfinite(y.sum()):
            raise GaveUp(RunStatus.NON_FINITE, NOT_FINITE)
    return meter.result(times, kinds, physics.unpack(problem.start.time + t, PHASES[phase], direction, y))
