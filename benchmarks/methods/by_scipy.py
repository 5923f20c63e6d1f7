"""scipy's integrators: phase by phase, and on a regularised model without events."""

from __future__ import annotations

import math
from collections.abc import Callable
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


def _event(function: Callable[[float, Array], float], direction: int, *, last: bool) -> Any:
    """Return an event in scipy's form.

    Parameters
    ----------
    function : whose zero is the event
    direction : sign of its change there, 0 for either
    last : whether the integration ends there
    """
    event: Any = partial(function)
    event.terminal = last
    event.direction = direction
    return event


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
        events = [_event(partial(margin, index), -1, last=True) for index in range(ENDS[phase])]
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
        meter.steps(solution.t, solution.y.T)
        if solution.status == -1:
            raise GaveUp(RunStatus.FAILED, solution.message)
        cause = next((i for i, times in enumerate(solution.t_events) if len(times)), None)
        return cause, float(solution.t[-1]), solution.y[:, -1].copy()

    return run_phases(advance, meter)


# ---- The regularised model

PENALTY = 1e7
"""K eps, N/m times rad/s; the damping C is critical for the slider against the disc."""
CREEP = 3.0
"""abs(f)/eps below which the slider counts as sticking."""
RTOL = 1e-8
SHORT_STICK = 1e-6
"""Time in stick below which f only passes zero, s."""
Switch = tuple[float, str]
"""Time, s, and kind of an event."""


def solve_regularised(
    problem: Problem, value: float, budget: float, algorithm: str
) -> MethodResult:
    """Integrate a model without events, one stiff ODE, with an algorithm of scipy.

    The model is `kernels.smooth_rate`. Its error is about eps^(2/3), because stick ends by slow
    passage through a fold, the maximum of the law of friction.

    Parameters
    ----------
    problem : what is integrated
    value : eps, rad/s
    budget : seconds
    algorithm : of scipy
    """
    meter = Meter(problem, budget)
    physics = meter.physics
    p = problem.parameters
    start = problem.start
    stiffness = PENALTY / value
    damping = 2.0 * math.sqrt(stiffness / (1.0 / p.m + physics.compliance))
    law = np.array([value, _excess(p.mu_s, p.mu_k), stiffness, damping])

    def force(_t: float, y: Array) -> float:
        return float(kernels.smooth_force(physics.modes, physics.c, law, y))

    def rate(_t: float, y: Array) -> Array:
        dy = np.empty_like(y)
        kernels.smooth_rate(physics.modes, physics.c, law, y, dy)
        return dy

    def creep(_t: float, y: Array) -> float:
        return float(abs(y[physics.f]) - CREEP * value)

    t = 0.0
    y = physics.pack(start)
    if start.phase != "separation":
        # the penetration carries the contact force
        y[physics.u], y[physics.v] = physics.disc_point(y)
        P, _ = kernels.contact(physics.modes, physics.c, start.direction, y)
        y[physics.u] -= P / stiffness
    rate(t, y)  # compiles

    events = [_event(creep, 0, last=False), _event(force, 0, last=False)]
    if problem.stop:
        events.append(_event(force, -1, last=True))
    switches: list[Switch] = []
    with meter.running(), np.errstate(over="ignore", invalid="ignore"):
        solution = solve_ivp(
            meter.counted(rate),
            (t, problem.span),
            y,
            method=algorithm,
            rtol=RTOL,
            atol=RTOL * physics.scale(),
            events=events,
        )
        meter.steps(solution.t, solution.y.T)
        t = float(solution.t[-1])
        y = solution.y[:, -1]
        for time, state in zip(solution.t_events[0], solution.y_events[0], strict=True):
            if force(time, state) > 0:  # in separation a zero of f is no event
                leaving = np.sign(state[physics.f]) * rate(time, state)[physics.f] > 0
                switches.append((float(time), "stick_to_slip" if leaving else "slip_to_stick"))
        for time, state in zip(solution.t_events[1], solution.y_events[1], strict=True):
            soon = state + 1e-9 * rate(time, state)
            rising = force(time, soon) > force(time, state)
            switches.append((float(time), "reattachment" if rising else "separation"))
        if solution.status < 0:
            raise GaveUp(RunStatus.FAILED, solution.message)

    if not np.all(np.isfinite(y)):
        meter.outcome = RunStatus.NON_FINITE
    merged = _merged(switches)
    phase, direction = _phase(force(t, y), float(y[physics.f]), CREEP * value)
    final = physics.unpack(start.time + t, phase, direction, y)
    return meter.result([time for time, _ in merged], [kind for _, kind in merged], final)


def _phase(force: float, f: float, creep: float) -> tuple[str, int]:
    """Return the phase of a state of the regularised model, and its direction.

    Parameters
    ----------
    force : penalty force, N
    f : speed of the slider, rad/s
    creep : speed below which it sticks, rad/s
    """
    if force <= 0:
        return "separation", 0
    if abs(f) < creep:
        return "stick", 0
    return "slip", 1 if f > 0 else -1


def _excess(mu_s: float, mu_k: float) -> float:
    """Return the height of the Stribeck peak for which the law's maximum is the static friction.

    The height is that over kinetic friction.
    """
    x = np.linspace(0.0, 2.0 * kernels.STRIBECK, 20_001)
    rise = np.tanh(x)
    fall = np.exp(-((x / kernels.STRIBECK) ** 2))
    excess = mu_s - mu_k
    for _ in range(50):
        maximum = float(np.max(rise * (mu_k + excess * fall)))
        excess += mu_s - maximum
    return excess


def _merged(events: list[Switch]) -> list[Switch]:
    """Return events in order of time; a stick in which f only passes zero is a slip reversal."""
    merged: list[Switch] = []
    for t, kind in sorted(events):
        begin, last = merged[-1] if merged else (-math.inf, "")
        if (last, kind) == ("slip_to_stick", "stick_to_slip") and t - begin < SHORT_STICK:
            merged[-1] = (begin, "slip_reversal")
        else:
            merged.append((t, kind))
    return merged
