"""The verdict of an answer over tolerance (or step) and number of modes.

The answer is the time of the first separation at N = 600 N, Omega = 27 rad/s, where contact is lost within `HORIZON` s.
Right is what the engine finds at its tightest tolerance with the same modes; that it finds none can be right as well.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import xarray as xr

from disc_model.benchmarks.answers import simulated
from disc_model.benchmarks.answers.questions import STATUS_WORDS, VERDICT_WORDS, Found, Status, verdict
from disc_model.benchmarks.failure_maps import map_of
from disc_model.benchmarks.machine import one_core
from disc_model.benchmarks.methods import METHODS
from disc_model.data.variables import Variable
from disc_model.parameters import Parameters
from disc_model.truncation import real_modes

CASE = Parameters(N=600.0, Omega=27.0)
HORIZON = 25.0
"""s"""
DIAMETERS = (1, 2, 4, 8)
BUDGET = 3.0
"""s for a point; finer settings with the same modes are then not tried."""
VALUES = 6
"""Settings at most."""
REFERENCE_TOL = 1e-14
VARIABLES = {
    "verdict": Variable("1", "whether the first separation is right", VERDICT_WORDS),
    "status": Variable("1", "what became of the question", STATUS_WORDS),
    "found": Variable("s", "first separation found"),
    "error": Variable("s", "its error"),
    "seconds": Variable("s", "wall time"),
}


@one_core()
def answer_map(
    method: str,
    diameters: Sequence[int] = DIAMETERS,
    values: Sequence[float] | None = None,
) -> xr.Dataset:
    """Verdicts of a method along (diameters, value), from coarse to fine.

    Returns
    -------
    Dataset: the variables of `VARIABLES` along (diameters, value); along diameters ``modes`` (real modes) and ``right``
    (s, nan where contact is not lost).
    """
    own = METHODS[method].economical()
    right = {count: _right(count) for count in diameters}
    late: set[int] = set()

    def measure(count: int, value: float) -> dict[str, float]:
        found = Found(math.nan, math.nan, Status.TOO_SLOW)
        if count not in late:
            found = _first_separation(simulated.by(own, value), BUDGET, count)
        if found.status is Status.TOO_SLOW:
            late.add(count)
        return {
            "verdict": verdict("first_separation", found, right[count]),
            "status": found.status,
            "found": found.value,
            "error": abs(found.value - right[count]),
            "seconds": found.seconds,
        }

    dataset = map_of(method, diameters, _thinned(own.map_values) if values is None else values, VARIABLES, measure)
    dataset.attrs |= {"budget": BUDGET, "horizon": HORIZON, "parameters": CASE.canonical_json}
    modes = [real_modes(count, 0) for count in diameters]
    dataset["modes"] = ("diameters", modes, Variable("1", "number of real modes").attributes)
    dataset["right"] = ("diameters", [*right.values()], Variable("s", "first separation").attributes)
    return dataset


def _thinned(values: Sequence[float]) -> Sequence[float]:
    """So many at most, the first and the last among them."""
    places = np.unique(np.linspace(0, len(values) - 1, min(VALUES, len(values))).round().astype(int))
    return [values[place] for place in places]


@lru_cache(maxsize=64)
def _right(diameters: int) -> float:
    """Time (s), nan if there is none."""
    return _first_separation(simulated.by(METHODS["series"], REFERENCE_TOL), math.inf, diameters).value


def _first_separation(solve: simulated.Solve, budget: float, diameters: int) -> Found:
    case = CASE.replace(n_diameters=diameters)
    return simulated.first_separation(solve, budget, case, HORIZON)["first_separation"]
