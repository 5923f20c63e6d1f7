"""Maps of where methods fail, over step or tolerance and number of modes, against the engine at `REFERENCE_TOL`."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
import xarray as xr

from disc_model.benchmarks import answers, scenes
from disc_model.benchmarks.answers import AnswerStatus, AnswerVerdict, Reply, Solve, setting_of
from disc_model.benchmarks.methods import METHODS, Method
from disc_model.benchmarks.methods.base import STABILITY_LIMIT, Problem
from disc_model.benchmarks.scenes import Answer, Verdict
from disc_model.benchmarks.study import Flags, Row, run
from disc_model.disc.plate import mode_arrays
from disc_model.mode_choice import real_modes
from disc_model.parameters import Parameters

SPANS: Mapping[str, float] = {"stick_slip": 1.0, "separating": 0.1}  # s
STEPS = tuple(np.geomspace(2e-5, 2e-3, 61)[::-1].tolist())  # fixed steps of a map, s
REFERENCE_TOL = 1e-14
CASE = Parameters(N=600.0, Omega=27.0)  # case of the answer maps, which loses contact within `HORIZON`
HORIZON = 25.0  # s
Settings = Sequence[float] | None  # those of the method if not given
BUDGET = 3.0  # budget for a point of an answer map, s; beyond it, finer settings with the same modes are skipped


def failure_map(
    method: str, scene: str = "separating", diameters: Sequence[int] = (1, 2, 4, 6, 8), values: Settings = None
) -> xr.Dataset:
    """Verdicts on a method on a short span of a scene along (diameters, value), and facts that explain them."""
    judged = METHODS[method].economical()

    def measure(diameters: int, value: float) -> Iterator[Row]:
        problem = short_problem(scene, diameters)
        result = judged.solve(problem, value, judged.map_budget)
        errors = scenes.errors(problem, engine_answer(scene, diameters), result)
        yield {"verdict": errors.verdict, "event_error": errors.event_time, "longest_step": result.longest_step}

    def facts(diameters: int) -> Iterator[Row]:
        p = short_problem(scene, diameters).parameters
        top = float(mode_arrays(p).omega.max())
        gaps = np.diff(engine_answer(scene, diameters).times.astype(float))  # which a step must not exceed
        shortest, stiff = float(gaps[gaps > 0].min()), p.mu_s * p.N / (p.m * p.r_0 * top)
        limits = {"step_limit": STABILITY_LIMIT / top, "shortest_phase": shortest, "stiff_epsilon": stiff}
        yield {"modes": real_modes(diameters, 0), "omega_max": top} | limits

    axes = {"diameters": diameters, "value": _settings(judged) if values is None else values}
    about: dict[str, Any] = {"scene": scene, "budget": judged.map_budget, "span": SPANS[scene]}
    study = run("failure_map", axes, measure, flags={"verdict": Verdict}, **about)
    return _with_facts(judged, study, facts, "failure_map_facts")


def answer_map(method: str, diameters: Sequence[int] = (1, 2, 4, 8), values: Settings = None) -> xr.Dataset:
    """Verdicts on a method's first separation along (diameters, value), from coarse to fine."""
    judged = METHODS[method].economical()
    reference = setting_of(METHODS["series"], REFERENCE_TOL)
    right = {count: _separation(reference, math.inf, count).value for count in diameters}
    late: set[int] = set()

    def measure(diameters: int, value: float) -> Iterator[Row]:
        reply = Reply(math.nan, math.nan, AnswerStatus.TOO_SLOW)
        if diameters not in late:
            reply = _separation(setting_of(judged, value), BUDGET, diameters)
        if reply.status is AnswerStatus.TOO_SLOW:
            late.add(diameters)
        verdict = answers.verdict("first_separation", reply, right[diameters])
        errors = {"verdict": verdict, "error": abs(reply.value - right[diameters])}
        yield errors | {"status": reply.status, "found": reply.value, "seconds": reply.seconds}

    def facts(diameters: int) -> Iterator[Row]:
        yield {"modes": real_modes(diameters, 0), "right": right[diameters]}

    if values is None:  # six at most: the first, the last, and some between
        every = _settings(judged)
        values = [every[i] for i in np.linspace(0, len(every) - 1, min(6, len(every))).round().astype(int)]
    flags: Flags = {"verdict": AnswerVerdict, "status": AnswerStatus}
    about: dict[str, Any] = {"budget": BUDGET, "horizon": HORIZON, "parameters": CASE.canonical_json}
    study = run("answer_map", {"diameters": diameters, "value": values}, measure, flags=flags, **about)
    return _with_facts(judged, study, facts, "answer_map_facts")


def _settings(method: Method) -> Sequence[float]:
    return STEPS if method.setting == "step" else method.map_values


def _with_facts(method: Method, study: xr.Dataset, facts: Callable[..., Iterator[Row]], table: str) -> xr.Dataset:
    """The map of a method with the facts of each row, and what its axes are."""
    study = study.assign(run(table, {"diameters": study["diameters"].values.tolist()}, facts).data_vars)
    study["diameters"].attrs = {"units": "1", "long_name": "highest nodal diameter"}
    study["value"].attrs = {"long_name": f"setting: {method.setting}"}
    return study.assign_attrs(method=method.name, label=method.label, setting=method.setting)


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


def _separation(solve: Solve, budget: float, diameters: int) -> Reply:
    return answers.first_separation(solve, budget, CASE.replace(n_diameters=diameters), HORIZON)["first_separation"]
