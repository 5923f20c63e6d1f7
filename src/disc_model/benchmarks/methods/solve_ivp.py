"""scipy's integrators with terminal events, started anew at every switch."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import MAP_TOLERANCES, GaveUp, Meter, Method, MethodResult, Problem, decades
from disc_model.benchmarks.methods.phases import ENDS, Ended, Phase, run_phases
from disc_model.benchmarks.methods.physics import Array, Physics
from disc_model.benchmarks.register import SCENES

FLOOR = 2.3e-14
"""Least relative tolerance that scipy takes."""
Function = Callable[[float, Array], Any]

_TO_9, _TO_11 = decades(-3, -5, -7, -9), decades(-3, -5, -7, -9, -11)
CHOICES: dict[str, tuple[tuple[Sequence[float], ...], Sequence[float]]] = {
    "RK45": ((_TO_9, _TO_9, _TO_9[:3], _TO_9[:1]), MAP_TOLERANCES),
    "DOP853": ((_TO_11, _TO_11, _TO_9, _TO_9[:1]), MAP_TOLERANCES),
    "LSODA": ((_TO_9, _TO_9, _TO_9[:3], _TO_9), MAP_TOLERANCES[::2]),
    "Radau": (
        (decades(-2, -3, -4, -5), decades(-2, -3, -4), decades(-2, -3, -4), decades(-2, -4, -6, -8)),
        MAP_TOLERANCES[:8:2],
    ),
}
"""Settings at which each of scipy's algorithms is measured: by scene, and for maps."""


class SolveIvp(Method):
    """`scipy.integrate.solve_ivp` with a compiled right-hand side; ``max_step`` (s) bounds the steps."""

    def __init__(self, algorithm: str, order: float = math.nan, max_step: float = np.inf) -> None:
        self.algorithm, self.order, self.max_step = algorithm, order, max_step
        self.label = f"scipy {algorithm}"
        settings, self.map_values = CHOICES[algorithm]
        self.settings = dict(zip(SCENES, settings, strict=True))

    def _solve(self, problem: Problem, value: float, budget: float) -> MethodResult:
        physics = Physics(problem.parameters)
        scale = absolute_scale(physics)
        meter = Meter(problem, physics, budget)
        parts = self._functions(physics)

        def advance(phase: Phase, t: float, y: Array, t_end: float, *, watched: bool) -> Ended:
            rate, events = parts(phase)
            with np.errstate(over="ignore", invalid="ignore"):
                found = solve_ivp(
                    meter.counted(rate), (t, t_end), y,
                    method=self.algorithm, rtol=max(value, FLOOR), atol=value * scale, max_step=self.max_step,
                    events=events if watched else [],
                )  # fmt: skip
            meter.steps(found.t, found.y.T)
            if found.status == -1:
                raise GaveUp(found.message)
            cause = next((i for i, times in enumerate(found.t_events) if len(times)), None)
            return Ended(cause, float(found.t[-1]), found.y[:, -1])

        return run_phases(problem, physics, advance, meter)

    def _functions(self, physics: Physics) -> Callable[[Phase], tuple[Function, list[Function]]]:
        """For a phase, its right-hand side and what falls through zero at its end."""
        modes, c = kernels.tables(physics)
        values = np.empty(3)

        def parts(phase: Phase) -> tuple[Function, list[Function]]:
            code, direction = phase.code, phase.direction

            def rate(_t: float, y: Array) -> Array:
                dy = np.empty_like(y)
                kernels.rate(modes, c, code, direction, y, dy)
                return dy

            def event(place: int) -> Function:
                def value(_t: float, y: Array) -> float:
                    kernels.switch_values(modes, c, code, direction, y, values)
                    return float(values[place])

                return crossing(value, -1, last=True)

            return rate, [event(place) for place in range(ENDS[phase.name])]

        return parts


class InNumpy(SolveIvp):
    """The same with a right-hand side in numpy: what most users write."""

    def __init__(self, algorithm: str, order: float = math.nan) -> None:
        super().__init__(algorithm, order)
        self.label = f"scipy {algorithm}, numpy right-hand side"

    def _functions(self, physics: Physics) -> Callable[[Phase], tuple[Function, list[Function]]]:
        compiled = super()._functions(physics)
        return lambda phase: (lambda _t, y: physics.rate(phase.name, phase.direction, y), compiled(phase)[1])


def crossing(function: Any, direction: int, *, last: bool) -> Function:
    """An event as scipy wants it: the sign of the change of ``function`` (0: either), and whether it is the end."""
    function.terminal, function.direction = last, direction
    return function  # type: ignore[no-any-return]


def absolute_scale(physics: Physics) -> Array:
    """Size of each entry of the state: static deflection, and its velocity; what absolute tolerances multiply."""
    p = physics.p
    deflection = p.N * np.abs(physics.shape) / physics.stiffness
    velocity = deflection * physics.omega
    angle = p.mu_s * p.N / (p.k_p * p.r_0)
    speed = max(p.Omega, 1e-3)
    height = max(abs(physics.u_0), 1e-12)
    tail = (max(angle, 1e-9), speed, height, height * float(physics.omega.min()))
    return np.concatenate([deflection, deflection, velocity, velocity, tail])
