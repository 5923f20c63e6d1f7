"""The package's own engine behind the common interface."""

import math
import time as clock
from dataclasses import replace

import numpy as np

from disc_model.benchmarks.methods.base import Method, MethodResult, Problem, RunStatus
from disc_model.benchmarks.methods.physics import Physics
from disc_model.errors import Status
from disc_model.simulation.api import Execution, simulate
from disc_model.simulation.case import Record, Window
from disc_model.simulation.result import Result

STEPS_PER_SECOND = 300_000
"""Steps per second of budget: the engine stops by steps, not by the clock."""
WATCH_RATE = 2e4
"""Sampling rate, 1/s: after a separation the disc vibrates by 0.04 rad a sample, and its range is accurate to 2e-4."""


class Series(Method):
    """The engine of `disc_model.simulation.api`: Taylor series of high order, events as roots of polynomials."""

    def _solve(self, problem: Problem, value: float, budget: float) -> MethodResult:
        steps = int(max(1, min(budget, 1e6) * STEPS_PER_SECOND))
        began = clock.thread_time()
        result = simulate(
            problem.parameters, problem.t_end, tol=value, initial_state=problem.start,
            stop_at="first_separation" if problem.stop else None,
            record=_watching(problem) if problem.watched else None, execution=Execution(max_steps=steps),
        )  # fmt: skip
        outcome = {
            Status.OK: RunStatus.FINISHED,
            Status.STOPPED: RunStatus.FINISHED,
            Status.STEP_LIMIT: RunStatus.TOO_SLOW,
            Status.STALLED: RunStatus.STALLED,
            Status.NON_FINITE: RunStatus.NON_FINITE,
        }.get(result.status, RunStatus.FAILED)
        return MethodResult(
            times=result.events["time"].to_numpy(),
            kinds=tuple(result.events["kind"]),
            final=result.final_state,
            # the time of the steps; of a long run, which other processes may have interrupted, that of the call
            seconds=min(result.statistics["wall_time"], clock.thread_time() - began),
            work=int(result.statistics["steps"]),
            outcome=outcome,
            message=result.message,
            heights=_range(result),
        )


class Fewest(Series):
    """The same engine without the disc's modes if the disc deflects by less than the tolerance.

    The modes change the answer by about k sum psi^2/omega^2, the disc's deflection over that of the slider's spring.
    They are never excited and then follow statically, however fast they are.
    """

    def _solve(self, problem: Problem, value: float, budget: float) -> MethodResult:
        physics = Physics(problem.parameters)
        give = problem.parameters.k * float(np.sum(physics.shape**2 / physics.stiffness))
        start = problem.start
        if give > value or start.phase == "separation":
            return super()._solve(problem, value, budget)
        none = np.empty(0)
        rigid = start.replace(u=0.0, u_velocity=0.0, **dict.fromkeys(("a", "b", "alpha", "beta"), none))
        case = problem.parameters.replace(n_diameters=-1)
        result = super()._solve(replace(problem, parameters=case, start=rigid), value, budget)
        end = result.final
        moved = start.replace(time=end.time, phase=end.phase, direction=end.direction, psi=end.psi, f=end.f)
        return replace(result, final=moved)


def _watching(problem: Problem) -> Record:
    """A window over the whole run, in one bin."""
    samples = max(1, round(WATCH_RATE * problem.span))
    return Record(windows=(Window(start=problem.start.time, stop=problem.t_end, rate=WATCH_RATE, envelope=samples),))


def _range(result: Result) -> tuple[float, float]:
    """Least and greatest w (m) of the window, if there is one and the run reached its first sample."""
    window = result.samples[0] if result.samples else {}
    if not len(window.get("w_min", ())):
        return (math.nan, math.nan)
    return float(window["w_min"].min()), float(window["w_max"].max())
