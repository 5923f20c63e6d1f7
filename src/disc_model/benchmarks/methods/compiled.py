"""Methods whose whole run is one compiled call: the package's own engine, and the paper's fixed-step Runge-Kutta.

RK4 uses the last rate of a step as the first of the next, and its contact force for the event conditions at the end. A
step is searched if a condition changes sign or dips. Dips are detected by the parabola through three step ends, so that
a loss of contact much shorter than a step is missed.
"""

import math
import time as clock
from dataclasses import replace

import numpy as np

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import Meter, MethodResult, Problem, RunStatus
from disc_model.benchmarks.methods.kernels import Physics
from disc_model.data.variables import EVENT_KINDS, PHASES
from disc_model.errors import Status
from disc_model.simulation.api import Execution, simulate
from disc_model.simulation.case import Window

SERIES_STEPS_PER_SECOND = 300_000
"""Steps per second of budget: the engine stops by steps, not by the clock."""
WATCH_RATE = 2e4
"""Sampling rate, 1/s: after a separation the disc vibrates by 0.04 rad a sample, and its range is accurate to 2e-4."""
STABILITY_LIMIT = 2.0 * math.sqrt(2.0)
"""Largest omega h at which RK4 does not let an undamped oscillation grow."""
RK4_STEPS_PER_SECOND = 1_000_000
MAX_EVENTS = 20_000


def solve_by_series(problem: Problem, value: float, budget: float) -> MethodResult:
    """The engine of `disc_model.simulation.api`: Taylor series of high order, events as roots of polynomials."""
    steps = int(max(1, min(budget, 1e6) * SERIES_STEPS_PER_SECOND))
    windows = {}
    if problem.watched:  # in one bin over the whole run
        samples = max(2, round(WATCH_RATE * problem.span))
        window = Window(start=problem.start.time, stop=problem.t_end, rate=WATCH_RATE, envelope=samples)
        windows = {"whole": window}
    began = clock.thread_time()
    result = simulate(
        problem.parameters, problem.t_end, windows, tol=value, initial_state=problem.start,
        stop_at="first_separation" if problem.stop else None, execution=Execution(max_steps=steps),
    )  # fmt: skip
    outcome = {
        Status.OK: RunStatus.FINISHED,
        Status.STOPPED: RunStatus.FINISHED,
        Status.STEP_LIMIT: RunStatus.TOO_SLOW,
        Status.STALLED: RunStatus.STALLED,
        Status.NON_FINITE: RunStatus.NON_FINITE,
    }.get(result.status, RunStatus.FAILED)
    seen = result.samples.get("whole", {})
    reached = len(seen.get("w_min", ()))  # of a bin that a run ends before, there is nothing
    return MethodResult(
        times=result.events["time"].to_numpy(),
        kinds=tuple(result.events["kind"]),
        final=result.final_state,
        # the time of the steps; of a long run, which other processes may have interrupted, that of the call
        seconds=min(result.statistics["wall_time"], clock.thread_time() - began),
        work=int(result.statistics["steps"]),
        outcome=outcome,
        message=result.message,
        heights=(float(seen["w_min"].min()), float(seen["w_max"].max())) if reached else (math.nan, math.nan),
    )


def solve_with_fewest(problem: Problem, value: float, budget: float) -> MethodResult:
    """The same engine without the disc's modes if the disc deflects by less than the tolerance.

    The modes change the answer by about k sum psi^2/omega^2, the disc's deflection over that of the slider's spring.
    They are never excited and then follow statically, however fast they are.
    """
    physics = Physics(problem.parameters)
    give = problem.parameters.k * float(np.sum(physics.shape**2 / physics.stiffness))
    start = problem.start
    if give > value or start.phase == "separation":
        return solve_by_series(problem, value, budget)
    none = np.empty(0)
    rigid = start.replace(u=0.0, u_velocity=0.0, **dict.fromkeys(("a", "b", "alpha", "beta"), none))
    case = problem.parameters.replace(n_diameters=-1)
    result = solve_by_series(replace(problem, parameters=case, start=rigid), value, budget)
    end = result.final
    moved = start.replace(time=end.time, phase=end.phase, direction=end.direction, psi=end.psi, f=end.f)
    return replace(result, final=moved)


def solve_by_rk4(problem: Problem, value: float, budget: float) -> MethodResult:
    """Classical RK4; ``value`` is the step."""
    meter, start = Meter(problem, budget), problem.start
    y = meter.physics.pack(start)
    track = (np.empty(MAX_EVENTS), np.empty(MAX_EVENTS, np.int64), np.array([math.inf, -math.inf]))
    case = (meter.modes, meter.c, PHASES.index(start.phase), start.direction)
    steps = int(max(1, min(budget, 1e6) * RK4_STEPS_PER_SECOND))
    kernels.rk4_run(*case, y.copy(), (0.0, value, 1, problem.stop), track)  # compiles
    limits = (problem.span, value, steps, problem.stop)
    with meter.running():
        why, t, phase, direction, n, steps = kernels.rk4_run(*case, y, limits, track)
    meter.outcome = (RunStatus.FINISHED, RunStatus.NON_FINITE, RunStatus.STALLED, RunStatus.TOO_SLOW)[why]
    meter.work, meter.longest_step, (meter.low, meter.high) = 4 * steps, value, track[2].tolist()
    final = meter.physics.unpack(start.time + t, PHASES[phase], direction, y)
    return meter.result(track[0][:n], [EVENT_KINDS[kind] for kind in track[1][:n]], final)
