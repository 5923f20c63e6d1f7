"""What the search of a fit has come to, and the fit that follows from it."""

import math
from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from disc_model.arrays import Array
from disc_model.fitting.arguments import Interval
from disc_model.fitting.limits import bounds_within
from disc_model.fitting.problem import Problem
from disc_model.fitting.result import STILL_FALLING, Combined, Fit, Fitted, Gap
from disc_model.fitting.search import Search

STOPPED = "The steps became too short in front of a gap."
"""Message of a search that has stopped where a measured quantity does not exist."""


class Outcome(NamedTuple):
    """The end of a search over scaled parameters, the limits within which they were, the gap in front
    of which it has stopped, whether it is at a minimum, the parameters that are not determined, and
    combinations of these that are, and the least chi squared, which may be below that at the end."""

    end: Any
    limits: Mapping[str, Interval]
    gap: Gap | None
    is_minimum: bool
    indistinct: tuple[str, ...] = ()
    determined: Mapping[str, Combined] = MappingProxyType({})
    least: float = math.inf


class Intervals(NamedTuple):
    """Lower and upper ends of the intervals of parameters, (n,), nan where they are not known; and of
    each parameter that has some, the ends at which a measured quantity does not exist, and those at
    which there is no case."""

    low: Array
    high: Array
    unpredicted: dict[str, tuple[float, ...]]
    outside: dict[str, tuple[float, ...]]


def fit_of(search: Search, outcome: Outcome, confidence: float) -> Fit:
    """Return the fit at the end of a search."""
    from scipy import stats

    end, limits, gap, is_minimum, indistinct, determined, least = outcome
    chi_squared = float(end.fun @ end.fun)
    problem = search.problem
    names = problem.names
    covariance = search.covariance(end)

    fitted = end.x * problem.scale
    deviation = np.sqrt(np.diag(covariance))
    reach = float(stats.norm.ppf((1 + confidence) / 2)) * deviation
    at_bounds, passed, reached = bounds_within(problem, fitted, deviation, reach, limits)
    if at_bounds:  # what holds one of them moves the others
        indistinct = ()
        determined = {}
    passed = {name: bounds for name, bounds in passed.items() if name not in indistinct}
    unknown = {*indistinct, *at_bounds}
    changes = search.changes(end, indistinct)
    intervals = _intervals_of(problem, fitted, reach, changes, unknown, passed)
    deviation[[name in unknown for name in names]] = np.nan
    rows = np.stack([fitted, deviation, intervals.low, intervals.high], axis=1).tolist()
    parameters = {name: Fitted(*row) for name, row in zip(names, rows, strict=True)}
    case = problem.case.replace(**{name: each.value for name, each in parameters.items()})
    computed = problem.predictions(fitted)
    unstable = problem.unstable(fitted)
    return Fit(
        case=case,
        parameters=parameters,
        covariance=covariance,
        confidence=confidence,
        measurements=problem.measurements,
        computed=computed,
        deviations=np.asarray(end.fun),
        chi_squared=chi_squared,
        excess=max(0.0, chi_squared - least),
        converged=bool(end.success) and is_minimum,
        message=_why_ended(outcome),
        indistinct=indistinct,
        determined=determined,
        unpredicted=intervals.unpredicted,
        outside=intervals.outside,
        at_bounds=at_bounds,
        reached=reached,
        passed_bounds=passed,
        gap=gap,
        unstable=unstable,
        elsewhere=problem.elsewhere(fitted, unstable),
        _changes=changes,
    )


def _intervals_of(
    problem: Problem,
    fitted: Array,
    reach: Array,
    changes: Array,
    unknown: Collection[str],
    passed: Mapping[str, Sequence[float]],
) -> Intervals:
    """Return the intervals of the parameters.

    reach : from a value to the ends of its interval, (n,)
    changes : of all parameters along the interval of each, in columns, (n, n)
    unknown : parameters without an interval
    passed : bounds beyond which an interval would go, by its parameter
    """
    ends = Intervals(fitted - reach, fitted + reach, {}, {})
    for i, name in enumerate(problem.names):
        if name in unknown:
            ends.low[i] = np.nan
            ends.high[i] = np.nan
            continue
        for bound in passed.get(name, ()):
            beyond = ends.low if bound < fitted[i] else ends.high
            beyond[i] = np.nan
        move = reach[i] * changes[:, i]
        own = [float(ends.low[i]), float(ends.high[i])]
        gone, beyond_cases = _lost_ends(problem, fitted, move, own)
        if gone:
            ends.unpredicted[name] = gone
        if beyond_cases:
            ends.outside[name] = beyond_cases
        for end in (ends.low, ends.high):
            if end[i] in (*gone, *beyond_cases):
                end[i] = np.nan
    return ends


def _lost_ends(
    problem: Problem, fitted: Array, move: Array, ends: Sequence[float]
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return those of the known ends of an interval, below and above, at which a measured quantity does
    not exist, and those at which there is no case.

    fitted, move : values of all parameters, and their way to the upper end, each (n,)
    """
    gone = []
    beyond_cases = []
    for end, way in zip(ends, (-move, move), strict=True):
        if math.isnan(end):
            continue
        lacking = problem.lacking(fitted + way)
        if lacking == "quantity":
            gone.append(end)
        elif lacking == "case":
            beyond_cases.append(end)
    return tuple(gone), tuple(beyond_cases)


def _why_ended(outcome: Outcome) -> str:
    """Return why a search has ended, in words."""
    if outcome.gap:
        return STOPPED
    if not outcome.is_minimum:
        return STILL_FALLING
    return str(outcome.end.message).strip("`. ").replace("`", "") + "."
