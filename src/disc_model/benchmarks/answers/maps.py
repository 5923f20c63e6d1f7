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
from disc_model.benchmarks.methods.base import MethodResult, Problem
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
    values = _thinned(own.map_values) if values is None else values
    shape = (len(diameters), len(values))
    data: dict[str, np.ndarray] = {name: np.full(shape, math.nan) for name in VARIABLES}
    right = [_right(count) for count in diameters]
    for row, count in enumerate(diameters):
        case, late = CASE.replace(n_diameters=count), False
        for column, value in enumerate(values):

            def solve(problem: Problem, seconds: float, value: float = value) -> MethodResult:
                return own.solve(problem, value, seconds)

            found = Found(math.nan, math.nan, Status.TOO_SLOW)
            if not late:
                found = simulated.first_separation(solve, BUDGET, case, HORIZON)["first_separation"]
            late = found.status is Status.TOO_SLOW
            said = verdict("first_separation", found, right[row])
            error = abs(found.value - right[row])
            for name, number in zip(VARIABLES, (said, found.status, found.value, error, found.seconds), strict=True):
                data[name][row, column] = number
    flags = {name: data[name].astype(np.int8) if about.flags else data[name] for name, about in VARIABLES.items()}
    dataset = map_of(method, diameters, values, {name: (flags[name], about) for name, about in VARIABLES.items()})
    dataset.attrs |= {"budget": BUDGET, "horizon": HORIZON, "parameters": CASE.canonical_json}
    modes = [real_modes(count, 0) for count in diameters]
    dataset["modes"] = ("diameters", modes, Variable("1", "number of real modes").attributes)
    dataset["right"] = ("diameters", right, Variable("s", "first separation").attributes)
    return dataset


def _thinned(values: Sequence[float]) -> Sequence[float]:
    """So many at most, the first and the last among them."""
    places = np.unique(np.linspace(0, len(values) - 1, min(VALUES, len(values))).round().astype(int))
    return [values[place] for place in places]


@lru_cache(maxsize=64)
def _right(diameters: int) -> float:
    """Time (s), nan if there is none."""

    def solve(problem: Problem, seconds: float) -> MethodResult:
        return METHODS["series"].solve(problem, REFERENCE_TOL, seconds)

    return simulated.first_separation(solve, math.inf, CASE.replace(n_diameters=diameters), HORIZON)[
        "first_separation"
    ].value
