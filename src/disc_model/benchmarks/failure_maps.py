"""Failure maps: verdict on each method over its step or tolerance and the number of modes.

The motion is that of the scene ``separating`` (or ``stick_slip``) for a short span, with modes dropped or added. The
correct answer comes from the series engine at `REFERENCE_TOL`; the stored references confirm it for the base model.
`answer_map` shows in the same way whether an answer is correct.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
import xarray as xr

from disc_model.benchmarks import scenes
from disc_model.benchmarks.answers import simulated
from disc_model.benchmarks.answers.questions import AnswerStatus, AnswerVerdict, Found, verdict
from disc_model.benchmarks.grid import measured, variables
from disc_model.benchmarks.hardware import machine, one_core
from disc_model.benchmarks.methods.base import Problem
from disc_model.benchmarks.methods.rk4 import STABILITY_LIMIT
from disc_model.benchmarks.registry import METHODS, Method
from disc_model.benchmarks.scenes import Answer, Verdict
from disc_model.data.variables import Variable
from disc_model.parameters import Parameters
from disc_model.plate import mode_arrays
from disc_model.truncation import real_modes

SPANS: Mapping[str, float] = {"stick_slip": 1.0, "separating": 0.1}
"""s"""
STEPS = tuple(np.geomspace(2e-5, 2e-3, 61)[::-1].tolist())
"""Fixed steps of a map, s."""
REFERENCE_TOL = 1e-14

VARIABLES = variables("failure_maps", verdict=Verdict)
FACTS = variables("map_facts")


@one_core()
def failure_map(
    method: str,
    scene: str = "separating",
    truncations: Sequence[int] = (1, 2, 4, 6, 8),
    values: Sequence[float] | None = None,
) -> xr.Dataset:
    """Verdicts on a method, with the facts that explain them; ``truncations`` are numbers of nodal diameters.

    Returns
    -------
    Dataset: `VARIABLES` along (diameters, value) and `FACTS` along diameters.
    """
    own = METHODS[method].economical()

    def measure(diameters: int, value: float) -> dict[str, float]:
        problem = short_problem(scene, diameters)
        result = own.solve(problem, value, own.map_budget)
        found = scenes.errors(problem, engine_answer(scene, diameters), result)
        return {"verdict": found.verdict, "event_error": found.event_time, "longest_step": result.longest_step}

    facts = {diameters: _facts(scene, diameters) for diameters in truncations}
    about = {"scene": scene, "budget": own.map_budget, "span": SPANS[scene]}
    return _map_of(own, _settings(own) if values is None else values, VARIABLES, measure, facts, about)


def _settings(own: Method) -> Sequence[float]:
    return STEPS if own.setting == "step" else own.map_values


def _map_of(
    own: Method,
    values: Sequence[float],
    variables: Mapping[str, Variable],
    measure: Callable[[int, float], Mapping[str, float]],
    facts: Mapping[int, Mapping[str, float]],
    about: Mapping[str, Any],
) -> xr.Dataset:
    """Results of ``measure`` for a method along (diameters, value), and facts for each number of diameters."""
    found = measured({"diameters": [*facts], "value": values}, variables, measure)
    for name in next(iter(facts.values())):
        found[name] = ("diameters", [fact[name] for fact in facts.values()], FACTS[name].attributes)
    found["diameters"].attrs = FACTS["diameters"].attributes
    found["value"].attrs = {"long_name": f"setting: {own.setting}"}
    return found.assign_attrs(method=own.name, label=own.label, setting=own.setting, machine=machine(), **about)


def _facts(scene: str, diameters: int) -> dict[str, float]:
    p = short_problem(scene, diameters).parameters
    top = float(mode_arrays(p).omega.max())
    return {
        "modes": float(real_modes(diameters, 0)),
        "omega_max": top,
        "step_limit": STABILITY_LIMIT / top,
        "shortest_phase": scenes.shortest_phase(engine_answer(scene, diameters)),
        "stiff_epsilon": p.mu_s * p.N / (p.m * p.r_0 * top),
    }


@lru_cache(maxsize=64)
def short_problem(scene: str, diameters: int) -> Problem:
    """The scene's motion with modes up to ``diameters`` for the span of the maps."""
    p = Parameters(N=385.0, Omega=15.1, n_diameters=diameters)
    start = scenes.MOTIONS[scene][1](p)
    return Problem(p, start, start.time + SPANS[scene])


@lru_cache(maxsize=64)
def engine_answer(scene: str, diameters: int) -> Answer:
    """The series engine's answer to `short_problem`, at the tightest tolerance."""
    result = METHODS["series"].solve(short_problem(scene, diameters), REFERENCE_TOL)
    return Answer(result.times.astype(np.longdouble), result.kinds, result.final, error=REFERENCE_TOL)


# ----------------------------------------------------------------------------------------------------
# Correctness of an answer: the first separation in a case that loses contact within `HORIZON` s. The engine at its
# tightest tolerance with the same modes is correct, also if it finds none.

CASE = Parameters(N=600.0, Omega=27.0)
HORIZON = 25.0
"""s"""
BUDGET = 3.0
"""Budget for a point, s; beyond it, finer settings with the same modes are skipped."""
ANSWER_VARIABLES = variables("answer_maps", verdict=AnswerVerdict, status=AnswerStatus)


@one_core()
def answer_map(
    method: str,
    diameters: Sequence[int] = (1, 2, 4, 8),
    values: Sequence[float] | None = None,
) -> xr.Dataset:
    """Verdicts on a method along (diameters, value), from coarse to fine.

    Returns
    -------
    Dataset: `ANSWER_VARIABLES` along (diameters, value); along diameters ``modes`` (real modes) and ``right`` (s, nan
    where contact is not lost).
    """
    own = METHODS[method].economical()
    facts = {count: {"modes": real_modes(count, 0), "right": _right(count)} for count in diameters}
    late: set[int] = set()

    def measure(count: int, value: float) -> dict[str, float]:
        if count in late:
            found = Found(math.nan, math.nan, AnswerStatus.TOO_SLOW)
        else:
            found = _first_separation(simulated.by(own, value), BUDGET, count)
        if found.status is AnswerStatus.TOO_SLOW:
            late.add(count)
        right = facts[count]["right"]
        judged = {"verdict": verdict("first_separation", found, right), "error": abs(found.value - right)}
        return judged | {"status": found.status, "found": found.value, "seconds": found.seconds}

    if values is None:  # six at most: the first, the last, and some between
        every = _settings(own)
        places = np.linspace(0, len(every) - 1, min(6, len(every))).round().astype(int)
        values = [every[place] for place in places]
    about = {"budget": BUDGET, "horizon": HORIZON, "parameters": CASE.canonical_json}
    return _map_of(own, values, ANSWER_VARIABLES, measure, facts, about)


def _right(diameters: int) -> float:
    """Correct time of the first separation (s), nan if there is none."""
    return _first_separation(simulated.by(METHODS["series"], REFERENCE_TOL), math.inf, diameters).value


def _first_separation(solve: simulated.Solve, budget: float, diameters: int) -> Found:
    case = CASE.replace(n_diameters=diameters)
    return simulated.first_separation(solve, budget, case, HORIZON)["first_separation"]
