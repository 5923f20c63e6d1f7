"""Borders of stability in the plane of two parameters, followed along the surface of cycles."""

import math
from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.stability.continuation import ends
from disc_model.stability.continuation.branch import Branch
from disc_model.stability.continuation.course import Course
from disc_model.stability.continuation.curve import (
    DIVERGES,
    CurvePoint,
    Evaluation,
    Rejected,
    StepControl,
    check_step,
    follow_curve,
    interpolate,
    solve,
)
from disc_model.stability.continuation.found import branch_of
from disc_model.stability.continuation.problem import CycleProblem
from disc_model.stability.continuation.spectrum import spectrum_of
from disc_model.stability.cycle import find_cycle, multipliers
from disc_model.stability.return_map import Array, newton_step

Kind = Literal["neutral", "fold"]
BORDER = StepControl(
    step=0.01, longest=0.05, shortest=1e-6, max_points=400, growth=1.4, easy=0.98, sharpest=0.8
)
"""Steps along borders, where each point costs several cycles."""

LEAST_RESEMBLANCE = 0.6  # of a multiplier's eigenvectors at two neighbouring points, at most 1
DIFFERENCE = 1e-4  # arclength of the difference that gives a multiplier's gradient
DEFECT = 0.1  # of a step along a border, which turns by up to 37 degrees; see `check_step`
ON_BORDER = 1e-10  # value of the test function that counts as zero
LONGEST_REACH = 0.1  # longest step on the way to a border
LARGEST_TURN = (
    0.1  # largest change of the multiplier in it; and half of it in a step along a border
)
REACHES = 60  # largest number of such steps
HALVINGS = 6  # of one of them, before it is given up
MOST_CORRECTIONS = 12  # of Newton's method at a point of a border
LARGEST_GROWTH = 1e3  # of its error over the least one: a first update of the gradient may be rough
CLOSES = 0.01  # distance from the first point of a border at which it has closed, over the step


class BorderProblem:
    """A border of stability on the surface of cycles in two parameters, where a test function
    vanishes.

    On a "neutral" border it is the logarithm of a multiplier's modulus. On a "fold" J - I is
    singular: its inverse, bordered by a row and a column near its null vectors, has a last entry
    that vanishes with it, and is smooth also where a second multiplier comes to 1 (Govaerts,
    Numerical methods for bifurcations of dynamical equilibria, 2000, Section 4.1).
    """

    def __init__(
        self, kind: Kind, p: Parameters, names: tuple[str, str], tol: float, steps: StepControl
    ) -> None:
        self.kind = kind
        self.steps = steps
        self.cycles = CycleProblem(p, names, None, tol)
        self.column = np.zeros(self.cycles.n)
        self.row = np.zeros(self.cycles.n)
        self.left = np.zeros(self.cycles.n, complex)

    def first(self, guess: Array | None, mu: complex | None) -> CurvePoint:
        """The point of the border next to a cycle, which is sought near a guess; that of the
        multiplier nearest to `mu`, or of the leading one."""
        cycles = self.cycles
        if mu is None or guess is None:
            z = cycles.place(find_cycle(cycles.base, cycles.tol, guess))
            found = cycles.evaluate(z)
            mu = 1.0 + 0j if self.kind == "fold" else complex(multipliers(found.jacobian)[0])
        else:
            z = cycles.place_at(guess)
            found = cycles.evaluate(z)
        self._keep_vectors(found.jacobian, mu)
        return self._reach(z, found)

    def next_point(self, points: Sequence[CurvePoint], ds: float) -> list[CurvePoint]:
        """The border's point at arclength ds beyond the last of some; raises `Rejected` if a
        shorter step is needed."""
        current = points[-1]
        ahead = self._correct(current, ds)
        if float(ahead.tangent @ current.tangent) < 0:
            ahead = ahead.reversed()
        check_step(current, ahead, self.steps.sharpest, DEFECT)
        return [ahead]

    def _keep_vectors(self, jacobian: Array, mu: complex) -> None:
        """Keep, of a point of the border, the singular vectors that border J - I on a fold, or the
        left eigenvector by which the multiplier is known again."""
        if self.kind == "fold":
            left, _, right = np.linalg.svd(jacobian - np.eye(self.cycles.n))
            self.column = left[:, -1]
            self.row = right[-1]
        else:
            spectrum = spectrum_of(jacobian)
            self.left = spectrum.left[int(np.argmin(np.abs(spectrum.values - mu)))]

    def _test(self, jacobian: Array) -> tuple[float, complex]:
        """Value of the test function, and the multiplier that gives it: the one whose eigenvector
        resembles that of the last point. Raises `Rejected` if none does."""
        if self.kind == "fold":
            corner = np.zeros((1, 1))
            singular = jacobian - np.eye(self.cycles.n)
            bordered = np.block([[singular, self.column[:, None]], [self.row[None, :], corner]])
            return float(newton_step(bordered, np.append(np.zeros(self.cycles.n), 1.0))[-1]), 1.0
        values, right = np.linalg.eig(jacobian)
        resemblance = np.abs(self.left @ right)
        best = int(np.argmax(resemblance))
        if not resemblance[best] > LEAST_RESEMBLANCE:
            raise Rejected("the multiplier changes its shape too fast")
        return math.log(abs(values[best])), complex(values[best])

    def _point(self, z: Array, found: Evaluation, mu: complex) -> CurvePoint:
        """A cycle on the surface, with the tangent of the curve on which the test function keeps
        its value."""
        self._keep_vectors(found.jacobian, mu)
        basis = np.linalg.svd(found.by)[2][self.cycles.n :]
        slopes = np.zeros(2)
        turns = np.zeros(2, complex)
        for i, unit in enumerate(basis):
            ends_of_difference = []
            for side in (1, -1):
                beside = self.cycles.evaluate(z + side * DIFFERENCE * unit)
                ends_of_difference.append(self._test(beside.jacobian))
            (value, multiplier), (former_value, former_multiplier) = ends_of_difference
            slopes[i] = (value - former_value) / (2 * DIFFERENCE)
            turns[i] = (multiplier - former_multiplier) / (2 * DIFFERENCE)
        steepness = float(np.linalg.norm(slopes))
        if not steepness > 0:
            raise Rejected("the multiplier does not depend on the parameters")
        along = np.array([-slopes[1], slopes[0]]) / steepness
        tangent = along @ basis
        gradient = slopes @ basis
        sign, _ = np.linalg.slogdet(np.vstack([found.by, gradient, tangent]))
        return CurvePoint(
            z,
            found.by,
            tangent,
            float(sign),
            found.orbit,
            found.jacobian,
            mu=mu,
            gradient=gradient,
            turning=turns @ basis,
        )

    def _reach(self, z: Array, found: Evaluation) -> CurvePoint:
        """Move from a cycle near the border onto it, by the shortest way on the surface."""
        value, mu = self._test(found.jacobian)
        for _ in range(REACHES):
            here = self._point(z, found, mu)
            if abs(value) < ON_BORDER:
                return here
            move = -value * here.gradient / (here.gradient @ here.gradient)
            turn = abs(complex(here.turning @ move))
            shares = (
                1.0,
                LONGEST_REACH / float(np.linalg.norm(move)),
                LARGEST_TURN / max(turn, 1e-300),
            )
            z, found, value, mu = self._moved(here, min(shares) * move)
        raise Rejected("no point of the curve was found near the first cycle")

    def _moved(self, here: CurvePoint, move: Array) -> tuple[Array, Evaluation, float, complex]:
        """The cycle in the direction of a move on the surface, at a shorter distance if need be,
        and the test function there."""
        rows = np.vstack([here.tangent, here.gradient / np.linalg.norm(here.gradient)])
        matrix = np.vstack([here.by, rows])
        for halvings in range(HALVINGS):
            step = move * 0.5**halvings
            try:
                z, found = solve(self.cycles, here.z + step, rows, matrix)
                return z, found, *self._test(found.jacobian)
            except Rejected:
                if halvings == HALVINGS - 1:
                    raise
        raise AssertionError("unreachable")

    def _correct(self, start: CurvePoint, ds: float) -> CurvePoint:
        """The border's point at arclength ds: F = 0, test = 0, and the plane normal to the
        tangent."""
        expected = start.mu + complex(start.turning @ (ds * start.tangent))
        if abs(expected - start.mu) > 2 * LARGEST_TURN:
            raise Rejected("the multiplier turns too fast")
        guess = start.z + ds * start.tangent
        rows = start.tangent[None, :]
        gradient = start.gradient
        z = guess
        found = self.cycles.evaluate(z)
        value, mu = self._test(found.jacobian)
        least = math.inf
        for _ in range(MOST_CORRECTIONS):
            right = np.concatenate([found.residual, [value], rows @ (z - guess)])
            error = float(np.linalg.norm(right))
            if error < ON_BORDER:
                return self._point(z, found, mu)
            least = min(least, error)
            if not error <= LARGEST_GROWTH * least:
                break
            move = -newton_step(np.vstack([found.by, gradient, rows]), right)
            z = z + move
            found = self.cycles.evaluate(z)
            former = value
            value, mu = self._test(found.jacobian)
            # Broyden's update: a gradient by differences would take four orbits at each correction
            gradient = gradient + (value - former - gradient @ move) / (move @ move) * move
        raise Rejected(DIVERGES)


class _Watch:
    """The end of a border: out of the bounds, or back at its first point."""

    def __init__(
        self, problem: BorderProblem, first: CurvePoint, bounds: Mapping[str, tuple[float, float]]
    ) -> None:
        cycles = problem.cycles
        self.first = first
        self.names = cycles.names
        self.n = cycles.n
        spans = np.array([bounds[name] for name in self.names])
        self.low, self.high = spans.T / cycles.scales
        self.end: ends.End | None = None

    def __call__(self, points: list[CurvePoint]) -> bool:
        values = points[-1].z[self.n :]
        if np.any(values < self.low) or np.any(values > self.high):
            self.end = ends.End(ends.BOUND, f"{' or '.join(self.names)} has left the bounds")
        elif len(points) > 3 and self._closes(*points[-2:]):
            points[-1] = self.first
            self.end = ends.End(ends.CLOSED, "the curve closes on itself")
        return self.end is not None

    def _closes(self, before: CurvePoint, new: CurvePoint) -> bool:
        chord = new.z - before.z
        length = float(np.linalg.norm(chord))
        share = float((self.first.z - before.z) @ chord) / length**2
        if not 0 < share <= 1 or abs(self.first.mu - new.mu) > 2 * LARGEST_TURN:
            return False
        expected = interpolate(before, new, share)
        return float(np.linalg.norm(expected.z - self.first.z)) < CLOSES * length


def continue_border(
    kind: Kind,
    p: Parameters,
    names: tuple[str, str],
    bounds: Mapping[str, tuple[float, float]],
    *,
    guess: Array | None = None,
    mu: complex | None = None,
    tol: float = 1e-12,
    steps: StepControl = BORDER,
) -> Branch:
    """Follow a border of stability in two parameters from the cycle of a case near the point
    `guess` of the section, both ways until it leaves the bounds, closes or ends; raises
    `ParameterError` if no cycle, or no curve, is near, or no step along it succeeds.

    A "neutral" border is one of the first cycle's leading multiplier. With `mu` the guess itself is
    a cycle on the border, such as a special point of a branch, and this its critical multiplier.
    """
    problem = BorderProblem(kind, p, names, tol, steps)
    try:
        first = problem.first(guess, mu)
    except Rejected as lost:
        raise ParameterError(str(lost)) from None
    slopes = first.tangent[problem.cycles.n :]
    leading_slope = slopes[0]
    if abs(slopes[0]) <= 1e-12:
        leading_slope = slopes[1]
    onward = first
    if leading_slope < 0:
        onward = first.reversed()

    points, end = _one_way(problem, onward.reversed(), bounds)
    if end.kind != ends.CLOSED:
        ahead, end = _one_way(problem, onward, bounds)
        points = [*points[:0:-1], *ahead]
    if len(points) == 1:
        raise ParameterError("no step along the curve succeeds")
    return branch_of(problem.cycles, Course(points, [], None, end))


def _one_way(
    problem: BorderProblem, first: CurvePoint, bounds: Mapping[str, tuple[float, float]]
) -> tuple[list[CurvePoint], ends.End]:
    """The points of a border from the first one along its tangent, and why they end."""
    watch = _Watch(problem, first, bounds)
    points, rejected = follow_curve(first, problem.next_point, problem.steps, watch)
    if watch.end is not None:
        return points, watch.end
    if rejected is not None:
        return points, ends.End(ends.LOST, str(rejected))
    return points, ends.at_most_points(problem.steps.max_points)
