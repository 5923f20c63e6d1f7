"""Borders of stability in two parameters: curves on which a multiplier has modulus one, or is one.

On the surface F = 0 of `cycle_problem` over two parameters, `continue_neutral` follows the curve on which the leading
multiplier has modulus one, `continue_fold` that on which one is equal to one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.stability.branch import Branch, Place, Stride, branch_of, check, starting_point, walk
from disc_model.stability.cycle_problem import CyclePoint, CycleProblem, Lost, newton_step
from disc_model.stability.multipliers import multipliers

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Test = Callable[[Array, complex], tuple[float, complex]]


def _nearest(values: ComplexArray, former: complex) -> complex:
    return complex(values[np.argmin(np.abs(values - former))])


def _on_circle(jacobian: Array, former: complex) -> tuple[float, complex]:
    """log of the modulus of the multiplier that continues `former`."""
    mu = _nearest(np.linalg.eigvals(jacobian).astype(complex), former)
    return math.log(abs(mu)), mu


def _at_one(jacobian: Array, former: complex) -> tuple[float, complex]:
    """The real multiplier that continues `former`, less one."""
    values = np.linalg.eigvals(jacobian).astype(complex)
    real = values[values.imag == 0]
    if len(real) == 0:
        raise Lost("no multiplier is real any more")
    mu = _nearest(real, former)
    return mu.real - 1.0, mu


def continue_neutral(
    p: Parameters, names: tuple[str, str], bounds: Mapping[str, tuple[float, float]], **how: object
) -> Branch:
    """Follow the curve on which the leading multiplier has modulus one, in two parameters.

    Parameters
    ----------
    p : a case near the curve, whose leading multiplier is the one followed
    names : the free parameters, two of Omega, N, D_star, c, c_p, k, k_p, E, m
    bounds : of both; the curve is followed until it leaves them, closes or ends
    how : direction (1 or -1), step, longest, shortest, max_points, scales, start, tol as in `continue_cycle`

    Raises
    ------
    ParameterError
        Bad input, no cycle to start from, or no neutral cycle near it.
    """
    return _continue_on_surface(p, names, bounds, _on_circle, None, **how)  # type: ignore[arg-type]


def continue_fold(
    p: Parameters, names: tuple[str, str], bounds: Mapping[str, tuple[float, float]], **how: object
) -> Branch:
    """Follow the curve of folds, on which a multiplier is one: as `continue_neutral`, from a case near a fold.

    `start` may be the point of the section nearest to the fold on a branch of `continue_cycle`.
    """
    return _continue_on_surface(p, names, bounds, _at_one, 1.0 + 0j, **how)  # type: ignore[arg-type]


def _continue_on_surface(
    p: Parameters,
    names: tuple[str, str],
    bounds: Mapping[str, tuple[float, float]],
    test: Test,
    former: complex | None,
    *,
    direction: int = 1,
    step: float = 0.01,
    longest: float = 0.05,
    shortest: float = 1e-6,
    max_points: int = 400,
    scales: Mapping[str, float] | None = None,
    start: Array | None = None,
    tol: float = 1e-12,
) -> Branch:
    names = tuple(names)  # type: ignore[assignment]
    check(p, names, 2)
    problem = CycleProblem(p, names, scales, tol)
    point = starting_point(problem, start)
    mu = former if former is not None else complex(multipliers(point.jacobian)[0])
    try:
        point, mu = _reach(problem, point, test, mu)
        ways = _ways(problem, point, test, mu)
    except Lost as lost:
        raise ParameterError(f"p: must be near a curve of this kind, but {lost}") from None
    lead = ways.along[problem.n] if abs(ways.along[problem.n]) > 1e-12 else ways.along[problem.n + 1]
    tangent = ways.along * direction * math.copysign(1.0, lead)
    limits = np.array([bounds[name] for name in names]) / problem.scales[:, None]

    def leaves(places: list[_OnCurve], ds: float) -> str:
        q = places[-1].point.z[problem.n :]
        if np.any(q < limits[:, 0]) or np.any(q > limits[:, 1]):
            return f"{' or '.join(names)} has left the bounds"
        if len(places) > 8 and np.linalg.norm(places[-1].point.z - places[0].point.z) < 0.6 * ds:
            return "the curve is closed"
        return ""

    stride = Stride(step, longest, shortest, growth=1.4, easy=0.98)
    first = _OnCurve(point, tangent, mu, ways)
    places, ended = walk(first, partial(_next, problem, test), stride, max_points, meet=lambda *_: None, leaves=leaves)
    return branch_of(problem, [place.point for place in places], np.zeros((0, 2)), ended)


def _next(problem: CycleProblem, test: Test, here: _OnCurve, ds: float) -> _OnCurve:
    """The curve's place at arclength ds along the tangent."""
    new, mu, ways = _correct_on_curve(problem, here, ds, test)
    turned = ways.along if ways.along @ here.tangent > 0 else -ways.along
    if turned @ here.tangent < 0.8:
        raise Lost("the curve bends too sharply")
    return _OnCurve(new, turned, mu, ways)


_DIFFERENCE = 1e-4
"""Arclength over which a multiplier's gradient along the surface is taken."""


@dataclass(frozen=True)
class _Ways:
    """At a point of the curve, all in the unknowns z: unit tangent, gradients of the test function and of the
    multiplier within the surface."""

    along: Array
    gradient: Array
    multiplier: ComplexArray

    def predicted(self, mu: complex, move: Array) -> complex:
        """Where a move takes the multiplier."""
        return mu + complex(self.multiplier @ move)


@dataclass(frozen=True)
class _OnCurve(Place):
    """A place with the multiplier that is followed, and what changes it."""

    mu: complex
    ways: _Ways


def _ways(problem: CycleProblem, point: CyclePoint, test: Test, mu: complex) -> _Ways:
    basis = problem.tangents(point)
    slopes, turns = np.zeros(2), np.zeros(2, complex)
    for i, unit in enumerate(basis):
        ends = [test(problem.evaluate(point.z + s * _DIFFERENCE * unit).jacobian, mu) for s in (-1, 1)]
        slopes[i] = (ends[1][0] - ends[0][0]) / (2 * _DIFFERENCE)
        turns[i] = (ends[1][1] - ends[0][1]) / (2 * _DIFFERENCE)
    size = float(np.linalg.norm(slopes))
    if not size > 0:
        raise Lost("the multiplier does not depend on the parameters")
    along = np.array([-slopes[1], slopes[0]]) / size
    return _Ways(along @ basis, slopes @ basis, np.asarray(turns @ basis, dtype=complex))


LONGEST_REACH, LARGEST_TURN, REACHES = 0.1, 0.1, 60
"""On the way to a curve: longest step, largest change of the multiplier in one, and number of steps."""


def _reach(problem: CycleProblem, point: CyclePoint, test: Test, mu: complex) -> tuple[CyclePoint, complex]:
    """From a cycle near the curve onto it, by the shortest way on the surface."""
    value, mu = test(point.jacobian, mu)
    for _ in range(REACHES):
        if abs(value) < 1e-10:
            return point, mu
        here = _ways(problem, point, test, mu)
        move = -value * here.gradient / (here.gradient @ here.gradient)
        turn = abs(complex(here.multiplier @ move))
        move *= min(1.0, LONGEST_REACH / float(np.linalg.norm(move)), LARGEST_TURN / max(turn, 1e-300))
        rows = np.vstack([here.along, here.gradient / np.linalg.norm(here.gradient)])
        for halvings in range(6):
            guess = point.z + move * 0.5**halvings
            try:
                new = problem.correct(guess, rows, rows @ guess)
                new_value, new_mu = test(new.jacobian, here.predicted(mu, move * 0.5**halvings))
                break
            except Lost:
                if halvings == 5:
                    raise
        point, value, mu = new, new_value, new_mu
    raise Lost("no point of the curve was found near the first cycle")


def _correct_on_curve(
    problem: CycleProblem, here: _OnCurve, ds: float, test: Test
) -> tuple[CyclePoint, complex, _Ways]:
    """The curve's point at arclength ds: F = 0, test = 0, and the plane normal to the tangent."""
    expected = here.ways.predicted(here.mu, ds * here.tangent)
    if abs(expected - here.mu) > 2 * LARGEST_TURN:
        raise Lost("the multiplier turns too fast")
    guess = here.point.z + ds * here.tangent
    rows = here.tangent[None, :]
    point = problem.evaluate(guess)
    value, found = test(point.jacobian, expected)
    gradient = _ways(problem, point, test, found).gradient
    last = math.inf
    for _ in range(12):
        right = np.concatenate([point.residual, [value], rows @ point.z - rows @ guess])
        error = float(np.linalg.norm(right))
        if error < 1e-10:
            return point, found, _ways(problem, point, test, found)
        if error > 0.9 * last:
            break
        last = error
        point = problem.evaluate(point.z - newton_step(np.vstack([point.by, gradient, rows]), right))
        value, found = test(point.jacobian, found)
    raise Lost("Newton's method does not converge")
