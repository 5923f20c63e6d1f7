"""Where methods fail: maps over step or tolerance and number of modes, against the engine."""

from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
import pandas as pd

from benchmarks import scenes
from benchmarks.methods import METHODS, Method
from benchmarks.methods.integrators import Problem
from benchmarks.methods.whole_runs import STABILITY_LIMIT
from benchmarks.scenes import Answer
from disc_model.disc.plate import mode_arrays
from disc_model.parameters import Parameters

SPANS: Mapping[str, float] = {"stick_slip": 1.0, "separating": 0.1}
"""Length of a map's motion by scene, s."""
STEPS: Sequence[float] = tuple(np.geomspace(2e-5, 2e-3, 61)[::-1].tolist())
"""Fixed steps of a map, s."""
DIAMETERS = (1, 2, 4, 6, 8)
"""Highest numbers of nodal diameters of a map."""
REFERENCE_TOL = 1e-14
"""Tolerance of the engine by which methods are judged."""


def failure_map(
    method: str,
    scene: str = "separating",
    diameters: Sequence[int] = DIAMETERS,
    values: Sequence[float] | None = None,
) -> pd.DataFrame:
    """Judge a method on a short span of a scene, at settings and numbers of modes.

    Parameters
    ----------
    method : its name
    scene : name of the scene
    diameters : highest numbers of nodal diameters
    values : settings; those of `map_settings` if None

    Returns
    -------
    table : a row for each point: the verdict, and what explains it, which are the step up to which
        RK4 is stable (``step_limit``, s) and the shortest phase (s), which a step must not skip
    """
    judged = METHODS[method].economical()
    rows = []
    for count in diameters:
        problem, right = _case(scene, count)
        gaps = np.diff(right.times.astype(float))
        top = float(mode_arrays(problem.parameters).omega.max())
        of_case = {
            "method": method,
            "scene": scene,
            "modes": 2 * count + 1,
            "step_limit": STABILITY_LIMIT / top,
            "shortest_phase": float(gaps[gaps > 0].min()),
        }
        for value in values or map_settings(judged):
            result = judged.solve(problem, value, judged.map_budget)
            errors = scenes.errors(problem, right, result)
            rows.append(
                {
                    **of_case,
                    "setting": value,
                    "verdict": errors.verdict.name.lower(),
                    "event_error": errors.event_time,
                    "longest_step": result.longest_step,
                }
            )
    return pd.DataFrame(rows)


@lru_cache
def _case(scene: str, diameters: int) -> tuple[Problem, Answer]:
    """Return a short span of a scene with a number of modes, and the engine's answer."""
    p = Parameters(N=385.0, Omega=15.1, n_diameters=diameters)
    start = scenes.MOTIONS[scene].start(p)
    problem = Problem(p, start, start.time + SPANS[scene])
    right = METHODS["series"].solve(problem, REFERENCE_TOL)
    times = right.times.astype(np.longdouble)
    return problem, Answer(times, right.kinds, right.final)


def map_settings(method: Method) -> Sequence[float]:
    """Return the settings of a method in maps."""
    return STEPS if method.setting == "step" else method.map_values
