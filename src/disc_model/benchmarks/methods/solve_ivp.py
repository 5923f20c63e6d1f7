"""scipy's integrators with terminal events, restarted at every event."""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import GaveUp, Meter, MethodResult, Problem
from disc_model.benchmarks.methods.phases import ENDS, Ended, run_phases
from disc_model.benchmarks.methods.physics import Array, Physics

Function = Callable[[float, Array], Any]


def solve(problem: Problem, value: float, budget: float, algorithm: str) -> MethodResult:
    """`scipy.integrate.solve_ivp` with a compiled right-hand side and, where one is used, a compiled Jacobian."""
    meter = Meter(problem, budget)
    scale, least = absolute_scale(meter.physics), 2.3e-14  # scipy accepts no smaller relative tolerance

    def advance(phase: int, direction: int, t: float, y: Array, t_end: float) -> Ended:
        rate, slopes, events = _functions(meter, phase, direction)
        more = {"jac": slopes} if algorithm in ("LSODA", "Radau") else {"max_step": problem.max_step}
        with np.errstate(over="ignore", invalid="ignore"):
            found = solve_ivp(
                meter.counted(rate), (t, t_end), y,
                method=algorithm, rtol=max(value, least), atol=value * scale, events=events, **more,
            )  # fmt: skip
        meter.steps(found.t, found.y.T)
        if found.status == -1:
            raise GaveUp(found.message)
        cause = next((i for i, times in enumerate(found.t_events) if len(times)), None)
        return cause, float(found.t[-1]), found.y[:, -1].copy()

    return run_phases(advance, meter)


def _functions(meter: Meter, phase: int, direction: int) -> tuple[Function, Function, list[Function]]:
    """Right-hand side and Jacobian of a phase, and the functions that fall through zero at its end."""
    modes, c, values = meter.modes, meter.c, np.empty(3)

    def rate(_t: float, y: Array) -> Array:
        dy = np.empty_like(y)
        kernels.rate(modes, c, phase, direction, y, dy)
        return dy

    def slopes(_t: float, y: Array) -> Array:
        J = np.empty((len(y), len(y)))
        kernels.jacobian(modes, c, phase, direction, y, J)
        return J

    def event(place: int) -> Function:
        def value(_t: float, y: Array) -> float:
            kernels.switch_values(modes, c, phase, direction, y, values)
            return float(values[place])

        return crossing(value, -1, last=True)

    return rate, slopes, [event(place) for place in range(ENDS[phase])]


def crossing(function: Any, direction: int, *, last: bool) -> Function:
    """An event in scipy's form: the sign of the change of ``function`` (0: either), and whether it is terminal."""
    function.terminal, function.direction = last, direction
    return function  # type: ignore[no-any-return]


def absolute_scale(physics: Physics) -> Array:
    """Scale of each entry of the state for absolute tolerances: static deflection, and its velocity."""
    p = physics.p
    deflection = p.N * np.abs(physics.shape) / physics.stiffness
    velocity = deflection * physics.omega
    angle = p.mu_s * p.N / (p.k_p * p.r_0)
    speed = max(p.Omega, 1e-3)
    height = max(abs(physics.u_0), 1e-12)
    tail = (max(angle, 1e-9), speed, height, height * float(physics.omega.min()))
    return np.concatenate([deflection, deflection, velocity, velocity, tail])
