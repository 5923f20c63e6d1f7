"""Where methods fail: what becomes of each over its step or tolerance and the number of modes.

The motion is that of the scene ``separating`` (or ``stick_slip``) for a short span, with modes dropped or added; the
right answer comes from the series engine at `REFERENCE_TOL`, which the stored references confirm for the base model.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
import xarray as xr

from disc_model.benchmarks.machine import machine, one_core
from disc_model.benchmarks.methods import METHODS
from disc_model.benchmarks.methods.base import Problem
from disc_model.benchmarks.methods.physics import Physics
from disc_model.benchmarks.methods.rk4 import STABILITY_LIMIT, FixedStep
from disc_model.benchmarks.scenes import Answer, Verdict, errors, separating_start, shortest_phase, static_start
from disc_model.benchmarks.work_precision import VERDICT
from disc_model.data.variables import Variable
from disc_model.parameters import Parameters

TRUNCATIONS = (1, 2, 4, 6, 8)
"""Highest number of nodal diameters of each row."""
SPANS: Mapping[str, float] = {"stick_slip": 1.0, "separating": 0.1}
"""s"""
REFERENCE_TOL = 1e-14
RESOLUTION = 2e-3
"""Relative, of the largest step that is observed not to blow up."""


@one_core()
def failure_map(
    method: str,
    scene: str = "separating",
    truncations: Sequence[int] = TRUNCATIONS,
    values: Sequence[float] | None = None,
) -> xr.Dataset:
    """Verdicts of a method along (diameters, value), with what explains them.

    Returns
    -------
    Dataset: ``verdict`` (flag), ``event_error`` (s), ``longest_step`` (s) along (diameters, value); along diameters
    ``modes`` (real modes), ``omega_max`` (rad/s), ``step_limit`` = 2 sqrt(2)/omega_max (s), the linear stability limit
    of RK4, ``shortest_phase`` (s), which no step must jump over, ``stiff_epsilon`` (rad/s), below which the
    regularised friction law is stiffer than the disc; for RK4 in ``stick_slip`` also ``observed_limit`` (s), see
    `observed_step_limit`.
    """
    own = METHODS[method].economical()
    values = own.map_values if values is None else values
    shape = (len(truncations), len(values))
    verdict = np.full(shape, int(Verdict.NOT_RUN), dtype=np.int8)
    event_error, longest = np.full(shape, math.nan), np.full(shape, math.nan)
    facts: list[dict[str, float]] = []
    for row, diameters in enumerate(truncations):
        problem = short_problem(scene, diameters)
        answer = engine_answer(scene, diameters)
        for column, value in enumerate(values):
            result = own.solve(problem, value, own.map_budget)
            found = errors(problem, answer, result)
            verdict[row, column] = int(found.verdict)
            event_error[row, column], longest[row, column] = found.event_time, result.longest_step
        facts.append(_facts(problem, answer))
        if method == "RK4" and scene == "stick_slip":
            facts[-1]["observed_limit"] = observed_step_limit(diameters)
    variables = {
        "verdict": (verdict, VERDICT),
        "event_error": (event_error, Variable("s", "largest error of an event time")),
        "longest_step": (longest, Variable("s", "longest step")),
    }
    dataset = map_of(method, truncations, values, variables)
    dataset.attrs |= {"scene": scene, "budget": own.map_budget, "span": SPANS[scene]}
    for name in facts[0]:
        dataset[name] = ("diameters", [fact[name] for fact in facts], _FACTS[name].attributes)
    return dataset


def map_of(
    method: str, diameters: Sequence[int], values: Sequence[float], found: Mapping[str, tuple[np.ndarray, Variable]]
) -> xr.Dataset:
    """Variables of a method's map along (diameters, value), and what the map is of."""
    own = METHODS[method]
    return xr.Dataset(
        {name: (("diameters", "value"), array, about.attributes) for name, (array, about) in found.items()},
        coords={
            "diameters": ("diameters", list(diameters), Variable("1", "highest nodal diameter").attributes),
            "value": ("value", list(values), {"long_name": f"setting: {own.setting}"}),
        },
        attrs={"method": method, "label": own.label, "setting": own.setting, "machine": machine()},
    )


_FACTS = {
    "modes": Variable("1", "number of real modes"),
    "omega_max": Variable("rad s-1", "highest natural frequency of the disc"),
    "step_limit": Variable("s", "linear stability limit of RK4, 2 sqrt(2)/omega_max"),
    "observed_limit": Variable("s", "largest step at which RK4 does not blow up, observed"),
    "shortest_phase": Variable("s", "shortest time between two events"),
    "stiff_epsilon": Variable("rad s-1", "regularisation below which friction is stiffer than the disc"),
}


def _facts(problem: Problem, answer: Answer) -> dict[str, float]:
    p = problem.parameters
    physics = Physics(p)
    top = float(physics.omega.max())
    return {
        "modes": float(physics.n + np.count_nonzero(physics.l > 0)),
        "omega_max": top,
        "step_limit": STABILITY_LIMIT / top,
        "shortest_phase": shortest_phase(answer),
        "stiff_epsilon": p.mu_s * p.N / (p.m * p.r_0 * top),
    }


@lru_cache(maxsize=64)
def short_problem(scene: str, diameters: int) -> Problem:
    """The scene's motion with modes up to ``diameters`` for the span of the maps."""
    p = Parameters(N=385.0, Omega=15.1, n_diameters=diameters)
    start = separating_start(p) if scene == "separating" else static_start(p)
    return Problem(p, start, start.time + SPANS[scene])


@lru_cache(maxsize=64)
def engine_answer(scene: str, diameters: int) -> Answer:
    """The series engine's answer to `short_problem`, at the tightest tolerance."""
    result = METHODS["series"].solve(short_problem(scene, diameters), REFERENCE_TOL)
    return Answer(result.times.astype(np.longdouble), result.kinds, result.final, error=REFERENCE_TOL)


def observed_step_limit(diameters: int) -> float:
    """Largest step (s) at which RK4 ends a second of stick-slip without its energy running away, by bisection.

    Compare with 2 sqrt(2)/omega_max.
    """
    problem, method = short_problem("stick_slip", diameters), FixedStep()
    answer = engine_answer("stick_slip", diameters)
    theory = STABILITY_LIMIT / float(Physics(problem.parameters).omega.max())
    low, high = 0.7 * theory, 1.5 * theory
    while high / low > 1.0 + RESOLUTION:
        middle = math.sqrt(low * high)
        unstable = errors(problem, answer, method.solve(problem, middle)).verdict is Verdict.UNSTABLE
        low, high = (low, middle) if unstable else (middle, high)
    return low


__all__ = ["SPANS", "TRUNCATIONS", "engine_answer", "failure_map", "observed_step_limit"]
