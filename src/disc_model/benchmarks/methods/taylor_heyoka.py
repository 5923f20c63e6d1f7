"""heyoka (extra `bench`): compiled Taylor integrators in double precision with native terminal events.

What a competent user would write: one integrator per phase, not compact, ``fast_math`` on.  Right after contact is
lost the gap has a triple root, where native event detection fails or not as rounding will have it (at the base case
in compact mode it does); the hand-tuned interval `phases.GUARD` is crossed without looking.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from disc_model.benchmarks.methods.base import MAP_TOLERANCES, GaveUp, Meter, Method, MethodResult, Problem, decades
from disc_model.benchmarks.methods.phases import GUARD, Ended, Phase, run_phases
from disc_model.benchmarks.methods.physics import Array, Physics
from disc_model.parameters import Parameters

STEPS_PER_LOOK = 100_000
"""Steps between two looks at the clock."""


class Heyoka(Method):
    """heyoka's adaptive Taylor integrator."""

    label = "heyoka"
    settings: Mapping[str, Sequence[float]] = {
        **dict.fromkeys(("stick_slip", "separating"), decades(-4, -6, -8, -9, -10, -12, -14)),
        "many_modes": decades(-4, -6, -8, -10, -12),
        "rigid": decades(-4, -8),
    }
    map_values = MAP_TOLERANCES[::2]

    guard = GUARD

    def __init__(self, compact: bool = False) -> None:
        self.compact = compact

    def economical(self) -> Heyoka:
        """In compact mode: a map compiles it for every truncation and tolerance."""
        return type(self)(compact=True)

    def _solve(self, problem: Problem, value: float, budget: float) -> MethodResult:
        import heyoka as hy

        physics = Physics(problem.parameters)
        p = problem.parameters
        integrators = _integrators(p.replace(N=1.0, Omega=1.0), value, self.compact)
        given = (p.N, p.Omega, physics.u_0)  # in the order of `_system`
        places = _places(physics)
        meter = Meter(problem, physics, budget)
        path: list[tuple[float, Array]] = []

        def note(integrator: Any) -> bool:
            path.append((float(integrator.time), integrator.state.copy()))
            return True

        # called at every step, which takes longer than some of these do
        seen = {"callback": note} if problem.watched else {}

        def advance(phase: Phase, t: float, y: Array, t_end: float, *, watched: bool) -> Ended:
            integrator, place = integrators[phase, watched], places[phase.name]
            integrator.time, integrator.state[:], integrator.pars[:] = t, y[place], given
            if integrator.with_events:
                integrator.reset_cooldowns()
            path.clear()
            outcome = hy.taylor_outcome.step_limit
            while outcome == hy.taylor_outcome.step_limit:
                meter.check()
                outcome, _, _, steps, _, _ = integrator.propagate_until(t_end, max_steps=STEPS_PER_LOOK, **seen)
                meter.work += int(steps)
            reached = outcome == hy.taylor_outcome.time_limit
            if not reached and (int(outcome) >= 0 or outcome == hy.taylor_outcome.err_nf_state):
                raise GaveUp(str(outcome))
            if watched and problem.watched:
                note(integrator)
                states = np.tile(y, (len(path) + 1, 1))
                states[1:, place] = [state for _, state in path]
                meter.path(np.array([t, *(time for time, _ in path)]), states)
            end = y.copy()
            end[place] = integrator.state
            return Ended(None if reached else -int(outcome) - 1, float(integrator.time), end)

        return run_phases(problem, physics, advance, meter, self.guard)


class Unguarded(Heyoka):
    """As heyoka documents it, native events trusted at the start of a separation too."""

    label = "heyoka, no guard step"
    settings: Mapping[str, Sequence[float]] = {}
    guard = 0.0


def _places(physics: Physics) -> dict[str, Array]:
    """Where heyoka's variables stand in the common state vector: modes without diameters have no b and beta."""
    n = physics.n
    turning = np.flatnonzero(physics.l > 0)
    modal = np.concatenate([np.arange(n), 2 * n + np.arange(n), n + turning, 3 * n + turning, [physics.psi, physics.f]])
    return {"stick": modal, "slip": modal, "separation": np.concatenate([modal, [physics.u, physics.v]])}


@lru_cache(maxsize=32)
def _integrators(p: Parameters, tol: float, compact: bool) -> dict[Any, Any]:
    """Compiled integrators by phase, and by whether its end is watched for, which it need not be in separation only.

    Load, speed of the drive and height at rest are given at run time, so that cases that differ in these share them.
    """
    import heyoka as hy

    physics = Physics(p)
    options = {"tol": tol, "compact_mode": compact, "fast_math": True}
    integrators: dict[Any, Any] = {}
    for phase in (Phase("stick", 0), Phase("slip", 1), Phase("slip", -1), Phase("separation", 0)):
        rows, functions = _system(physics, phase)
        falling = [hy.t_event(g, direction=hy.event_direction.negative) for g in functions]
        integrators[phase, True] = hy.taylor_adaptive(rows, np.zeros(len(rows)), t_events=falling, **options)
        if phase.name == "separation":
            integrators[phase, False] = hy.taylor_adaptive(rows, np.zeros(len(rows)), **options)
    return integrators


def _system(physics: Physics, phase: Phase) -> tuple[list[Any], list[Any]]:
    """Equations of a phase as heyoka expressions, ordered as in `_places`; its switches, as in `phases.ENDS`."""
    import heyoka as hy

    p, n, l, s = physics.p, physics.n, physics.l, physics.shape
    load, drive, rest = (hy.par[i] for i in range(3))
    turning = [i for i in range(n) if l[i] > 0]
    a, alpha = ([hy.make_vars(f"{letter}{i}") for i in range(n)] for letter in "ap")
    b, beta = {i: hy.make_vars(f"b{i}") for i in turning}, {i: hy.make_vars(f"q{i}") for i in turning}
    psi, f, u, v = hy.make_vars("psi", "f", "u", "v")
    rate = f if phase.name != "stick" else hy.expression(0.0)
    F = p.k_p * psi + p.c_p * (drive - rate)
    free = [-physics.damping[i] * alpha[i] - physics.stiffness[i] * a[i] for i in range(n)]
    w = hy.sum([s[i] * a[i] for i in range(n)])
    P, f_rate = hy.expression(0.0), F / p.m
    if phase.name != "separation":
        zero = [hy.expression(0.0)]
        slope = hy.sum([l[i] * s[i] * b[i] for i in turning] + zero)
        A = hy.sum([s[i] * free[i] for i in range(n)])
        velocity = hy.sum([s[i] * alpha[i] for i in range(n)])
        if phase.name == "slip":
            A = A + rate * hy.sum([2 * l[i] * s[i] * beta[i] for i in turning] + zero)
            A = A - rate * rate * hy.sum([l[i] ** 2 * s[i] * a[i] for i in turning] + zero)
            velocity = velocity + rate * slope
        top, below = load + p.k * (w - rest) + p.c * velocity + p.m * A, 1.0 + p.m * physics.compliance
        if phase.name == "slip":
            P = (top + slope * F) / (below + phase.direction * p.mu_k / p.r_0 * slope)
            f_rate = F / p.m - phase.direction * p.mu_k / (p.m * p.r_0) * P
        else:
            P, f_rate = top / below, hy.expression(0.0)
    rows = [(a[i], alpha[i] + (l[i] * rate * b[i] if i in b else 0.0)) for i in range(n)]
    rows += [(alpha[i], free[i] + (l[i] * rate * beta[i] if i in b else 0.0) - s[i] * P) for i in range(n)]
    rows += [(b[i], beta[i] - l[i] * rate * a[i]) for i in turning]
    rows += [
        (beta[i], -physics.damping[i] * beta[i] - physics.stiffness[i] * b[i] - l[i] * rate * alpha[i]) for i in turning
    ]
    rows += [(psi, drive - rate), (f, f_rate)]
    if phase.name == "separation":
        rows += [(u, v), (v, -(load + p.k * (u - rest) + p.c * v) / p.m)]
        return rows, [u - w]
    contact = hy.sigmoid(f) if p.contact == "bonded" else P  # never zero, and no constant, which heyoka refuses
    if phase.name == "slip":
        return rows, [contact, phase.direction * f]
    return rows, [contact, p.mu_s * P - p.r_0 * F, p.mu_s * P + p.r_0 * F]
