"""Which of the varied parameters the measurements determine: the Jacobian, and chi squared around its minimum."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from disc_model.arrays import Array, Mask
from disc_model.errors import Fault, ParameterError
from disc_model.fitting.combinations import combinations_of
from disc_model.fitting.problem import Problem
from disc_model.fitting.result import is_unlikely

SINGULAR = 1e-7
"""Least ratio of singular values of a Jacobian with columns of length 1; below it, differences no
longer tell parameters apart."""
ROUNDING = 1e-12
"""Effect of a parameter over that of the one with the largest, up to which it has none."""
PARABOLA = (0.3, 3.0)
"""Increase of chi squared over a standard deviation of the least known combination of parameters,
which is 1 where predictions are linear; below the first, intervals would mislead."""
FARTHER = (2.0, 4.0)
"""Standard deviations away at which chi squared must still rise where it does not rise as a parabola: it
may fall again beyond a peak."""
WEAK = 0.3
"""Part of a parameter in that combination from which it belongs to it, of 1 in all."""
TANGLED = 30.0
"""Standard deviation of a parameter over that which it had if the others were known, from which its
effects are those of others."""
LOOSE = 0.1
"""Standard deviation of a parameter over its size from which such a parameter counts as not
determined."""


class Sensitivity(NamedTuple):
    """What a Jacobian of weighted deviations over scaled parameters says of these.

    directions, sizes : right singular vectors in rows, (n, n), and singular values, (n,), both by descending value
    singular : whether differences no longer tell parameters apart, whatever their scales; small singular values are
        then raised, so that covariances are finite
    weakest : absolute parts of parameters in the combination that has the least effect for its parts' effects, (n,)
    inverse : whose product with its transpose is the covariance of the scaled parameters, (n, n)
    """

    directions: Array
    sizes: Array
    singular: bool
    weakest: Array
    inverse: Array


def sensitivity_of(jacobian: Array) -> Sensitivity:
    """Return what a Jacobian says."""
    effects = np.linalg.norm(jacobian, axis=0)
    without = effects <= ROUNDING * effects.max()
    comparable = np.where(without, 0.0, jacobian) / np.where(without, 1.0, effects)
    _, shares, combinations = np.linalg.svd(comparable, full_matrices=False)
    singular = bool(shares[-1] <= SINGULAR * shares[0])

    _, sizes, directions = np.linalg.svd(jacobian, full_matrices=False)
    if singular:
        sizes = np.maximum(sizes, SINGULAR * sizes[0] or 1.0)
    weakest = np.abs(combinations[-1])
    return Sensitivity(directions, sizes, singular, weakest, directions.T / sizes)


def indistinct_names(
    problem: Problem, search: Any, first: Array, deviations: Callable[[Array], Array]
) -> tuple[str, ...]:
    """Return the names of parameters that the measurements do not determine.

    Parameters
    ----------
    problem : whose parameters these are
    search : at its end, over scaled parameters
    first : Jacobian at the start. Where predictions have kinks or peaks, as at a limit of a parameter, it says more on
        what acts alike than that of the end
    deviations : over the scaled parameters

    Raises
    ------
    ParameterError
        If the Jacobian is singular at both ends of the search.
    """
    names = problem.names
    at_start = sensitivity_of(first)
    at_end = sensitivity_of(search.jac)
    if at_start.singular and at_end.singular:
        weak = _chosen(names, at_end.weakest > WEAK)
        spread = at_end.inverse * problem.scale[:, None]
        known = combinations_of(names, weak, search.x * problem.scale, spread)
        only = f", only {' and '.join(known)}" if known else ""
        rule = f"cannot be determined by these measurements{only}: fewer parameters, or others"
        raise ParameterError(Fault.of(("vary",), list(weak), rule))

    extent = _extent(search)
    alike = _alike(search.jac, at_end, extent)
    if alike.any():
        return _chosen(names, alike)
    if at_end.singular:
        return _chosen(names, at_end.weakest > WEAK)

    # what is known least at the start, where derivatives at the end hold for very short steps only
    direction = at_start.directions[-1]
    step = LOOSE * direction / np.max(np.abs(direction) / extent)
    if _is_flat(search, step, deviations):
        return _chosen(names, np.abs(direction) > WEAK)

    # what is known least at the end
    direction = at_end.directions[-1]
    if _rises(problem, search, direction / at_end.sizes[-1], deviations):
        return ()
    return _chosen(names, np.abs(direction) > WEAK)


def names_alike(names: Sequence[str], search: Any, first: Array) -> tuple[str, ...]:
    """Return the names of parameters that act alike by the Jacobian at the start of a search, or else by
    that at its end, where the measured quantities may be about to end."""
    for jacobian in (first, search.jac):
        alike = _alike(jacobian, sensitivity_of(jacobian), _extent(search))
        if alike.any():
            return _chosen(names, alike)
    return ()


def _extent(search: Any) -> Array:
    """Return the sizes of the scaled parameters at an end, (n,), smaller by the factor by which deviations
    exceed the uncertainties."""
    freedom = max(len(search.fun) - len(search.x), 1)
    scatter = math.sqrt(max(2 * search.cost / freedom, 1.0))
    return np.asarray(np.maximum(np.abs(search.x), 1.0) / scatter)


def _alike(jacobian: Array, sensitivity: Sensitivity, extent: Array) -> Mask:
    """Return which parameters act alike at the end, (n,), if one of them is known badly.

    Parameters
    ----------
    jacobian, sensitivity : of weighted deviations over scaled parameters, and what it says
    extent : sizes of the scaled parameters, (n,), smaller by the factor by which deviations exceed the uncertainties
    """
    deviation = np.linalg.norm(sensitivity.inverse, axis=1)
    others_known = 1 / np.maximum(np.linalg.norm(jacobian, axis=0), np.finfo(float).tiny)
    tangled = deviation > TANGLED * others_known
    loose = deviation > LOOSE * extent
    return np.asarray(tangled & bool((tangled & loose).any()))


def _chosen(names: Sequence[str], mask: Mask) -> tuple[str, ...]:
    """Return the names where a mask holds."""
    return tuple(name for name, chosen in zip(names, mask, strict=True) if chosen)


def _is_flat(search: Any, step: Array, deviations: Callable[[Array], Array]) -> bool:
    """Whether chi squared rises by no more than over a standard deviation on one side of the end,
    although derivatives there have it rise more."""
    expected = float(np.sum((search.jac @ step) ** 2))
    flat = min(PARABOLA[1], PARABOLA[0] * expected)
    return any(_rise(search, side * step, deviations) <= flat for side in (1, -1))


def _rises(
    problem: Problem, search: Any, step: Array, deviations: Callable[[Array], Array]
) -> bool:
    """Whether chi squared rises by about 1 over a standard deviation of the least known combination
    of parameters on both sides of a minimum, or on the one where the measured quantities exist, or
    faster, and then as far as some deviations away; at a limit of a parameter that is not asked.

    Where deviations are larger than the uncertainties explain, derivatives say less of how chi squared
    rises, and it may also rise more slowly.
    """
    if np.any(search.active_mask):
        return True
    there = [side for side in (1, -1) if not _is_gone(problem, search.x + side * step)]
    if not there:
        return False
    misses = is_unlikely(float(search.fun @ search.fun), len(search.fun) - len(search.x))
    risen = [_rise(search, side * step, deviations) for side in there]
    is_slow = min(risen) < PARABOLA[0]
    if np.isnan(risen).any() or (is_slow and not misses):
        return False
    if not is_slow and max(risen) <= PARABOLA[1]:
        return True
    for factor in FARTHER:
        expected = 1.0 if misses else factor**2
        farther = [_rise(search, side * factor * step, deviations) for side in there]
        if not np.nanmin([*farther, np.inf]) >= PARABOLA[0] * expected:
            return False
    return True


def _rise(search: Any, step: Array, deviations: Callable[[Array], Array]) -> float:
    """Return the rise of chi squared over a step from the end of a search; nan where measured
    quantities do not exist."""
    moved = deviations(search.x + step)
    return float(moved @ moved - search.fun @ search.fun)


def _is_gone(problem: Problem, x: Array) -> bool:
    """Whether the measured quantities are missing at scaled values of the parameters."""
    return problem.is_missing(x * problem.scale)
