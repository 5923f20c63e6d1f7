"""The contract of a method: what it is given, what it gives back.

A method is an object with

``name``, ``requires``
    as registered in `disc_model.benchmarks.register`: short and unique; the packages that it needs
``label``, ``look``
    its name in words; colour, marker and line style in charts
``setting``
    what its one number means: "tol" (relative tolerance), "step" (s) or "epsilon" (rad/s)
``order``
    theoretical order of the global error against the step (nan if it has none)
``settings``, ``map_values``, ``map_budget``
    by scene, the settings from coarse to fine that are measured; those of its failure map, and the seconds that it may
    take there for a point
``unavailable()``
    "" if it can be used, else the sentence that says which package is missing
``solve(problem, value, budget)``
    advances ``problem`` with its setting equal to ``value``; gives up after ``budget`` seconds.  Never raises for
    what happens on the way: the result's status says it.

What is timed is the integration alone: modes, compiling and setting up are left out for every method.  Times are the
processor's: on a core of its own those of the wall clock, and elsewhere not blurred by what else runs.
"""

from __future__ import annotations

import enum
import importlib.util
import math
import time as clock
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from disc_model.benchmarks.methods.heights import Heights
from disc_model.benchmarks.methods.physics import Physics
from disc_model.errors import DiscModelError
from disc_model.parameters import Parameters
from disc_model.simulation.result import State

Array = NDArray[np.float64]


class MethodUnavailable(DiscModelError, ImportError):
    """A method whose optional package is not installed."""


class Outcome(enum.StrEnum):
    """How a method ended."""

    FINISHED = "finished"  # reached t_end
    NON_FINITE = "non_finite"  # the numbers overflowed
    STALLED = "stalled"  # switches without the clock moving, over and over
    TOO_SLOW = "too_slow"  # the budget of seconds was used up
    FAILED = "failed"  # the integrator itself gave up, or the model has no solution


@dataclass(frozen=True, eq=False)
class Problem:
    """Where to start and how far to go.

    Attributes
    ----------
    parameters : the case
    start : state of the slider's frame (arrays (n_modes,) in the order of `plate_modes`)
    t_end : s, absolute, greater than start.time
    stop : whether to end at the first separation
    watched : whether the range of the disc is asked for, which costs some methods time
    """

    parameters: Parameters
    start: State
    t_end: float
    stop: bool = False
    watched: bool = False

    @property
    def span(self) -> float:
        """Simulated time, s."""
        return self.t_end - self.start.time


@dataclass(frozen=True, eq=False)
class MethodResult:
    """What a method found.

    Attributes
    ----------
    times : s, shape (n_events,)
    kinds : n_events words of `disc_model.data.variables.EVENT_KINDS`
    final : state at t_end, or where the method stopped
    seconds : processor time of the integration
    work : right-hand sides evaluated, or steps for methods that work with series
    outcome, message : how it ended
    longest_step : s, longest step taken; nan if not known
    heights : m, least and greatest w of the disc under the slider; nan if not watched
    """

    times: Array
    kinds: tuple[str, ...]
    final: State
    seconds: float
    work: int
    outcome: Outcome
    message: str = ""
    longest_step: float = math.nan
    heights: tuple[float, float] = (math.nan, math.nan)

    @property
    def separations(self) -> int:
        """Number of separations."""
        return self.kinds.count("separation")


def decades(*exponents: int) -> tuple[float, ...]:
    """10 to these powers."""
    return tuple(10.0**e for e in exponents)


MAP_TOLERANCES = decades(*range(-2, -12, -1))
"""Relative tolerances of a failure map."""


class Method(ABC):
    """Base class of all methods; see the module's text for the contract."""

    name: str = ""
    label: str
    look: tuple[str, str, str]
    setting: ClassVar[str] = "tol"
    order: float = math.nan
    requires: tuple[str, ...] = ()
    settings: Mapping[str, Sequence[float]]
    map_values: Sequence[float] = MAP_TOLERANCES
    map_budget: float = 1.0  # beyond it a method gave up: the engine needs a ten-thousandth of it

    def unavailable(self) -> str:
        """Why the method cannot be used here; "" if it can."""
        missing = [name for name in self.requires if importlib.util.find_spec(name) is None]
        if not missing:
            return ""
        return f"{self.name} needs {', '.join(missing)}: install the extra `bench` (pip install disc_model[bench])"

    def economical(self) -> Method:
        """The method as it is used where every run has other modes and another setting: a map."""
        return self

    def solve(self, problem: Problem, value: float, budget: float = math.inf) -> MethodResult:
        """Advance ``problem`` with the setting equal to ``value`` for at most about ``budget`` seconds.

        Raises
        ------
        MethodUnavailable
            If the package that the method stands for is not installed.
        """
        if reason := self.unavailable():
            raise MethodUnavailable(reason)
        return self._solve(problem, value, budget)

    @abstractmethod
    def _solve(self, problem: Problem, value: float, budget: float) -> MethodResult: ...


class BudgetExceeded(Exception):
    """Raised inside a right-hand side to leave an integrator that offers no other way out."""


@dataclass
class Meter:
    """Counts right-hand sides, watches the clock and, if it is asked for, the disc's range."""

    budget: float
    work: int = 0
    longest_step: float = math.nan
    heights: Heights | None = None
    began: float = field(default_factory=clock.thread_time)

    @classmethod
    def of(cls, problem: Problem, physics: Physics, budget: float) -> Meter:
        """For a problem."""
        return cls(budget, heights=Heights(physics) if problem.watched else None)

    def start(self) -> None:
        """Set the clock to zero: everything before was preparation."""
        self.began = clock.thread_time()

    @property
    def seconds(self) -> float:
        """Processor time since the start."""
        return clock.thread_time() - self.began

    def steps(self, times: Array, states: Array) -> None:
        """Note the steps between successive ``times`` (s, shape (k,)) and the states there (k, size)."""
        if len(times) > 1:
            self.longest_step = float(np.fmax(self.longest_step, np.max(np.diff(times))))
        if self.heights is not None:
            self.heights.path(times, states)

    def result(
        self, seconds: float, times: Array, kinds: tuple[str, ...], final: State, outcome: Outcome, message: str
    ) -> MethodResult:
        """What a method found, with what was counted meanwhile."""
        heights = (math.nan, math.nan) if self.heights is None else (self.heights.low, self.heights.high)
        return MethodResult(times, kinds, final, seconds, self.work, outcome, message, self.longest_step, heights)

    def check(self) -> None:
        """Raise `BudgetExceeded` if the time is used up."""
        if self.seconds > self.budget:
            raise BudgetExceeded

    def counted(self, function: Callable[[float, Array], Array]) -> Callable[[float, Array], Array]:
        """``function``, counting its calls and looking at the clock every 64 of them."""

        def wrapped(t: float, y: Array) -> Array:
            self.work += 1
            if self.work & 63 == 0:
                self.check()
            return function(t, y)

        return wrapped
