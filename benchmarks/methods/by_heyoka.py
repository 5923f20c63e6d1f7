"""heyoka's compiled Taylor series, of the extra ``bench``, phase by phase.

Its equations are arranged for the least work, without an event for loss of contact in stick, which
ends before.
"""

from __future__ import annotations

import time as clock
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from benchmarks.methods.integrators import GaveUp, Meter, MethodResult, Problem, RunStatus
from benchmarks.methods.kernels import SHIFT, Array, Physics
from benchmarks.methods.phases import ENDS, Ended, run_phases
from disc_model.data.variables import PHASES
from disc_model.parameters import Parameters

CHECKED_STEPS = 100_000
"""Number of steps between two looks at the clock."""


class Prepared(NamedTuple):
    """An integrator of a phase, with what is looked up in every phase."""

    integrator: Any
    propagate: Any
    """Its method ``propagate_until``."""
    state: Array
    """Its state, which is the first part of the vector."""
    skipped: int
    """How many of the first functions of `ENDS` it leaves out."""


def solve_by_heyoka(problem: Problem, value: float, budget: float, mode: str = "") -> MethodResult:
    """Integrate with heyoka's adaptive Taylor integrator.

    Parameters
    ----------
    problem : what is integrated
    value : tolerance
    budget : seconds
    mode : "compact" to compile sooner and take longer
    """
    import heyoka as hy

    meter = Meter(problem, budget)
    at_end = int(hy.taylor_outcome.time_limit)
    no_more = int(hy.taylor_outcome.step_limit)
    prepared = _prepared(problem, meter.physics, value, mode == "compact")
    inside = 0.0  # s spent in compiled code

    def advance(phase: int, direction: int, t: float, y: Array, t_end: float) -> Ended:
        nonlocal inside
        integrator, propagate, state, skipped = prepared[phase]
        size = len(state)
        integrator.time = t
        state[:] = y[:size]
        if direction:
            integrator.pars[2] = direction

        began = clock.perf_counter()
        while True:
            stop = int(propagate(t_end, max_steps=CHECKED_STEPS)[0])
            if stop != no_more:
                break
            meter.check()
        inside += clock.perf_counter() - began

        cause = None
        if stop != at_end:
            cause = skipped - stop - 1
            if not skipped <= cause < ENDS[phase]:
                raise GaveUp(RunStatus.FAILED)
        y[:size] = state
        return cause, integrator.time, y

    result = run_phases(advance, meter)
    return replace(result, glue=result.seconds * (1.0 - inside / meter.wall))


def _prepared(problem: Problem, physics: Physics, tol: float, compact: bool) -> list[Prepared]:
    """Return the integrators of a problem, by phase.

    Parameters
    ----------
    problem, physics : what is integrated, and its constants
    tol : tolerance
    compact : whether to compile sooner and take longer
    """
    p = problem.parameters
    load = p.N - p.k * physics.u_0
    prepared = []
    shared = _integrators(p.replace(N=1.0, Omega=1.0), tol, compact)
    for ends, integrator in zip(ENDS, shared, strict=True):
        integrator.pars[:2] = (load, p.Omega)  # in the order of `system`
        # with fewer events, they are the last ones of ENDS
        skipped = ends - len(integrator.t_events)
        prepared.append(Prepared(integrator, integrator.propagate_until, integrator.state, skipped))
    return prepared


@lru_cache(maxsize=32)
def _integrators(p: Parameters, tol: float, compact: bool) -> list[Any]:
    """Return compiled integrators by phase.

    Cases that differ in load and speed of the drive share them, see `system`.

    Parameters
    ----------
    p : the case
    tol : tolerance
    compact : whether to compile sooner and take longer
    """
    import heyoka as hy

    integrators = []
    for phase in PHASES:
        rows, functions = system(Physics(p), phase)
        falling = hy.event_direction.negative
        events = [hy.t_event(g, direction=falling, cooldown=0.0) for g in functions]
        integrators.append(
            hy.taylor_adaptive(
                rows,
                np.zeros(len(rows)),
                t_events=events,
                tol=tol,
                compact_mode=compact,
                fast_math=True,
            )
        )
    return integrators


# ---- The equations


def system(physics: Physics, phase: str) -> tuple[list[Any], list[Any]]:
    """Return the equations of a phase as heyoka expressions; what is multiplied by zero vanishes.

    Parameters at run time are N - k u_0, Omega and, in slip, its direction.

    Returns
    -------
    list of pairs
        Variables with their rates, in the order of the state vector.
    list of expressions
        The last ones of the functions of `ENDS`.
    """
    import heyoka as hy

    p = physics.p
    load, drive, sign = (hy.par[i] for i in range(3))
    a, b, alpha, beta = (
        np.array([hy.make_vars(f"{letter}{i}") for i in range(physics.n)]) for letter in "abpq"
    )
    psi, f, u, v = hy.make_vars("psi", "f", "u", "v")
    sticks = phase == "stick"
    touches = phase != "separation"
    l = 0.0 * physics.l if sticks else physics.l
    psi_rate = drive if sticks else drive - f

    F = p.k_p * psi + p.c_p * psi_rate
    P = hy.expression(0.0)
    if touches:
        P = _contact_force(physics, l, (a, b, alpha, beta), f, F)
    f_rate = hy.expression(0.0)
    if not sticks:
        f_rate = F / p.m
    if phase == "slip":
        f_rate = f_rate - sign * (p.mu_k / (p.m * p.r_0)) * P

    # a mode without nodal diameters has no sine
    paired = 1.0 * (physics.l > 0)
    damping = -physics.damping
    stiffness = -physics.stiffness
    rates = [
        *_each(hy, alpha, l * (f * b)),
        *_each(hy, paired * beta, -l * (f * a)),
        *_each(hy, damping * alpha, stiffness * a, -physics.shape * P, l * (f * beta)),
        *_each(hy, damping * paired * beta, stiffness * paired * b, -l * (f * alpha)),
        psi_rate,
        f_rate,
    ]
    rows = list(zip([*a, *b, *alpha, *beta, psi, f], rates, strict=True))

    if not touches:
        rows.append((u, v))
        rows.append((v, hy.sum([-load / p.m, -p.k / p.m * u, -p.c / p.m * v])))
        return rows, [SHIFT + u - hy.sum([*(physics.shape * a)])]
    if sticks:
        return rows, [p.mu_s * P - p.r_0 * F, p.mu_s * P + p.r_0 * F]
    if p.contact == "bilateral":
        return rows, [sign * f]
    return rows, [P, sign * f]


def _each(hy: Any, *terms: Any) -> list[Any]:
    """Return the sum of terms for each mode."""
    return [hy.sum([*of_mode]) for of_mode in zip(*terms, strict=True)]


def _contact_force(physics: Physics, l: Array, modes: Any, f: Any, F: Any) -> Any:
    """Return the contact force as an expression.

    Parameters
    ----------
    physics : constants of the case
    l : nodal diameters, zero in stick
    modes : variables a, b, alpha and beta, an array of each
    f, F : speed of the slider, and the force on it in the plane
    """
    import heyoka as hy

    p = physics.p
    a, b, alpha, beta = modes
    below = 1.0 + p.m * physics.compliance
    by = physics.shape / below
    held = (p.k - p.m * physics.stiffness) * by * a + (p.c - p.m * physics.damping) * by * alpha
    turned = 2.0 * p.m * l * by * (f * beta) + p.c * l * by * (f * b)
    P = hy.sum([hy.par[0] / below, *held, *turned])
    if l.any():
        tilt = hy.sum([*(l * by * b)])
        P = P - f * hy.sum([*(p.m * l**2 * by * (f * a))]) + tilt * F
        P = P / (1.0 + hy.par[2] * (p.mu_k / p.r_0 * tilt))
    return P
