"""Where methods find the first separation: maps over their setting and the number of modes."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from benchmarks import failure_maps, replies, study
from benchmarks.methods import METHODS, Method
from benchmarks.questions import FLAGS, AnswerStatus, Reply, verdict
from benchmarks.study import Row
from disc_model.mode_choice import real_modes
from disc_model.parameters import Parameters

MAP_CASE = Parameters(N=600.0, Omega=27.0)
"""A case that loses contact within the horizon."""
MAP_HORIZON = 25.0
"""Simulated time, s."""
MAP_BUDGET = 3.0
"""Time for a point, s, beyond which finer settings with the same modes are skipped."""
MAP_VALUES = 6
"""Greatest number of settings of a map."""


def answer_map(
    method: str, diameters: Sequence[int] = (1, 2, 4, 8), values: Sequence[float] | None = None
) -> xr.Dataset:
    """Judge a method's first separation along (diameters, value).

    Parameters
    ----------
    method : its name
    diameters : highest numbers of nodal diameters
    values : settings from coarse to fine; some of `failure_maps.map_settings` if None
    """
    judged = METHODS[method].economical()
    if values is None:
        values = _some_of(failure_maps.map_settings(judged))
    series = METHODS["series"]
    right = {
        count: _map_reply(series, failure_maps.REFERENCE_TOL, math.inf, count).value
        for count in diameters
    }
    late: set[int] = set()

    def measure(diameters: int, value: float) -> Iterator[Row]:
        reply = Reply(math.nan, math.nan, AnswerStatus.TOO_SLOW)
        if diameters not in late:
            reply = _map_reply(judged, value, MAP_BUDGET, diameters)
        if reply.status is AnswerStatus.TOO_SLOW:
            late.add(diameters)
        yield {
            "verdict": verdict("first_separation", reply, right[diameters]),
            "error": abs(reply.value - right[diameters]),
            "status": reply.status,
            "found": reply.value,
            "seconds": reply.seconds,
        }

    def facts(diameters: int) -> Iterator[Row]:
        yield {"modes": real_modes(diameters, 0), "right": right[diameters]}

    dataset = study.run(
        "answer_map",
        {"diameters": diameters, "value": values},
        measure,
        flags=FLAGS,
        budget=MAP_BUDGET,
        horizon=MAP_HORIZON,
        parameters=MAP_CASE.canonical_json,
    )
    return failure_maps.with_facts(judged, dataset, facts, "answer_map_facts")


def _map_reply(method: Method, value: float, budget: float, diameters: int) -> Reply:
    """Return the reply of a method on the case of the maps.

    Parameters
    ----------
    method, value : the method, and its setting
    budget : seconds
    diameters : highest number of nodal diameters
    """
    p = MAP_CASE.replace(n_diameters=diameters)
    solve = replies.setting_of(method, value)
    return replies.first_separation(solve, budget, p, MAP_HORIZON)["first_separation"]


def _some_of(settings: Sequence[float]) -> list[float]:
    """Return `MAP_VALUES` settings at most: the first, the last, and some between."""
    count = min(MAP_VALUES, len(settings))
    places = np.linspace(0, len(settings) - 1, count).round().astype(int)
    return [settings[i] for i in places]
