"""Fixed points of the return map, by Newton's method."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.stability.return_map import RETURNED, Flight, ReturnMap

Array = NDArray[np.float64]


class FixedPoint(NamedTuple):
    """A point that the map takes to itself: what happens on the way, the map's Jacobian, and the distance left."""

    x: Array
    flight: Flight
    jacobian: Array
    residual: float


COARSE_TRIES = 3
"""So many first Jacobians are coarse: they only have to point the right way."""
GOOD_STEP = 0.05
"""A step that leaves less than this share of the residual spares the next one its own Jacobian."""


def rounding(tol: float, factor: float) -> float:
    """Relative residual that may be left where it falls no further; a rough `tol` is no excuse for more than 1e-8."""
    return max(tol, min(factor * tol, 1e-8))


def newton(
    map_: ReturnMap,
    x: Array,
    *,
    tol: float = 1e-12,
    releases: int = 1,
    jacobians: int = 14,
    may_separate: bool = False,
) -> FixedPoint | None:
    """Fixed point of the map, by Newton's method with a line search and reused Jacobians; None if it finds none.

    Found means that the residual is below `tol` times the norm of the static deflection, or that rounding, of up to
    ten thousand times that but not above 1e-8, keeps it from falling further.  The Jacobian is that of the point
    returned.
    """
    size = max(float(np.linalg.norm(map_.static)), 1e-300)
    identity = np.eye(map_.size)
    flight, end, jacobian, _ = map_.evaluate(x, releases=releases, may_separate=may_separate, coarse=True)
    used, fresh = 1, True
    if flight.outcome != RETURNED:
        return None
    residual = float(np.linalg.norm(end - x))
    while True:
        if not math.isfinite(residual):
            return None
        if residual <= tol * size:
            break
        step = _solve(jacobian - identity, end - x)
        accepted = False
        for shrink in range(7 if fresh else 1):
            new = x - step * 0.5**shrink
            trial, new_end, _, _ = map_.evaluate(new, releases=releases, tangent=False, may_separate=may_separate)
            new_residual = float(np.linalg.norm(new_end - new))
            if trial.outcome == RETURNED and new_residual < residual * (1 - 0.2 * 0.5**shrink):
                accepted = True
                break
        if not accepted:
            if fresh:
                if residual <= rounding(tol, 1e3) * size:
                    break
                return None
            ratio = 1.0
        else:
            ratio = new_residual / residual
            x, end, residual, flight, fresh = new, new_end, new_residual, trial, False
        if residual > tol * size and ratio > GOOD_STEP:
            if used >= jacobians:
                return None
            coarse = used < COARSE_TRIES
            flight, _, jacobian, _ = map_.evaluate(x, releases=releases, may_separate=may_separate, coarse=coarse)
            if flight.outcome != RETURNED:
                return None
            used, fresh = used + 1, True
    flight, end, jacobian, _ = map_.evaluate(x, releases=releases, may_separate=may_separate)
    residual = float(np.linalg.norm(end - x))
    converged = flight.outcome == RETURNED and residual <= rounding(tol, 1e4) * size and np.all(np.isfinite(jacobian))
    return FixedPoint(x, flight, jacobian, residual) if converged else None


def _solve(matrix: Array, right: Array) -> Array:
    """Newton's step; the shortest one if the matrix is singular."""
    try:
        return np.asarray(np.linalg.solve(matrix, right), dtype=float)
    except np.linalg.LinAlgError:
        return np.asarray(np.linalg.lstsq(matrix, right, rcond=None)[0], dtype=float)
