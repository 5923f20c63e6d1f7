"""Cycles followed through parameters: branches through their folds, neutral curves and folds in two parameters.

A cycle is a zero of F(x, q) = R(x, q) - x, with R the return map and q the free parameters; the Jacobian of F by x
and q comes from the variational equations.  `continue_cycle` follows the curve F = 0 in one parameter by
pseudo-arclength, so that folds (where two cycles meet and vanish) are points like any other.  `continue_neutral`
follows, on the surface F = 0 over two parameters, the curve on which a multiplier has modulus one, and
`continue_fold` that on which one is equal to one.

Distances mix the point, over the norm of the static deflection, with the parameters, over their scales.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.plate import mode_arrays
from disc_model.stability.floquet import CycleStatus, find_cycle, kind_of, multipliers
from disc_model.stability.return_map import OUTCOMES, PARAMETERS, RETURNED, Flight, ReturnMap
from disc_model.stability.tongue import Tongue

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

CORRECTIONS = 8
"""Newton steps allowed to a corrector before the arclength is halved."""


@dataclass(frozen=True, eq=False)
class Branch:
    """Cycles along a curve.

    Attributes
    ----------
    parameters : names of the free ones
    values : shape (n_points, n_parameters), in SI units
    period : s; stick_fraction; growth_rate : 1/s; each (n_points,)
    multipliers : complex, (n_points, n), largest modulus first
    diameters : int, (n_points,), nodal diameters of the modes that have most energy in the leading multiplier's vector
    points : (n_points, n), on the section, in the coordinates of `ReturnMap` for the case followed
    folds : (n_folds, n_parameters), values where the first parameter turns, located to rounding; on a branch in one
        parameter only
    ended : why it ends, in words
    """

    parameters: tuple[str, ...]
    values: Array
    period: Array
    stick_fraction: Array
    growth_rate: Array
    multipliers: ComplexArray
    diameters: NDArray[np.int64]
    points: Array
    folds: Array
    ended: str

    def __len__(self) -> int:
        return len(self.period)

    def kinds(self) -> list[str]:
        """Of each point: the bifurcation its leading multiplier stands for."""
        return [kind_of(complex(m[0])) for m in self.multipliers]


class _Lost(Exception):
    """The corrector found no cycle, or the motion no return; the message says which."""


@dataclass(frozen=True)
class _Point:
    z: Array
    residual: Array
    by: Array
    flight: Flight
    jacobian: Array


class _Problem:
    """F(x, q) in scaled unknowns z = (x / size, q / scales)."""

    def __init__(self, p: Parameters, names: tuple[str, ...], scales: Mapping[str, float] | None, tol: float) -> None:
        self.base, self.names, self.tol = p, names, tol
        reference = ReturnMap(p, tol)
        self.n = reference.size
        self.scale = reference.scale
        self.size = float(np.linalg.norm(reference.static))
        self._diameters = reference.diameters
        given = dict(scales or {})
        self.scales = np.array([given.get(name, default_scale(p, name)) for name in names])

    def case(self, z: Array) -> Parameters:
        values = z[self.n :] * self.scales
        try:
            return self.base.replace(**dict(zip(self.names, map(float, values), strict=True)))
        except ParameterError as error:
            raise _Lost(str(error)) from None

    def unknowns(self, x: Array, p: Parameters, scale: Array) -> Array:
        """z of a point x given in the coordinates of case `p`."""
        q = np.array([getattr(p, name) for name in self.names]) / self.scales
        return np.concatenate([x / scale * self.scale / self.size, q])

    def evaluate(self, z: Array) -> _Point:
        p = self.case(z)
        if min(p.Omega, p.N, p.k_p) <= 0:
            raise _Lost("the drive, the preload or the in-plane spring vanishes")
        map_ = ReturnMap(p, self.tol, self.names)
        x = z[: self.n] * self.size / self.scale * map_.scale
        flight, end, jacobian, by = map_.evaluate(x)
        if flight.outcome != RETURNED:
            raise _Lost(f"the motion does not return: {OUTCOMES[flight.outcome]}")
        # into the reference's coordinates: they differ where E is free
        turn = self.scale / map_.scale
        jacobian = jacobian * turn[:, None] / turn[None, :]
        residual = (end - x) * turn / self.size
        if not (np.all(np.isfinite(jacobian)) and np.all(np.isfinite(by)) and np.all(np.isfinite(residual))):
            raise _Lost("the variational equations are singular: a switch is grazed")
        parameters = by * turn[:, None] * self.scales[None, :] / self.size
        return _Point(z, residual, np.hstack([jacobian - np.eye(self.n), parameters]), flight, jacobian)

    def correct(self, z: Array, rows: Array, targets: Array) -> _Point:
        """Solve F = 0 with `rows` z = `targets`."""
        point = self.evaluate(z)
        last = math.inf
        for _ in range(CORRECTIONS):
            right = np.concatenate([point.residual, rows @ point.z - targets])
            error = float(np.linalg.norm(right))
            if error <= 30 * self.tol:
                return point
            if error > 0.8 * last:
                if error <= 1e4 * self.tol:
                    return point
                break
            last = error
            point = self.evaluate(point.z - np.linalg.solve(np.vstack([point.by, rows]), right))
        raise _Lost("Newton's method does not converge")

    def leading_diameters(self, jacobian: Array) -> int:
        """Nodal diameters of the modes with most energy in the leading multiplier's eigenvector."""
        values, vectors = np.linalg.eig(jacobian)
        energy = np.abs(vectors[:, np.argmax(np.abs(values))]) ** 2
        return int(np.argmax(np.bincount(self._diameters, energy)))

    def tangents(self, point: _Point) -> Array:
        """Orthonormal basis of the null space of F's Jacobian: (number of parameters, n + number of parameters)."""
        _, _, rows = np.linalg.svd(point.by)
        return np.asarray(rows[self.n :], dtype=float)


def default_scale(p: Parameters, name: str) -> float:
    """Change of a parameter that counts as much as the static deflection itself: its value, or part of a usual one."""
    usual = {
        "Omega": 20.0,
        "N": 300.0,
        "D_star": 1e-5,
        "c": 0.5,
        "c_p": 0.5,
        "k": 5e4,
        "k_p": 2e4,
        "E": 1.5e11,
        "m": 0.1,
    }
    return max(abs(float(getattr(p, name))), 0.2 * usual[name])


def _check(p: object, names: tuple[str, ...], count: int) -> None:
    faults = []
    if not isinstance(p, Parameters):
        faults.append(f"p={p!r}: must be Parameters")
    if len(names) != count or len(set(names)) != len(names) or not set(names) <= set(PARAMETERS):
        faults.append(f"names={names!r}: must be {count} of {', '.join(PARAMETERS)}")
    if faults:
        raise ParameterError(*faults)


def _start(problem: _Problem, p: Parameters, start: Array | None) -> Array:
    cycle = find_cycle(p, problem.tol, start)
    if cycle.status is not CycleStatus.OK or cycle.map is None or cycle.solution is None:
        raise ParameterError(f"p: must have a cycle to start from, but {cycle.message}")
    if cycle.solution.flight.releases != 1:
        raise ParameterError("p: must have a cycle with a single release to start from")
    return problem.unknowns(cycle.solution.x, p, cycle.map.scale)


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
    _check(p, (name,), 1)
    problem = _Problem(p, (name,), None if scale is None else {name: scale}, tol)
    z = _start(problem, p, start)
    point = problem.evaluate(z)
    tangent = problem.tangents(point)[0]
    tangent *= direction * (1.0 if tangent[-1] >= 0 else -1.0)
    points, folds, ended = [point], [], "the number of points allowed is reached"
    low, high = (bound / problem.scales[0] for bound in bounds)
    ds = step
    while len(points) < max_points:
        try:
            new = problem.correct(point.z + ds * tangent, tangent[None, :], np.array([tangent @ point.z + ds]))
            turned = problem.tangents(new)[0]
            turned *= 1.0 if turned @ tangent > 0 else -1.0
            if turned @ tangent < 0.9:
                raise _Lost("the curve bends too sharply")
        except _Lost as lost:
            ds /= 2
            if ds < shortest:
                ended = str(lost)
                break
            continue
        if turned[-1] * tangent[-1] < 0:
            folds.append(_locate_fold(problem, point, new, tangent) * problem.scales[0])
        easy = turned @ tangent > 0.99
        point, tangent = new, turned
        points.append(point)
        if not low <= point.z[-1] <= high:
            ended = f"{name} has left {bounds[0]:g} .. {bounds[1]:g}"
            break
        ds = min(longest, 1.5 * ds) if easy else ds
    return _branch(problem, points, np.array(folds).reshape(-1, 1), ended)


def _locate_fold(problem: _Problem, before: _Point, after: _Point, tangent: Array) -> float:
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


def _branch(problem: _Problem, points: list[_Point], folds: Array, ended: str) -> Branch:
    values = [multipliers(point.jacobian) for point in points]
    period = np.array([point.flight.period for point in points])
    return Branch(
        parameters=problem.names,
        values=np.array([point.z[problem.n :] * problem.scales for point in points]),
        period=period,
        stick_fraction=np.array([point.flight.stick_time for point in points]) / period,
        growth_rate=np.array([math.log(abs(v[0])) for v in values]) / period,
        multipliers=np.array(values),
        diameters=np.array([problem.leading_diameters(point.jacobian) for point in points]),
        points=np.array([point.z[: problem.n] * problem.size for point in points]),
        folds=folds,
        ended=ended,
    )


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
        raise _Lost("no multiplier is real any more")
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
    _check(p, names, 2)
    problem = _Problem(p, names, scales, tol)
    point = problem.evaluate(_start(problem, p, start))
    mu = former if former is not None else complex(multipliers(point.jacobian)[0])
    try:
        point, mu = _reach(problem, point, test, mu)
    except _Lost as lost:
        raise ParameterError(f"p: must be near a curve of this kind, but {lost}") from None
    here = _direction(problem, point, test, mu)
    tangent = here.along
    lead = tangent[problem.n] if abs(tangent[problem.n]) > 1e-12 else tangent[problem.n + 1]
    tangent = tangent * direction * math.copysign(1.0, lead)
    points, ended, ds = [point], "the number of points allowed is reached", step
    limits = np.array([bounds[name] for name in names]) / problem.scales[:, None]
    while len(points) < max_points:
        try:
            new, new_mu, there = _correct_on_curve(problem, point, here, tangent, ds, test, mu)
            turned = there.along if there.along @ tangent > 0 else -there.along
            if turned @ tangent < 0.8:
                raise _Lost("the curve bends too sharply")
        except _Lost as lost:
            ds /= 2
            if ds < shortest:
                ended = str(lost)
                break
            continue
        easy = turned @ tangent > 0.98
        point, tangent, mu, here = new, turned, new_mu, there
        points.append(point)
        q = point.z[problem.n :]
        if np.any(q < limits[:, 0]) or np.any(q > limits[:, 1]):
            ended = f"{' or '.join(names)} has left the bounds"
            break
        if len(points) > 8 and np.linalg.norm(point.z - points[0].z) < 0.6 * ds:
            ended = "the curve is closed"
            break
        ds = min(longest, 1.4 * ds) if easy else ds
    return _branch(problem, points, np.zeros((0, 2)), ended)


_DIFFERENCE = 1e-4
"""Arclength over which a multiplier's gradient along the surface is taken."""


@dataclass(frozen=True)
class _Direction:
    """At a point of the curve, all in the unknowns z: unit tangent, gradients of the test function and of the
    multiplier within the surface."""

    along: Array
    gradient: Array
    multiplier: ComplexArray

    def predicted(self, mu: complex, move: Array) -> complex:
        """Where a move takes the multiplier."""
        return mu + complex(self.multiplier @ move)


def _direction(problem: _Problem, point: _Point, test: Test, mu: complex) -> _Direction:
    basis = problem.tangents(point)
    slopes, turns = np.zeros(2), np.zeros(2, complex)
    for i, unit in enumerate(basis):
        ends = [test(problem.evaluate(point.z + s * _DIFFERENCE * unit).jacobian, mu) for s in (-1, 1)]
        slopes[i] = (ends[1][0] - ends[0][0]) / (2 * _DIFFERENCE)
        turns[i] = (ends[1][1] - ends[0][1]) / (2 * _DIFFERENCE)
    size = float(np.linalg.norm(slopes))
    if not size > 0:
        raise _Lost("the multiplier does not depend on the parameters")
    along = np.array([-slopes[1], slopes[0]]) / size
    return _Direction(along @ basis, slopes @ basis, np.asarray(turns @ basis, dtype=complex))


LONGEST_REACH, LARGEST_TURN, REACHES = 0.1, 0.1, 60
"""On the way to a curve: longest step, largest change of the multiplier in one, and number of steps."""


def _reach(problem: _Problem, point: _Point, test: Test, mu: complex) -> tuple[_Point, complex]:
    """From a cycle near the curve onto it, by the shortest way on the surface."""
    value, mu = test(point.jacobian, mu)
    for _ in range(REACHES):
        if abs(value) < 1e-10:
            return point, mu
        here = _direction(problem, point, test, mu)
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
            except _Lost:
                if halvings == 5:
                    raise
        point, value, mu = new, new_value, new_mu
    raise _Lost("no point of the curve was found near the first cycle")


def _correct_on_curve(
    problem: _Problem, before: _Point, here: _Direction, tangent: Array, ds: float, test: Test, mu: complex
) -> tuple[_Point, complex, _Direction]:
    """The curve's point at arclength ds: F = 0, test = 0, and the plane normal to the tangent."""
    expected = here.predicted(mu, ds * tangent)
    if abs(expected - mu) > 2 * LARGEST_TURN:
        raise _Lost("the multiplier turns too fast")
    guess = before.z + ds * tangent
    rows = tangent[None, :]
    point = problem.evaluate(guess)
    value, found = test(point.jacobian, expected)
    gradient = _direction(problem, point, test, found).gradient
    last = math.inf
    for _ in range(12):
        right = np.concatenate([point.residual, [value], rows @ point.z - rows @ guess])
        error = float(np.linalg.norm(right))
        if error < 1e-10:
            return point, found, _direction(problem, point, test, found)
        if error > 0.9 * last:
            break
        last = error
        step = np.linalg.solve(np.vstack([point.by, gradient, rows]), right)
        point = problem.evaluate(point.z - step)
        value, found = test(point.jacobian, found)
    raise _Lost("Newton's method does not converge")


def nearest_tongue(p: Parameters, period: float, multiplier: complex, diameters: int | None = None) -> Tongue:
    """The resonance that a cycle's multiplier belongs to.

    Over a period the slider turns by Omega T against the disc.  A free mode of frequency f and l diameters is therefore
    seen at f -/+ l Omega / 2 pi; one that the slider binds, so that it stands in the slider's frame, at f itself.
    Modulo f_s that is the multiplier's angle over 2 pi T.  The harmonic is the multiple of f_s nearest to it (of
    f_s / 2 for a negative real multiplier).

    Parameters
    ----------
    period : s
    diameters : l of the modes to choose from, as in `Branch.diameters`; all by default, and then chance may choose
    """
    rate = 1 / float(period)
    angle = math.atan2(multiplier.imag, multiplier.real) / (2 * math.pi)
    half = 0.5 if multiplier.imag == 0 and multiplier.real < 0 else 0.0
    best: tuple[float, Tongue] | None = None
    for frequency, l, bound in modes_at_rest(p):
        if diameters is not None and l != diameters:
            continue
        for sign in _signs(l, bound):
            seen = (frequency + sign * l * p.Omega / (2 * math.pi)) / rate
            miss = min(abs((seen - s * angle + 0.5) % 1 - 0.5) for s in (-1, 1))
            harmonic = round(seen - half) + half
            tongue = Tongue(harmonic, frequency, l, sign, float((harmonic - seen) * rate))
            if best is None or miss < best[0]:
                best = (miss, tongue)
    if best is None:
        raise ParameterError(f"diameters={diameters!r}: must be those of a mode")
    return best[1]


@dataclass(frozen=True, eq=False)
class TongueLine:
    """Where a resonance lies: `Omega` (rad/s) and `N` (N), shape (n_points,); the rest as in `Tongue`."""

    label: str
    harmonic: int
    frequency: float
    diameters: int
    sign: int
    Omega: Array
    N: Array


def rigid_period(p: Parameters) -> float:
    """Period of the stick-slip cycle on a rigid disc, in-plane damping neglected, s: P = N, slip a free oscillation."""
    rate = math.sqrt(p.k_p / p.m)
    extension = (p.mu_s - p.mu_k) * p.N / (p.r_0 * p.k_p)
    return 2 / rate * (math.pi - math.atan(extension * rate / p.Omega)) + 2 * extension / p.Omega


def tongue_lines(
    p: Parameters, loads: Array, speeds: tuple[float, float], *, diameters: int | None = None, harmonics: int = 12
) -> list[TongueLine]:
    """Lines n f_s = f -/+ l Omega / 2 pi, with f_s of the rigid disc's cycle: where to expect folds and tongues.

    Parameters
    ----------
    p : the case; its N and Omega do not matter
    loads : N, shape (n,), ascending
    speeds : rad/s, least and largest
    diameters : l of the modes wanted; all by default
    harmonics : largest n

    Returns
    -------
    A line for each resonance; two where it passes the same load at two speeds.
    """
    from scipy.optimize import brentq

    grid = np.geomspace(speeds[0], speeds[1], 60)
    lines = []
    for frequency, l, bound in modes_at_rest(p):
        if diameters is not None and l != diameters:
            continue
        for sign in _signs(l, bound):
            for n in range(1, harmonics + 1):

                def miss(
                    Omega: float, N: float, n: int = n, f: float = frequency, turn: float = sign * l / (2 * math.pi)
                ) -> float:
                    return n / rigid_period(p.replace(N=N, Omega=Omega)) - f - turn * Omega

                branches: dict[int, list[tuple[float, float]]] = {}
                for load in map(float, loads):
                    values = [miss(float(Omega), load) for Omega in grid]
                    for j, i in enumerate(np.flatnonzero(np.diff(np.sign(values)))):
                        branches.setdefault(j, []).append((brentq(miss, grid[i], grid[i + 1], args=(load,)), load))
                for points in branches.values():
                    label = Tongue(n, frequency, l, sign, 0.0).label
                    Omega, N = np.array(points).T
                    lines.append(TongueLine(label, n, frequency, l, sign, Omega, N))
    return lines


def _signs(l: int, bound: bool) -> tuple[int, ...]:
    """Shifts by the rotation that a mode may have."""
    if l == 0:
        return (0,)
    return (0, -1, 1) if bound else (-1, 1)


def modes_at_rest(p: Parameters) -> list[tuple[float, int, bool]]:
    """Frequency (Hz), number of diameters and whether the slider takes part, for every mode of disc and slider at rest.

    A coupled mode takes the diameters of the disc's mode that has most of its energy; its partner, which the slider
    leaves alone, keeps its own.
    """
    from scipy import linalg

    modes = mode_arrays(p)
    phi = modes.psi / modes.omega
    mass = np.diag(modes.omega**-2) + p.m * np.outer(phi, phi)
    stiffness = np.eye(modes.omega.size) + p.k * np.outer(phi, phi)
    inverse_squares, shapes = linalg.eigh(mass, stiffness)
    coupled = [
        (float(1 / math.sqrt(value)) / (2 * math.pi), int(modes.diameters[np.argmax(np.abs(shape))]), True)
        for value, shape in zip(inverse_squares, shapes.T, strict=True)
    ]
    alone = [
        (float(omega) / (2 * math.pi), int(l), False)
        for omega, l in zip(modes.omega, modes.diameters, strict=True)
        if l > 0
    ]
    return sorted(coupled + alone)


__all__ = [
    "Branch",
    "Tongue",
    "TongueLine",
    "continue_cycle",
    "continue_fold",
    "continue_neutral",
    "default_scale",
    "modes_at_rest",
    "nearest_tongue",
    "rigid_period",
    "tongue_lines",
]
