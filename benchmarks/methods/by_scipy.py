"""scipy's integrators, phase by phase."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.methods import kernels
from benchmarks.methods.integrators import GaveUp, Meter, MethodResult, Problem, RunStatus
from benchmarks.methods.kernels import Array
from benchmarks.methods.phases import ENDS, Ended, run_phases

LEAST_RTOL = 2.3e-14
"""Smallest relative tolerance that scipy accepts."""
STIFF = ("LSODA", "Radau")
"""Algorithms that use a Jacobian."""


def solve_by_scipy(problem: Problem, value: float, budget: float, algorithm: str) -> MethodResult:
    """Integrate phase by phase with `scipy.integrate.solve_ivp`.

    Right-hand side and, where one is used, Jacobian are compiled.

    Parameters
    ----------
    problem : what is integrated
    value : tolerance
    budget : seconds
    algorithm : of scipy
    """
    meter = Meter(problem, budget)
    modes = meter.physics.modes
    c = meter.physics.c
    scale = meter.physics.scale()
    margins = np.empty(3)

    def advance(phase: int, direction: int, t: float, y: Array, t_end: float) -> Ended:
        def rate(_t: float, y: Array) -> Array:
            dy = np.empty_like(y)
            kernels.rate(modes, c, phase, direction, y, dy)
            return dy

        def jacobian(_t: float, y: Array) -> Array:
            J = np.empty((len(y), len(y)))
            kernels.jacobian(modes, c, phase, direction, y, J)
            return J

        def margin(index: int, _t: float, y: Array) -> float:
            kernels.switch_values(modes, c, phase, direction, y, margins)
            return float(margins[index])

        options: dict[str, Any] = {"max_step": problem.max_step}
        if algorithm in STIFF:
            options = {"jac": jacobian}
        events: list[Any] = [partial(margin, index) for index in range(ENDS[phase])]
        for event in events:
            event.terminal = True
            event.direction = -1
        with np.errstate(over="ignore", invalid="ignore"):
            solution = solve_ivp(
                meter.counted(rate),
                (t, t_end),
                y,
                method=algorithm,
                rtol=max(value, LEAST_RTOL),
                atol=value * scale,
                events=events,
                **options,
            )
        steps = np.diff(solution.t)
        meter.longest_step = float(np.fmax.reduce(steps, initial=meter.longest_step))
        if solution.status == -1:
            raise GaveUp(RunStatus.FAILED)
        cause = next((i for i, times in enumerate(solution.t_events) if len(times)), None)
        return cause, float(solution.t[-1]), solution.y[:, -1].copy()

    return run_phases(advance, meter)
