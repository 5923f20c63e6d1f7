"""heyoka's compiled Taylor series, of the extra ``bench``, phase by phase.

Its equations are arranged for the least work, without an event for loss of contact in stick, which
ends before.
"""

from __future__ import annotations

import time as clock
from collections.abc import Sequence
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

Terms = tuple[Any, Any]
"""Factors and variables, whose products are summed."""


class Disc(NamedTuple):
    """The modes of the disc as variables of heyoka, a list of each."""

    a: list[Any]
    b: list[Any]
    alpha: list[Any]
    beta: list[Any]

    def times(self, factor: Any) -> Disc:
        """Return the products of all variables with a factor."""
        products = []
        for each in self:
            products.append([factor * x for x in each])
        return Disc(*products)


def _disc(n: int) -> Disc:
    """Return the variables of a number of modes."""
    import heyoka as hy

    lists = []
    for letter in "abpq":
        lists.append([hy.make_vars(f"{letter}{i}") for i in range(n)])
    return Disc(*lists)


def _total(*terms: Terms) -> Any:
    """Return the sum of products of factors and variables, without those that vanish."""
    import heyoka as hy

    used = []
    for factors, variables in terms:
        for factor, variable in zip(factors, variables, strict=True):
            if factor:
                used.append(float(factor) * variable)
    return hy.sum(used) if used else hy.expression(0.0)


def _each(*terms: Terms) -> list[Any]:
    """Return such a sum for each mode."""
    factors, _ = terms[0]
    rows = []
    for i in range(len(factors)):
        of_mode = [(c[i : i + 1], x[i : i + 1]) for c, x in terms]
        rows.append(_total(*of_mode))
    return rows


def system(physics: Physics, phase: str) -> tuple[list[Any], list[Any]]:
    """Return the equations of a phase as heyoka expressions.

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
    disc = _disc(physics.n)
    psi, f, u, v = hy.make_vars("psi", "f", "u", "v")
    turning = disc.times(f)
    sticks = phase == "stick"
    touches = phase != "separation"
    l = 0.0 * physics.l if sticks else physics.l

    F = _total(((p.k_p, p.c_p, 0.0 if sticks else -p.c_p), (psi, drive, f)))
    P = hy.expression(0.0)
    if touches:
        P = _contact_force(physics, l, disc, turning, f, F)
    f_rate = hy.expression(0.0)
    if not sticks:
        f_rate = F / p.m
    if phase == "slip":
        f_rate = f_rate - sign * (p.mu_k / (p.m * p.r_0)) * P

    rates = _disc_rates(physics, l, disc, turning, P, touches)
    rates += [drive if sticks else drive - f, f_rate]
    rows = list(zip([*disc.a, *disc.b, *disc.alpha, *disc.beta, psi, f], rates, strict=True))

    if not touches:
        rows.append((u, v))
        rows.append((v, _total(((-1.0 / p.m, -p.k / p.m, -p.c / p.m), (load, u, v)))))
        return rows, [SHIFT + u - _total((physics.shape, disc.a))]
    if sticks:
        return rows, [p.mu_s * P - p.r_0 * F, p.mu_s * P + p.r_0 * F]
    if p.contact == "bilateral":
        return rows, [sign * f]
    return rows, [P, sign * f]


def _contact_force(physics: Physics, l: Array, disc: Disc, turning: Disc, f: Any, F: Any) -> Any:
    """Return the contact force as an expression.

    Parameters
    ----------
    physics : constants of the case
    l : nodal diameters, zero in stick
    disc, turning : the modes, and these times f
    f, F : speed of the slider, and the force on it in the plane
    """
    import heyoka as hy

    p = physics.p
    load = hy.par[0]
    sign = hy.par[2]
    below = 1.0 + p.m * physics.compliance
    by = physics.shape / below
    P = _total(
        ([1.0 / below], [load]),
        ((p.k - p.m * physics.stiffness) * by, disc.a),
        ((p.c - p.m * physics.damping) * by, disc.alpha),
        (2.0 * p.m * l * by, turning.beta),
        (p.c * l * by, turning.b),
    )
    if l.any():
        tilt = _total((l * by, disc.b))
        P = P - f * _total((p.m * l**2 * by, turning.a)) + tilt * F
        P = P / (1.0 + sign * (p.mu_k / p.r_0 * tilt))
    return P


def _disc_rates(
    physics: Physics, l: Array, disc: Disc, turning: Disc, P: Any, touches: bool
) -> list[Any]:
    """Return the rates of the modes as expressions, those of a, b, alpha and beta in turn.

    Parameters
    ----------
    physics : constants of the case
    l : nodal diameters, zero in stick
    disc, turning : the modes, and these times f
    P : contact force
    touches : whether there is contact
    """
    paired = 1.0 * (physics.l > 0)
    ones = np.ones(physics.n)
    damping = -physics.damping
    stiffness = -physics.stiffness
    forces: Sequence[Any] = [P] * physics.n
    load = -physics.shape * touches
    return [
        *_each((ones, disc.alpha), (l, turning.b)),
        *_each((paired, disc.beta), (-l, turning.a)),
        *_each((damping, disc.alpha), (stiffness, disc.a), (load, forces), (l, turning.beta)),
        *_each((damping * paired, disc.beta), (stiffness * paired, disc.b), (-l, turning.alpha)),
    ]
