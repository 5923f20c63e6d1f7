"""Limits of a parameter on one side, where a bound that no case can pass is within its interval on the other.

Chi squared rises from its least value within the bound by ``slope * d + d**2 / variance`` over a distance d from the
bound, if predictions are linear and the other parameters follow. The limit is where it has risen by z^2, z being the
quantile of the confidence. It lies beyond the true value in at least this share of measurements, and in more if the
true value is near the bound."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from disc_model.arrays import Array
from disc_model.fitting.arguments import Interval
from disc_model.fitting.determination import sensitivity_of
from disc_model.fitting.problem import STEP, Problem
from disc_model.fitting.result import Fit

AT_BOUND = 1e-3
"""Distance from a bound at which a parameter lies there, over its standard deviation, or over its
scale if that is less."""
FARTHEST = 1e3
"""Longest way on which a value beyond which there is no case is looked for, over a parameter's scale."""
NOT_LINEAR = "up to it chi squared does not rise as linear predictions would have it"
"""Why a parameter has no limit."""
RISE = (0.8, 3.0)
"""Rise of chi squared up to a limit over that of linear predictions; beyond these no limit is given."""


def limits_of_cases(
    problem: Problem, search: Any, limits: Mapping[str, Interval]
) -> dict[str, Interval]:
    """Return limits for parameters that a search has led to the last value of any case, such as 0 of
    one that cannot be negative: against the rules of cases it does not converge."""
    found = {}
    for name in problem.names:
        interval = _interval_of_cases(problem, search, name, STEP, limits)
        if interval:
            found[name] = interval
    return found


def limits_of_interval(
    problem: Problem, search: Any, name: str, confidence: float, limits: Mapping[str, Interval]
) -> dict[str, Interval]:
    """Return limits of a parameter by its name if its confidence interval passes the last value of any
    case; none if it does not."""
    from scipy import stats

    i = problem.names.index(name)
    deviation = float(np.linalg.norm(sensitivity_of(search.jac).inverse[i]))
    reach = float(stats.norm.ppf((1 + confidence) / 2)) * deviation
    interval = _interval_of_cases(problem, search, name, min(reach, FARTHEST), limits)
    return {name: interval} if interval else {}


def _interval_of_cases(
    problem: Problem, search: Any, name: str, reach: float, limits: Mapping[str, Interval]
) -> Interval | None:
    """Return the given limits of a parameter, or closer ones beyond which there is no case; None if no
    such ones are within a reach, over the parameter's scale."""
    i = problem.names.index(name)
    values = search.x * problem.scale
    low, high = limits.get(name, (-math.inf, math.inf))
    size = reach * float(problem.scale[i])
    least = problem.last_value(values, i, max(-size, low - values[i]))
    greatest = problem.last_value(values, i, min(size, high - values[i]))
    if math.isnan(least) and math.isnan(greatest):
        return None
    return float(np.fmax(low, least)), float(np.fmin(high, greatest))


def bounds_within(
    problem: Problem, fitted: Array, deviation: Array, reach: Array, limits: Mapping[str, Interval]
) -> tuple[dict[str, float], dict[str, tuple[float, ...]], tuple[str, ...]]:
    """Return by name the bounds at which parameters lie, or which no case can pass but an interval
    would; all other bounds that intervals pass; and the names of parameters that lie at their bound.

    Parameters
    ----------
    fitted, deviation, reach : values, standard deviations, and half the widths of intervals, each (n,)
    limits : the bounds of each parameter, by name
    """
    held: dict[str, float] = {}
    passed: dict[str, tuple[float, ...]] = {}
    reached: list[str] = []
    for i, name in enumerate(problem.names):
        near = AT_BOUND * min(float(deviation[i]), float(problem.scale[i]))
        for bound in _farthest_first(limits.get(name, ()), float(fitted[i])):
            distance = abs(float(fitted[i]) - bound)
            side = 1 if fitted[i] >= bound else -1
            if distance > reach[i]:
                continue
            if distance <= near or problem.is_last(fitted, i, bound, side):
                held[name] = bound
                reached += [name] if distance <= near else []
            else:
                passed[name] = (*passed.get(name, ()), bound)
    others = {name: bounds for name, bounds in passed.items() if name not in held}
    return held, others, tuple(dict.fromkeys(reached))


def _farthest_first(bounds: Sequence[float], value: float) -> list[float]:
    """Return bounds in the order of their distance from a value: the last one, the nearest, holds it."""
    return sorted(map(float, bounds), key=lambda bound: -abs(bound - value))


def with_limits(
    found: Fit, problem: Problem, search: Any, deviations: Callable[[Array], Array]
) -> Fit:
    """Return the fit with the limits of parameters at bounds that no case can pass."""
    limits = {}
    unlimited = {}
    for name, bound in found.at_bounds.items():
        i = problem.names.index(name)
        side = 1 if found.parameters[name].value >= bound else -1
        values = search.x * problem.scale
        if not problem.is_last(values, i, bound, side):
            continue
        limits[name] = math.nan
        reason = _why_unlimited(found)
        if not reason:
            covariance = found.covariance / np.outer(problem.scale, problem.scale)
            beyond = _limit_beyond(search, covariance, i, side, found.confidence, deviations)
            limits[name] = beyond * float(problem.scale[i])
            reason = NOT_LINEAR if math.isnan(beyond) else ""
        if reason:
            unlimited[name] = reason
    return replace(found, limits=limits, unlimited=unlimited)


def _why_unlimited(found: Fit) -> str:
    """Return why no parameter has a limit, in words; "" where one may have."""
    if not found.converged:
        return "the search has not converged"
    if found.misses:
        return "chi squared is too large"
    if len(found.at_bounds) > 1:
        return "other parameters are at bounds too"
    return ""


def _limit_beyond(
    search: Any,
    covariance: Array,
    i: int,
    side: int,
    confidence: float,
    deviations: Callable[[Array], Array],
) -> float:
    """The limit of a scaled parameter; nan if predictions are not linear, or missing, up to it.

    Parameters
    ----------
    search : at its end, over scaled parameters
    covariance : of these
    i : number of the parameter
    side : 1 for an upper limit, -1 for a lower one
    confidence : share of measurements in which the limit lies beyond the true value
    deviations : over the scaled parameters
    """
    from scipy import stats

    rise = float(stats.norm.ppf(confidence)) ** 2
    variance = float(covariance[i, i])
    slope = max(side * 2 * float(search.jac[:, i] @ search.fun), 0.0)
    root = math.sqrt(slope**2 + 4 * rise / variance)
    distance = 0.5 * variance * (root - slope)
    moved = deviations(search.x + side * distance * covariance[:, i] / variance)
    risen = float(moved @ moved) - float(search.fun @ search.fun)
    if not RISE[0] * rise <= risen <= RISE[1] * rise:
        return math.nan
    return float(search.x[i] + side * distance)
