"""Where methods fail: maps over step or tolerance and number of modes, against the engine."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from benchmarks import scenes, study
from benchmarks.methods import METHODS, Method
from benchmarks.methods.integrators import Problem
from benchmarks.methods.whole_runs import STABILITY_LIMIT
from benchmarks.scenes import Answer, Verdict
from benchmarks.study import Row
from disc_model.disc.plate import mode_arrays
from disc_model.mode_choice import real_modes
from disc_model.parameters import Parameters

SPANS: Mapping[str, float] = {"stick_slip": 1.0, "separating": 0.1}
"""Length of a map's motion by scene, s."""
STEPS: Sequence[float] = tuple(np.geomspace(2e-5, 2e-3, 61)[::-1].tolist())
"""Fixed steps of a map, s."""
REFERENCE_TOL = 1e-14
"""Tolerance of the engine by which methods are judged."""


def failure_map(
    method: str,
    scene: str = "separating",
    diameters: Sequence[int] = (1, 2, 4, 6, 8),
    values: Sequence[float] | None = None,
) -> xr.Dataset:
    """Judge a method on a short span of a scene along (diameters, value).

    Parameters
    ----------
    method : its name
    scene : name of the scene
    diameters : highest numbers of nodal diameters
    values : settings; those of `map_settings` if None

    Returns
    -------
    xarray.Dataset
        Verdicts, and facts that explain them.
    """
    judged = METHODS[method].economical()
    cases = {count: _case(scene, count) for count in diameters}

    def measure(diameters: int, value: float) -> Iterator[Row]:
        problem, right = cases[diameters]
        result = judged.solve(problem, value, judged.map_budget)
        errors = scenes.errors(problem, right, result)
        yield {
            "verdict": errors.verdict,
            "event_error": errors.event_time,
            "longest_step": result.longest_step,
        }

    def facts(diameters: int) -> Iterator[Row]:
        problem, right = cases[diameters]
        yield {"modes": real_modes(diameters, 0), **_limits(problem.parameters, right)}

    if values is None:
        values = map_settings(judged)
    dataset = study.run(
        "failure_map",
        {"diameters": diameters, "value": values},
        measure,
        flags={"verdict": Verdict},
        scene=scene,
        budget=judged.map_budget,
        span=SPANS[scene],
    )
    return with_facts(judged, dataset, facts, "failure_map_facts")


def _case(scene: str, diameters: int) -> tuple[Problem, Answer]:
    """Return a short span of a scene with a number of modes, and the engine's answer."""
    p = Parameters(N=385.0, Omega=15.1, n_diameters=diameters)
    start = scenes.MOTIONS[scene].start(p)
    problem = Problem(p, start, start.time + SPANS[scene])
    right = METHODS["series"].solve(problem, REFERENCE_TOL)
    times = right.times.astype(np.longdouble)
    return problem, Answer(times, right.kinds, right.final, REFERENCE_TOL)


def _limits(p: Parameters, right: Answer) -> dict[str, Any]:
    """Return the settings at which methods may fail on a case.

    Parameters
    ----------
    p : the case
    right : its answer, whose events a step must not skip
    """
    top = float(mode_arrays(p).omega.max())
    gaps = np.diff(right.times.astype(float))
    return {
        "omega_max": top,
        "step_limit": STABILITY_LIMIT / top,
        "shortest_phase": float(gaps[gaps > 0].min()),
        "stiff_epsilon": p.mu_s * p.N / (p.m * p.r_0 * top),
    }


def map_settings(method: Method) -> Sequence[float]:
    """Return the settings of a method in maps."""
    return STEPS if method.setting == "step" else method.map_values


def with_facts(
    method: Method, dataset: xr.Dataset, facts: Callable[..., Iterator[Row]], table: str
) -> xr.Dataset:
    """Return the map of a method with facts of each row, and what its axes are.

    Parameters
    ----------
    method : the method
    dataset : its map
    facts : yields the facts of a number of nodal diameters
    table : name of their variables
    """
    rows = {"diameters": dataset["diameters"].values.tolist()}
    dataset = dataset.assign(study.run(table, rows, facts).data_vars)
    dataset["diameters"].attrs = {"units": "1", "long_name": "highest nodal diameter"}
    dataset["value"].attrs = {"long_name": f"setting: {method.setting}"}
    return dataset.assign_attrs(method=method.name, label=method.label, setting=method.setting)
