"""A cycle followed in one parameter by pseudo-arclength: folds, where two cycles meet, are points like any other."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from disc_model.parameters import Parameters
from disc_model.stability.branch import Branch, Place, Stride, branch_of, check, starting_point, walk
from disc_model.stability.cycle_problem import CyclePoint, CycleProblem, Lost

Array = NDArray[np.float64]

UNLOCATED = "a fold that cannot be located"
"""How the reason for which a branch ends may begin."""


def continue_cycle(
    p: Parameters,
    name: str,
    bounds: tuple[float, float],
    *,
    direction: int = 1,
    step: float = 0.02,
    longest: float = 0.1,
    shortest: float = 1e-7,
    max_points: int = 1000,
    scale: float | None = None,
    start: Array | None = None,
    tol: float = 1e-12,
) -> Branch:
    """Follow a cycle in one parameter by pseudo-arclength, through folds, until it leaves `bounds`.

    Parameters
    ----------
    p : case whose cycle is the first point
    name : the free parameter, one of Omega, N, D_star, c, c_p, k, k_p, E, m
    bounds : values between which to follow it
    direction : 1 to begin with rising values, -1 with falling ones
    step, longest, shortest : arclength of the first step, of the longest and of the shortest
    max_points : bound on the number of points
    scale : value of the parameter that counts as one in the arclength; its own by default
    start : point of the section to start Newton's method from; the static equilibrium by default
    tol : as in `floquet`

    Raises
    ------
    ParameterError
        Bad input, or no cycle to start from.
    """
    check(p, (name,), 1)
    problem = CycleProblem(p, (name,), None if scale is None else {name: scale}, tol)
    point = starting_point(problem, start)
    tangent = problem.tangents(point)[0]
    tangent *= direction * (1.0 if tangent[-1] >= 0 else -1.0)
    low, high = (bound / problem.scales[0] for bound in bounds)
    folds: list[float] = []

    def meet(before: Place, after: Place) -> None:
        if after.tangent[-1] * before.tangent[-1] < 0:
            try:
                folds.append(_locate_fold(problem, before.point, after.point, before.tangent) * problem.scales[0])
            except Lost as lost:
                where = before.point.z[-1] * problem.scales[0]
                raise Lost(f"{UNLOCATED} near {name}={where:.6g}: {lost}") from None

    def leaves(places: list[Place], ds: float) -> str:
        return "" if low <= places[-1].point.z[-1] <= high else f"{name} has left {bounds[0]:g} .. {bounds[1]:g}"

    stride = Stride(step, longest, shortest, growth=1.5, easy=0.99)
    places, ended = walk(Place(point, tangent), partial(_next, problem), stride, max_points, meet=meet, leaves=leaves)
    return branch_of(problem, [place.point for place in places], np.array(folds).reshape(-1, 1), ended)


def _next(problem: CycleProblem, here: Place, ds: float) -> Place:
    """The place at arclength ds along the tangent."""
    tangent = here.tangent
    new = problem.correct(here.point.z + ds * tangent, tangent[None, :], np.array([tangent @ here.point.z + ds]))
    turned = problem.tangents(new)[0]
    turned *= 1.0 if turned @ tangent > 0 else -1.0
    if turned @ tangent < 0.9:
        raise Lost("the curve bends too sharply")
    return Place(new, turned)


def _locate_fold(problem: CycleProblem, before: CyclePoint, after: CyclePoint, tangent: Array) -> float:
    """Scaled parameter at the fold between two points: its component of the curve's tangent vanishes there."""
    length = float(tangent @ (after.z - before.z))
    chord = (after.z - before.z) / length

    def slope(s: float) -> tuple[float, float]:
        guess = before.z + s * chord
        point = problem.correct(guess, tangent[None, :], np.array([tangent @ before.z + s]))
        turned = problem.tangents(point)[0]
        return float(turned[-1] / (turned @ tangent)), float(point.z[-1])

    low, high = 0.0, length
    at_low, _ = slope(low)
    at_high, value = slope(high)
    for i in range(60):
        # Illinois would do; bisection every third time keeps the bracket shrinking
        middle = 0.5 * (low + high) if i % 3 == 2 else (low * at_high - high * at_low) / (at_high - at_low)
        at_middle, value = slope(middle)
        if abs(at_middle) < 1e-10 or high - low < 1e-12:
            break
        if at_middle * at_low > 0:
            low, at_low = middle, at_middle
        else:
            high, at_high = middle, at_middle
    return value
