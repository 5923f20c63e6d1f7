"""Methods that run in one compiled call: the package's own engine, and fixed-step Runge-Kutta."""

from __future__ import annotations

import math
import time as clock

import numpy as np

from benchmarks.methods import kernels
from benchmarks.methods.integrators import Meter, MethodResult, Problem, RunStatus
from disc_model.data.variables import EVENT_KINDS, PHASES
from disc_model.errors import Status
from disc_model.simulation.api import Execution, simulate

SERIES_STEPS_PER_SECOND = 300_000
"""Steps of the engine per second of budget: it stops by steps, not by the clock."""
LONGEST_BUDGET = 1e6
"""Seconds from which on a budget counts as unlimited."""
FAILURES = {Status.STEP_LIMIT: RunStatus.TOO_SLOW, Status.PARADOX: RunStatus.FAILED}
"""Ends of the engine that methods call by another name."""


def _steps(budget: float, per_second: int) -> int:
    """Return the greatest number of steps for a budget in seconds, at a rate of steps."""
    return int(max(1, min(budget, LONGEST_BUDGET) * per_second))


def solve_by_series(problem: Problem, value: float, budget: float) -> MethodResult:
    """Integrate with the engine of `disc_model.simulation.api`.

    It uses Taylor series of high order, with events as roots of polynomials.

    Parameters
    ----------
    problem : what is integrated
    value : tolerance
    budget : seconds
    """
    simulate(problem.parameters, 1e-6)  # compiles
    began = clock.thread_time()
    result = simulate(
        problem.parameters,
        problem.t_end,
        tol=value,
        initial_state=problem.start,
        stop_at="first_separation" if problem.stop else None,
        execution=Execution(max_steps=_steps(budget, SERIES_STEPS_PER_SECOND)),
    )
    call = clock.thread_time() - began

    status = result.status
    outcome = RunStatus.FINISHED
    if not status.complete:
        outcome = FAILURES.get(status) or RunStatus(status.value)
    return MethodResult(
        times=result.events["time"].to_numpy(),
        kinds=tuple(result.events["kind"]),
        final=result.final_state,
        seconds=call,
        outcome=outcome,
    )


# ---- The paper's fixed-step Runge-Kutta

STABILITY_LIMIT = 2.0 * math.sqrt(2.0)
"""Largest omega h at which RK4 does not let an undamped oscillation grow."""
RK4_STEPS_PER_SECOND = 1_000_000
MAX_EVENTS = 20_000
RK4_OUTCOMES = {
    kernels.FINISHED: RunStatus.FINISHED,
    kernels.NON_FINITE: RunStatus.NON_FINITE,
    kernels.STALLED: RunStatus.STALLED,
    kernels.STEP_LIMIT: RunStatus.TOO_SLOW,
}


def solve_by_rk4(problem: Problem, value: float, budget: float) -> MethodResult:
    """Integrate with classical RK4.

    Parameters
    ----------
    problem : what is integrated
    value : step, s
    budget : seconds
    """
    meter = Meter(problem, budget)
    physics = meter.physics
    start = problem.start
    y = physics.pack(start)
    times = np.empty(MAX_EVENTS)
    kinds = np.empty(MAX_EVENTS, np.int64)
    track = (times, kinds)
    case = (physics.modes, physics.c, PHASES.index(start.phase), start.direction)
    kernels.rk4_run(*case, y.copy(), (0.0, value, 1, problem.stop), track)  # compiles

    limits = (problem.span, value, _steps(budget, RK4_STEPS_PER_SECOND), problem.stop)
    with meter.running():
        why, t, phase, direction, events = kernels.rk4_run(*case, y, limits, track)
    meter.outcome = RK4_OUTCOMES[why]
    meter.longest_step = value
    final = physics.unpack(start.time + t, PHASES[phase], direction, y)
    return meter.result(times[:events], [EVENT_KINDS[kind] for kind in kinds[:events]], final)
