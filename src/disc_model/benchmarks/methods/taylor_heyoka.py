"""heyoka (extra `bench`): compiled Taylor integrators in double precision with native terminal events.

The equations are arranged for the least work in heyoka.  Constants are merged into one coefficient per state.  The
products of f with the modal states are shared by equations and contact force.  The force has one division, and the
direction of slip is a parameter.  Loss of contact in stick needs no event: stick ends before.
Compact mode takes twice as long and ``slp_vectorize`` a tenth more; ``force_avx512`` changes nothing.
"""

from __future__ import annotations

import time as clock
from collections.abc import Iterable
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from disc_model.benchmarks.methods.base import ENDS, Ended, GaveUp, Meter, MethodResult, Problem, run_phases
from disc_model.benchmarks.methods.kernels import SHIFT, Array, Physics
from disc_model.data.variables import PHASES
from disc_model.parameters import Parameters

STEPS_PER_LOOK = 100_000
"""Number of steps between two checks of the clock."""


def solve(problem: Problem, value: float, budget: float, mode: str = "") -> MethodResult:
    """heyoka's adaptive Taylor integrator; ``mode`` "compact": it compiles sooner and takes longer."""
    import heyoka as hy

    meter, p = Meter(problem, budget), problem.parameters
    drive = (p.N - p.k * meter.physics.u_0, p.Omega)  # in the order of `system`
    at_end, no_more = int(hy.taylor_outcome.time_limit), int(hy.taylor_outcome.step_limit)
    path: list[tuple[float, Array]] = []
    inside = 0.0

    def note(integrator: Any) -> bool:
        path.append((float(integrator.time), integrator.state.copy()))
        return True

    # called at every step, which takes longer than some steps
    seen = {"callback": note} if problem.watched else {}
    prepared = []
    for ends, integrator in zip(ENDS, _integrators(p.replace(N=1.0, Omega=1.0), value, mode == "compact"), strict=True):
        integrator.pars[:2] = drive
        # with fewer events, the last ones of ENDS
        state = integrator.state
        skipped = ends - len(integrator.t_events)
        prepared.append((integrator, integrator.propagate_until, state, len(state), skipped))

    def advance(phase: int, direction: int, t: float, y: Array, t_end: float) -> Ended:
        nonlocal inside
        integrator, propagate, state, size, skipped = prepared[phase]
        integrator.time, state[:] = t, y[:size]
        if direction:
            integrator.pars[2] = direction
        path.clear()
        began = clock.perf_counter()
        outcome, _, _, steps, _, _ = propagate(t_end, max_steps=STEPS_PER_LOOK, **seen)
        while (stop := int(outcome)) == no_more:
            meter.work += steps
            meter.check()
            outcome, _, _, steps, _, _ = propagate(t_end, max_steps=STEPS_PER_LOOK, **seen)
        inside += clock.perf_counter() - began
        meter.work += steps
        cause = None if stop == at_end else skipped - stop - 1
        if cause is not None and not skipped <= cause < ENDS[phase]:
            raise GaveUp(str(outcome))
        if problem.watched:
            note(integrator)
            states = np.tile(y, (len(path) + 1, 1))
            states[1:, : len(state)] = [state for _, state in path]
            meter.steps(np.array([t, *(time for time, _ in path)]), states)
        y[:size] = state
        return cause, integrator.time, y

    result = run_phases(advance, meter)
    return replace(result, glue=result.seconds * (1.0 - inside / meter.wall))


@lru_cache(maxsize=32)
def _integrators(p: Parameters, tol: float, compact: bool) -> list[Any]:
    """Compiled integrators by phase; cases that differ in load and speed of the drive share them, see `system`."""
    import heyoka as hy

    made = []
    for phase in PHASES:
        rows, functions = system(Physics(p), phase)
        falling = [hy.t_event(g, direction=hy.event_direction.negative, cooldown=0.0) for g in functions]
        options = {"tol": tol, "compact_mode": compact, "fast_math": True}
        made.append(hy.taylor_adaptive(rows, np.zeros(len(rows)), t_events=falling, **options))
    return made


def system(physics: Physics, phase: str) -> tuple[list[Any], list[Any]]:
    """Equations of a phase as heyoka expressions, in the order of the state vector, and the last of `base.ENDS`.

    Parameters at run time: N - k u_0, Omega and, in slip, its direction.
    """
    import heyoka as hy

    p, n, l, s = physics.p, physics.n, physics.l, physics.shape
    load, drive, sign = (hy.par[i] for i in range(3))
    a, b, alpha, beta = ([hy.make_vars(f"{letter}{i}") for i in range(n)] for letter in "abpq")
    psi, f, u, v = hy.make_vars("psi", "f", "u", "v")
    nothing = hy.expression(0.0)
    sticks, touches = phase == "stick", phase != "separation"
    turning = [] if sticks else [i for i in range(n) if l[i] > 0]
    fa, fb, falpha, fbeta = ({i: f * x[i] for i in turning} for x in (a, b, alpha, beta))

    def combined(*terms: tuple[Any, Any]) -> Any:
        used = [factor * x for factor, x in terms if not isinstance(factor, float) or factor]
        return hy.sum(used) if used else nothing

    def each(factors: Any, x: Any, modes: Iterable[int] = range(n)) -> list[tuple[float, Any]]:
        return [(float(factors[i]), x[i]) for i in modes]

    F = combined((p.k_p, psi), (p.c_p, drive), (0.0 if sticks else -p.c_p, f))
    P = nothing
    if touches:
        below = 1.0 + p.m * physics.compliance
        by = s / below
        held = each((p.k - p.m * physics.stiffness) * by, a) + each((p.c - p.m * physics.damping) * by, alpha)
        P = combined(
            (1.0 / below, load), *held, *each(2.0 * p.m * l * by, fbeta, turning), *each(p.c * l * by, fb, turning)
        )
    if turning and touches:
        tilt = combined(*each(l * by, b, turning))
        P = P - f * combined(*each(p.m * l**2 * by, fa, turning)) + tilt * F
        P = P / (1.0 + sign * (p.mu_k / p.r_0 * tilt))
    f_rate = nothing if sticks else F / p.m
    if phase == "slip":
        f_rate = f_rate - sign * (p.mu_k / (p.m * p.r_0)) * P

    def row(i: int, *own: tuple[float, Any], turned: tuple[float, Any]) -> Any:
        factor, product = turned
        return combined(*own, *([(factor, product[i])] if i in product else []))

    d, w2 = -physics.damping, -physics.stiffness
    rows = [(a[i], row(i, (1.0, alpha[i]), turned=(l[i], fb))) for i in range(n)]
    rows += [(b[i], row(i, (1.0, beta[i]), turned=(-l[i], fa)) if l[i] else nothing) for i in range(n)]
    push = [(-float(s[i]), P) if touches else (0.0, P) for i in range(n)]
    rows += [(alpha[i], row(i, (d[i], alpha[i]), (w2[i], a[i]), push[i], turned=(l[i], fbeta))) for i in range(n)]
    rows += [
        (beta[i], row(i, (d[i], beta[i]), (w2[i], b[i]), turned=(-l[i], falpha)) if l[i] else nothing) for i in range(n)
    ]
    rows += [(psi, drive if sticks else drive - f), (f, f_rate)]
    if not touches:
        rows += [(u, v), (v, combined((-1.0 / p.m, load), (-p.k / p.m, u), (-p.c / p.m, v)))]
        return rows, [SHIFT + u - combined(*each(s, a))]
    if sticks:
        return rows, [p.mu_s * P - p.r_0 * F, p.mu_s * P + p.r_0 * F]
    return rows, [sign * f] if p.contact == "bilateral" else [P, sign * f]
