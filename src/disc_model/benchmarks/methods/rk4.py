"""The paper's method: fixed-step Runge-Kutta of fourth order, with events located inside their steps.

The whole loop is compiled.  The last rate of a step is the first of the next, and its contact force serves the event
conditions at the end.  A step is searched if a condition changes sign or dips. Dips are detected by the parabola
through three step ends, so that a loss of contact much shorter than a step is missed.
"""

import math

import numpy as np

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import Meter, MethodResult, Problem, RunStatus
from disc_model.data.variables import EVENT_KINDS, PHASES

STABILITY_LIMIT = 2.0 * math.sqrt(2.0)
"""Largest omega h at which RK4 does not let an undamped oscillation grow."""
STEPS_PER_SECOND = 1_000_000
MAX_EVENTS = 20_000


def solve(problem: Problem, value: float, budget: float) -> MethodResult:
    """Classical RK4; ``value`` is the step."""
    meter, start = Meter(problem, budget), problem.start
    y = meter.physics.pack(start)
    times, kinds = np.empty(MAX_EVENTS), np.empty(MAX_EVENTS, np.int64)
    limit = int(max(1, min(budget, 1e6) * STEPS_PER_SECOND))
    phase = PHASES.index(start.phase)
    heights = np.array([math.inf, -math.inf])
    case = (meter.modes, meter.c, phase, start.direction)
    kernels.rk4_run(*case, y.copy(), 0.0, value, 1, problem.stop, times, kinds, heights)  # compiles
    with meter.running():
        why, t, phase, direction, n, steps = kernels.rk4_run(
            *case, y, problem.span, value, limit, problem.stop, times, kinds, heights
        )  # fmt: skip
    meter.outcome = (RunStatus.FINISHED, RunStatus.NON_FINITE, RunStatus.STALLED, RunStatus.TOO_SLOW)[why]
    meter.work, meter.longest_step, (meter.low, meter.high) = 4 * steps, value, heights.tolist()
    final = meter.physics.unpack(start.time + t, PHASES[phase], direction, y)
    return meter.result(times[:n], [EVENT_KINDS[kind] for kind in kinds[:n]], final)
