"""The contract of methods that integrate: what they are given, what they return, and their meter.

A method is a function ``(problem, value, budget, *arguments)`` that advances a `Problem`, with its
one setting equal to ``value``, for at most about ``budget`` seconds, and returns a `MethodResult`,
also if it failed on the way. `solvers` lists them.
"""

from __future__ import annotations

import enum
import math
import time as clock
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import count

import numpy as np

from benchmarks.methods.kernels import Array, Physics
from disc_model.parameters import Parameters
from disc_model.simulation.states import State

CHECKED_CALLS = 63
"""Calls of a right-hand side between two looks at the clock, as a mask of bits."""


class RunStatus(enum.StrEnum):
    """How the run of a method ended."""

    FINISHED = "finished"
    """It reached t_end."""
    NON_FINITE = "non_finite"
    """The numbers overflowed."""
    STALLED = "stalled"
    """There were switches without the clock moving, over and over."""
    TOO_SLOW = "too_slow"
    """The budget of seconds was used up."""
    FAILED = "failed"
    """The integrator itself gave up, or the model has no solution."""


@dataclass(frozen=True, eq=False)
class Problem:
    """An initial-value problem: start and end of a motion.

    Attributes
    ----------
    parameters : the case
    start : state at the start
    t_end : end, s, absolute and greater than ``start.time``
    stop : whether to end at the first separation
    max_step : longest step in s of methods that would miss events with longer ones
    """

    parameters: Parameters
    start: State
    t_end: float
    stop: bool = False
    max_step: float = math.inf

    @property
    def span(self) -> float:
        """Simulated time, s."""
        return self.t_end - self.start.time


@dataclass(frozen=True, eq=False)
class MethodResult:
    """What a method found.

    Attributes
    ----------
    times : of events, s, (n_events,)
    kinds : of events, words of `disc_model.data.variables.EVENT_KINDS`
    final : state at t_end, or where the method stopped
    seconds : processor time of the integration
    outcome : how the run ended
    longest_step : s, nan if it is not known
    glue : seconds spent in Python between compiled phases, nan where that was not measured
    """

    times: Array
    kinds: tuple[str, ...]
    final: State
    seconds: float
    outcome: RunStatus
    longest_step: float = math.nan
    glue: float = math.nan


class GaveUp(Exception):
    """A run cannot go on; the argument is its status."""


@dataclass
class Meter:
    """The constants of a run, and what it comes to.

    Attributes
    ----------
    problem, physics : what is integrated, and its constants
    budget : seconds
    longest_step : s
    outcome : how the run ended
    began, seconds, wall : begin of the integration, and its processor and wall time, s
    """

    problem: Problem
    budget: float
    longest_step: float = math.nan
    outcome: RunStatus = RunStatus.FINISHED
    began: float = 0.0
    seconds: float = 0.0
    wall: float = 0.0

    def __post_init__(self) -> None:
        self.physics = Physics(self.problem.parameters)

    @contextmanager
    def running(self) -> Iterator[None]:
        """Time the integration; everything before was preparation."""
        wall = clock.perf_counter()
        self.began = clock.thread_time()
        try:
            yield
        except GaveUp as reason:
            (self.outcome,) = reason.args
        self.seconds = clock.thread_time() - self.began
        self.wall = clock.perf_counter() - wall

    def result(
        self, times: Sequence[float] | Array, kinds: Sequence[str], final: State
    ) -> MethodResult:
        """Return the result of a method with the meter's counts.

        Parameters
        ----------
        times : of events, s from the start on
        kinds : of events
        final : the last state
        """
        return MethodResult(
            times=self.problem.start.time + np.array(times),
            kinds=tuple(kinds),
            final=final,
            seconds=self.seconds,
            outcome=self.outcome,
            longest_step=self.longest_step,
        )

    def check(self) -> None:
        """Raise `GaveUp` if the budget is used up."""
        if clock.thread_time() - self.began > self.budget:
            raise GaveUp(RunStatus.TOO_SLOW)

    def counted(self, function: Callable[[float, Array], Array]) -> Callable[[float, Array], Array]:
        """Return a right-hand side that sometimes looks at the clock."""

        calls = count()

        def wrapped(t: float, y: Array) -> Array:
            if next(calls) & CHECKED_CALLS == CHECKED_CALLS:
                self.check()
            return function(t, y)

        return wrapped
