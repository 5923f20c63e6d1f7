"""scipy's integrators with terminal events, started anew at every switch."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from disc_model.benchmarks.methods.base import Meter, Method, MethodResult, Problem
from disc_model.benchmarks.methods.phases import GUARD, Ended, IntegrationFailed, Phase, run_phases, switches
from disc_model.benchmarks.methods.physics import Array, Physics


class SolveIvp(Method):
    """`scipy.integrate.solve_ivp` with a numpy right-hand side.

    ``max_step`` (s) bounds the steps; ``guard`` (s): see `phases.GUARD`.
    """

    requires = ("scipy",)

    def __init__(self, algorithm: str, order: float, max_step: float = np.inf, guard: float = GUARD) -> None:
        self.algorithm, self.max_step, self.guard = algorithm, max_step, guard
        self.name = algorithm  # type: ignore[misc]
        self.label = f"scipy {algorithm}"  # type: ignore[misc]
        self.order = order  # type: ignore[misc]

    def _solve(self, problem: Problem, value: float, budget: float) -> MethodResult:
        physics = Physics(problem.parameters)
        scale = absolute_scale(physics)
        meter = Meter(budget)

        def integrate(phase: Phase, t: float, y: Array, t_end: float, events: list[Any]) -> Any:
            with np.errstate(over="ignore", invalid="ignore"):
                found = solve_ivp(
                    meter.counted(lambda _t, z: physics.rate(phase.name, phase.direction, z)),
                    (t, t_end),
                    y,
                    method=self.algorithm,
                    rtol=max(value, 2.3e-14),  # scipy's own floor
                    atol=value * scale,
                    max_step=self.max_step,
                    events=events,
                )
            meter.steps(found.t)
            if found.status == -1:
                raise IntegrationFailed(found.message)
            return found

        def advance(phase: Phase, t: float, y: Array, t_end: float) -> Ended:
            if phase.name == "separation" and self.guard > 0:
                until = min(t + self.guard, t_end)
                t, y = until, integrate(phase, t, y, until, []).y[:, -1]
                if until >= t_end:
                    return Ended(None, t_end, y)
            found = integrate(phase, t, y, t_end, [_event(switch.value) for switch in switches(physics, phase)])
            if found.status == 0:
                return Ended(None, t_end, found.y[:, -1])
            cause = next(i for i, times in enumerate(found.t_events) if len(times))
            return Ended(cause, float(found.t[-1]), found.y[:, -1])

        return run_phases(problem, physics, advance, meter)


def _event(function: Any) -> Any:
    def g(_t: float, z: Array) -> float:
        return float(function(z))

    g.terminal, g.direction = True, -1  # type: ignore[attr-defined]
    return g


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
