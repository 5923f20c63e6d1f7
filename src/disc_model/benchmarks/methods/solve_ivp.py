"""scipy's integrators with terminal events, started anew at every switch."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import MAP_TOLERANCES, Meter, Method, MethodResult, Problem, decades
from disc_model.benchmarks.methods.phases import (
    GUARD,
    Ended,
    IntegrationFailed,
    Phase,
    run_phases,
    switch_kinds,
    switches,
)
from disc_model.benchmarks.methods.physics import Array, Physics
from disc_model.data.variables import PHASES
from disc_model.figures.parts import BLUE, GREEN, PURPLE, SKY

FLOOR = 2.3e-14
"""Least relative tolerance that scipy takes."""
Function = Callable[[float, Array], Any]


class Choice(NamedTuple):
    """How one of scipy's algorithms is shown, and the settings at which it is measured, by scene and for maps."""

    look: tuple[str, str, str]
    stick_slip: tuple[float, ...]
    separating: tuple[float, ...]
    many_modes: tuple[float, ...]
    rigid: tuple[float, ...]
    map_values: tuple[float, ...] = MAP_TOLERANCES


_TO_9, _TO_11 = decades(-3, -5, -7, -9), decades(-3, -5, -7, -9, -11)
CHOICES = {
    "RK45": Choice((SKY, "v", "-"), _TO_9, _TO_9, _TO_9[:3], _TO_9[:1]),
    "DOP853": Choice((BLUE, "^", "-"), _TO_11, _TO_11, _TO_9, _TO_9[:1]),
    "LSODA": Choice((GREEN, "D", "-"), _TO_9, _TO_9, _TO_9[:3], _TO_9, MAP_TOLERANCES[::2]),
    "Radau": Choice(
        (PURPLE, "p", "-"),
        decades(-2, -3, -4, -5),
        decades(-2, -3, -4),
        decades(-2, -3, -4),
        decades(-2, -4, -6, -8),
        MAP_TOLERANCES[:8:2],
    ),
}


class SolveIvp(Method):
    """`scipy.integrate.solve_ivp` with a compiled right-hand side; ``max_step`` (s) bounds the steps."""

    def __init__(self, algorithm: str, order: float = math.nan, max_step: float = np.inf) -> None:
        self.algorithm, self.order, self.max_step = algorithm, order, max_step
        self.label = f"scipy {algorithm}"
        choice = CHOICES[algorithm]
        self.look, self.map_values = choice.look, choice.map_values
        self.settings = {scene: getattr(choice, scene) for scene in Choice._fields[1:-1]}

    def _solve(self, problem: Problem, value: float, budget: float) -> MethodResult:
        physics = Physics(problem.parameters)
        scale = absolute_scale(physics)
        meter = Meter.of(problem, physics, budget)
        parts = self._functions(physics)

        def integrate(phase: Phase, t: float, y: Array, t_end: float, *, watched: bool) -> Any:
            rate, events = parts(phase)
            with np.errstate(over="ignore", invalid="ignore"):
                found = solve_ivp(
                    meter.counted(rate), (t, t_end), y,
                    method=self.algorithm, rtol=max(value, FLOOR), atol=value * scale, max_step=self.max_step,
                    events=events if watched else [],
                )  # fmt: skip
            meter.steps(found.t, found.y.T)
            if found.status == -1:
                raise IntegrationFailed(found.message)
            return found

        def advance(phase: Phase, t: float, y: Array, t_end: float) -> Ended:
            if phase.name == "separation":
                until = min(t + GUARD, t_end)
                t, y = until, integrate(phase, t, y, until, watched=False).y[:, -1]
                if until >= t_end:
                    return Ended(None, t_end, y)
            found = integrate(phase, t, y, t_end, watched=True)
            if found.status == 0:
                return Ended(None, t_end, found.y[:, -1])
            cause = next(i for i, times in enumerate(found.t_events) if len(times))
            return Ended(cause, float(found.t[-1]), found.y[:, -1])

        return run_phases(problem, physics, advance, meter)

    def _functions(self, physics: Physics) -> Callable[[Phase], tuple[Function, list[Function]]]:
        """For a phase, its right-hand side and what falls through zero at its end."""
        modes, c = kernels.tables(physics)
        bonded = physics.p.contact == "bonded"
        size, values = 4 * physics.n + 4, np.empty(3)
        kernels.rate(modes, c, 1, 1, np.zeros(size), np.empty(size))  # compiles
        kernels.switch_values(modes, c, 1, 1, np.zeros(size), values)

        def parts(phase: Phase) -> tuple[Function, list[Function]]:
            code, direction = PHASES.index(phase.name), phase.direction

            def rate(_t: float, y: Array) -> Array:
                dy = np.empty_like(y)
                kernels.rate(modes, c, code, direction, y, dy)
                return dy

            def event(place: int) -> Function:
                def value(_t: float, y: Array) -> float:
                    kernels.switch_values(modes, c, code, direction, y, values)
                    return float(values[place])

                return _falling(value)

            return rate, [event(place) for place in range(len(switch_kinds(phase, bonded)))]

        return parts


class InNumpy(SolveIvp):
    """The same with a right-hand side in numpy: what most users write."""

    def __init__(self, algorithm: str, order: float = math.nan) -> None:
        super().__init__(algorithm, order)
        self.label = f"scipy {algorithm}, numpy right-hand side"
        self.look = (self.look[0], self.look[1], "--")

    def _functions(self, physics: Physics) -> Callable[[Phase], tuple[Function, list[Function]]]:
        def parts(phase: Phase) -> tuple[Function, list[Function]]:
            events = [_falling(lambda _t, y, switch=switch: switch.value(y)) for switch in switches(physics, phase)]
            return lambda _t, y: physics.rate(phase.name, phase.direction, y), events

        return parts


def _falling(function: Any) -> Function:
    function.terminal, function.direction = True, -1
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
