"""Cycles along a branch in one parameter: the equations of a cycle, steps from one to the next, the
special points between them, and both ways from a case to where the branch ends.

F(x, q) = R(x, q) - x of a return map R: its zeros are cycles, as a curve or surface over the free
parameters q.  The Jacobian of F by both comes from the variational equations, so that a fold, where
two cycles meet, is a regular point of the curve.

A step is accepted only if nothing suggests a jump to another branch or another part of this one:
the corrector stays near the prediction, both points lie on one smooth curve, the orientation and
the order of events are the same, and no resonance has passed unseen.  Where a multiplier passes 1,
the cycle may respond by a peak that is much narrower than a step, with folds on its flanks; where
two others resonate, it may be unstable within a narrow tongue.  So a point is computed on each
resonance, and must lie where the step leads to expect it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property, lru_cache, partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq, root_scalar

from disc_model.arrays import Array
from disc_model.errors import Fault, ModeError, ParameterError
from disc_model.parameters import Parameters
from disc_model.simulation.states import State
from disc_model.stability.continuation.curve import (
    DRIFT,
    FARTHEST,
    CurvePoint,
    Evaluation,
    Rejected,
    StepControl,
    check_step,
    curve_point,
    follow_curve,
    follow_multipliers,
    hidden_resonances,
    interpolate,
    passes,
    predict,
)
from disc_model.stability.cycle import SLIPPING, find_cycle
from disc_model.stability.return_map import (
    ENDS,
    PARAMETERS,
    Orbit,
    ReturnMap,
    SlippingMap,
    newton_step,
    rounding,
)

MOST_CORRECTIONS = 14  # of Newton's method with Broyden's updates, which takes 3 to 5
SLOW = 0.3  # a correction that leaves more of the residual needs the derivative at its own point
GOAL = 30  # residual of a point, over the tolerance of the map
# the last correction of a point whose residual is limited by rounding; a residual that is as small
# but no zero, as beside a narrow fold, leads to corrections a hundred times as large
UNCERTAIN = 1e-7
SMALLEST_OF_SPAN = 0.1  # of a parameter's scale, over the largest value within its bounds
DIFFERENCE = 1e-6  # over a parameter's scale: orbits are accurate to 1e-13, their second derivatives of order one
MAPS_AT_HAND = 8  # points between two others are computed before these are kept
DEEPEST = 6  # points on one resonance, each where the former ones predict it
PEAK = 0.01  # distance of such a point from where it is expected that shows a peak, over the step
SMALLEST_PEAK = 1e-5  # the same, over the static deflection
# Arclength of a step within which the order of events may change, or the orientation, and the curve
# may have a corner, as where a switch that is just touched changes nothing else: at a jump of the
# map no corrector comes to a point so near.
CORNER = 1e-5
PRECISION = 1e-9  # of the share of a step at which a point is located: what remains is its square
MOST_BETWEEN = 500  # points of a branch from one value to another
STEEP = 0.05  # slope of the tangent above which a step ends at a given parameter, so that one map serves it
AT_BOUND = 1e-11  # distance from a bound that is rounding, over the parameter's scale

FOLD = "fold"
PERIOD_DOUBLING = "period_doubling"
NEIMARK_SACKER = "neimark_sacker"
GRAZING = "grazing"
BRANCH_POINT = "branch_point"
BOUND = "bound"
CLOSED = "closed"
HOPF = "hopf"
LIMIT = "limit"
LOST = "lost"
BESIDE_HOPF = 1e-3  # distance from a Hopf point within which no other special point is listed
ON_CIRCLE = 1e-6  # largest difference of a critical multiplier's modulus from one
BEYOND = 1e-4  # arclength beyond the last cycle, which is within the shortest step of a jump
SAME_TIMES = 5e-3  # change of period and stick there, over the period, without another event
STEEPEST = 1e4  # leading multiplier beside a grazing release, towards which it grows without bounds

# largest distance, over the deflection, of a cycle from itself half a period later that is looked at
# as one of half the period: at a doubling, Newton's method comes to a double zero
SAME_HALVES = 1e-3
NEAR_DOUBLING = 0.02  # distance from -1 of the multiplier from which a branch is sought there
# the first change of the parameter in the search for a doubling, and the last one, over its scale; how
# far a doubling may be from the cycle beside which it is sought
BESIDE = 1e-6
ROUNDING = 1e-12
FARTHEST_DOUBLING = 0.2
DEPARTURE = 1e-3  # distance of a branch's first cycle from the doubling, over the deflection


# ---- The equations


class CycleProblem:
    """F of the cycles of a kind of a case, in free parameters within the bounds of each.

    Unknowns are z = (x / size, q / scales), with the norm of the static deflection as size, and as
    scale of a parameter its value, or a tenth of the largest one, if that is more. Cycles of
    a given number of `releases` may lose contact; those of 0 have one release in contact. Points x of
    the section are in the coordinates of the case `base`; those of another case differ from them
    where the disc's frequencies do.

    bounds : least and largest scaled values of the parameters, (2, their number)
    """

    def __init__(
        self,
        base: Parameters,
        spans: Mapping[str, tuple[float, float]],
        tol: float,
        releases: int = 0,
        kind: str = "",
    ) -> None:
        self.base = base
        self.spans = spans
        self.names = tuple(spans)
        own = np.abs([base.numbers[name] for name in spans])
        ends = np.array(list(spans.values())).T
        self.scales = np.maximum(own, SMALLEST_OF_SPAN * np.abs(ends).max(axis=0))
        self.bounds = ends / self.scales
        self.tol = tol
        self.releases = releases
        self._make_map = SlippingMap if kind == SLIPPING else ReturnMap
        self.reference = self._make_map(base, tol)
        self.n = self.reference.size
        self.size = self.reference.deflection
        self._differentiable = tuple(name for name in self.names if name in PARAMETERS)
        self._map_of = lru_cache(MAPS_AT_HAND)(self._new_map)

    def values(self, z: Array) -> Array:
        """The free parameters at a point."""
        return np.asarray(z[self.n :] * self.scales)

    def map_at(self, z: Array) -> ReturnMap:
        """The return map of the case at a point."""
        return self._map_of(*self.values(z).tolist())

    def case(self, z: Array) -> Parameters:
        """The case at a point."""
        return self.map_at(z).parameters

    def _new_map(self, *values: float) -> ReturnMap:
        try:
            p = self.base.replace(**dict(zip(self.names, values, strict=True)))
            if min(p.Omega, p.N, p.k_p) <= 0:
                raise Rejected("the drive, the preload or the in-plane spring vanishes")
            return self._make_map(p, self.tol, self._differentiable, patient=self.releases > 0)
        except (ParameterError, ModeError) as fault:
            raise Rejected(str(fault)) from None

    def turn(self, z: Array) -> Array:
        """Factors from the coordinates of the map at z to those of the case `base`."""
        return np.asarray(self.reference.scale / self.map_at(z).scale)

    def section_point(self, z: Array) -> Array:
        """The point of the section, in the coordinates of the map at z."""
        return np.asarray(z[: self.n] * self.size / self.turn(z))

    def state(self, z: Array) -> State:
        """The state of the point on the section."""
        return self.map_at(z).state(self.section_point(z))

    def follow(self, z: Array, *, tangent: bool) -> Orbit:
        """The motion from a point to its return, whatever its end."""
        x = self.section_point(z)
        return self.map_at(z).evaluate(x, releases=max(self.releases, 1), tangent=tangent)

    def _return(self, z: Array, *, tangent: bool) -> tuple[Orbit, Array]:
        """The motion from a point to its return, and F."""
        orbit = self.follow(z, tangent=tangent)
        if not orbit.returned:
            raise Rejected(ENDS[orbit.outcome])
        return orbit, (orbit.end - orbit.start) * self.turn(z) / self.size

    def residual(self, z: Array) -> Array:
        """F at z."""
        return self._return(z, tangent=False)[1]

    def evaluate(self, z: Array) -> Evaluation:
        """F at z, with its derivatives."""
        orbit, residual = self._return(z, tangent=True)
        turn = self.turn(z)
        jacobian = orbit.jacobian * turn[:, None] / turn[None, :]
        known = dict(zip(self._differentiable, orbit.by.T, strict=True))
        columns = [jacobian - np.eye(self.n)]
        for i, name in enumerate(self.names):
            if name in known:
                columns.append(known[name] * turn / self.size * self.scales[i])
            else:
                columns.append(self._difference(z, residual, i))
        by = np.column_stack(columns)
        if not (np.isfinite(by).all() and np.isfinite(residual).all()):
            raise Rejected("the variational equations are singular: a switch is grazed")
        return Evaluation(residual, by, orbit, jacobian)

    def _difference(self, z: Array, here: Array, i: int) -> Array:
        """Derivative of F, which is `here` at z, by the i-th scaled parameter, by a difference of
        orbits: above z or, at a limit of the parameter, below. No special point depends on it."""
        beside = z.copy()
        for side in (DIFFERENCE, -DIFFERENCE):
            beside[self.n + i] = z[self.n + i] + side
            try:
                return (self.residual(beside) - here) / side
            except Rejected:
                continue
        raise Rejected("there is no orbit beside it")

    def solve(self, guess: Array, by: Array, along: Array, radius: float = np.inf) -> CurvePoint:
        """The point of the curve in the plane through `guess` normal to the unit vector `along`, by Newton's
        method.

        It starts with the derivative `by` of F at a point nearby, and improves it by Broyden's updates,
        because F costs a tenth of its derivatives. The tangent makes an acute angle with the vector.
        Raises `Rejected` if the iteration leaves a `radius` round the guess, or does not converge.
        """
        z = guess
        matrix = np.vstack([by, along])
        step: Array | None = None
        last = np.inf
        fresh = False  # whether the matrix is that at the former iterate
        for _ in range(MOST_CORRECTIONS):
            right = np.append(self.residual(z), along @ (z - guess))
            error = float(np.linalg.norm(right))
            if error <= GOAL * self.tol:
                break

            if step is not None and error > SLOW * last:
                small = np.linalg.norm(step) <= UNCERTAIN
                if fresh and small and error <= rounding(self.tol, 1e4):
                    break
                matrix = np.vstack([self.evaluate(z).by, along])
                fresh = True
            elif step is not None:
                matrix = matrix + np.outer(right, step) / (step @ step)
                fresh = False

            last = error
            step = -newton_step(matrix, right)
            z = z + step
            if not np.linalg.norm(z - guess) <= radius:
                raise Rejected("the corrector moves too far")
        else:
            raise Rejected("Newton's method does not converge")

        # one more correction, now with the derivatives at this point, which are needed anyhow
        found = self.evaluate(z)
        matrix = np.vstack([found.by, along])
        z = z - newton_step(matrix, np.append(found.residual, along @ (z - guess)))
        if not np.linalg.norm(z - guess) <= radius:  # as where two branches cross
            raise Rejected("the corrector moves too far")
        return curve_point(z, found, along)

    def cycle_near(self, z: Array) -> CurvePoint:
        """The cycle near a point, at its value of the one free parameter; raises `Rejected` if there is
        none."""
        return self.solve(z, self.evaluate(z).by, parameter_row(len(z), 1.0))

    def place(self, x: Array) -> Array:
        """z of a point of the section of the case `base`."""
        values = np.array([self.base.numbers[name] for name in self.names])
        return np.concatenate([x / self.size, values / self.scales])

    def leading_diameters(self, point: CurvePoint) -> int:
        """Nodal diameters of the modes with most energy in the leading multiplier's eigenvector; -1
        on a rigid disc."""
        diameters = self.reference.diameters
        if not len(diameters):
            return -1
        energy = np.abs(point.spectrum.right[: len(diameters), 0]) ** 2
        return int(np.argmax(np.bincount(diameters, energy)))

    @cached_property
    def half(self) -> CycleProblem | None:
        """The problem of cycles of half as many releases; None if these are no whole number."""
        if self.releases == 0 or self.releases % 2:
            return None
        return CycleProblem(self.base, self.spans, self.tol, self.releases // 2)


def first_cycle(
    p: Parameters,
    name: str,
    bounds: tuple[float, float],
    tol: float,
    guess: State | None = None,
    releases: int = 1,
    kind: str = "",
) -> tuple[CycleProblem, CurvePoint]:
    """The problem of the cycles of a kind in a free parameter within bounds, and the cycle
    of the case `p`, from which they are followed: a point of the curve in one parameter, which rises
    along the tangent. Other arguments are those of `disc_model.floquet`.

    Raises `ParameterError` if there is no cycle, or `Rejected` if it cannot be followed.
    """
    cycle = find_cycle(p, tol, guess, releases, kind)
    may_separate = guess is not None
    if cycle.state is None or (cycle.releases > 1 and not may_separate):
        hint = f"start from another value of {name}, or give another guess"
        rule = f"must have a cycle, but the search ended with {cycle.message}; {hint}"
        raise ParameterError(Fault(("guess" if may_separate else "case",), "", rule))
    order = cycle.releases if may_separate else 0
    problem = CycleProblem(p, {name: bounds}, tol, order, kind)
    z = problem.place(problem.reference.point(cycle.state))
    return problem, problem.cycle_near(z)


def parameter_row(width: int, sense: float) -> Array:
    """The unit vector of the parameter, which is the last of `width` entries, with the sign of
    `sense`."""
    row = np.zeros(width)
    row[-1] = 1.0 if sense >= 0 else -1.0
    return row


# ---- Points along a branch


class Entry(NamedTuple):
    """A point along a branch; a special one has a kind, and its critical multiplier. And what is kept
    of it."""

    point: CurvePoint
    kind: str = ""
    multiplier: complex = 0j
    kept: Any = None


class Course(NamedTuple):
    """The points of a branch, special ones among them, and why it ends, in a word: at its first
    point, if it was followed both ways, and at its last."""

    entries: list[Entry]
    first: str
    last: str


class Tracer:
    """The way of a branch of a problem in one parameter, within its bounds. It keeps of each point along
    the branch what `keep` makes of it, while the map of its case is still at hand."""

    def __init__(
        self,
        problem: CycleProblem,
        steps: StepControl,
        keep: Callable[[CurvePoint], Any] = lambda _: None,
    ) -> None:
        self.problem = problem
        self.steps = steps
        self.low, self.high = problem.bounds[:, 0].tolist()
        self.keep = keep

    def follow(self, start: CurvePoint, direction: int = 0) -> Course:
        """The branch from a point on: both ways, or with rising (1) or falling (-1) values alone; one
        way from a period doubling, at which the branch of twice the period begins."""
        half = self.problem.half
        if half is not None and np.linalg.norm(half.residual(start.z)) <= SAME_HALVES:
            entries, last = self._one_way(leave_doubling(self.problem, half, start))
            doubling = self._kept(Entry(start, PERIOD_DOUBLING, 1.0 + 0j))
            return Course([doubling, *entries], PERIOD_DOUBLING, last)
        if direction:
            entries, last = self._one_way(start if direction > 0 else start.reversed())
            return Course(entries, "", last)
        back, first = self._one_way(start.reversed())
        if first == CLOSED:
            return Course(back, "", first)
        entries, last = self._one_way(start)
        if entries[0].kind:  # a special point at which it starts
            back[0] = entries[0]
        return Course([*reversed(back), *entries[1:]], first, last)

    def _kept(self, entry: Entry) -> Entry:
        return entry._replace(kept=self.keep(entry.point))

    def _one_way(self, start: CurvePoint) -> tuple[list[Entry], str]:
        """The branch from a point along its tangent, and why it ends."""
        entries = [self._kept(Entry(start))]
        end = self._bound_at(start)
        if not end:
            watch = partial(self._take, entries)
            points, why = follow_curve(start, self._advance, self.steps, watch)
            end = why if isinstance(why, str) else _loss(self.problem, points[-1], why)
            if end == HOPF:  # at which the curve turns, as at a fold
                last = points[-1].z
                entries = [
                    each
                    for each in entries
                    if not each.kind or np.linalg.norm(each.point.z - last) > BESIDE_HOPF
                ]
        return entries, end

    def _take(self, entries: list[Entry], points: list[CurvePoint]) -> str:
        """Take the last of some points, with the special ones before it, as far as the branch goes;
        the word for its end, if it is there."""
        before, new = points[-2:]
        end = self._bound_at(new)
        if len(points) > 3 and passes(before, new, points[0]):
            new = points[0]
            end = CLOSED
        try:
            if comes_to_doubling(self.problem, before, new):
                entries.append(self._kept(Entry(locate_doubling(self.problem, before))))
                return PERIOD_DOUBLING
            found = special_between(self, before, new)
        except Rejected:
            return LOST
        for each in found:
            bound = min(max(each.point.value, self.low), self.high)
            if each.kind == FOLD and each.point.value != bound:
                at_bound = self.locate(before, each.point, partial(_excess_over, bound))
                if at_bound is not None:
                    entries.append(self._kept(Entry(at_bound)))
                return BOUND
            if each.point is before:
                entries[-1] = each._replace(kept=entries[-1].kept)
            else:
                entries.append(self._kept(each))
        entries.append(self._kept(Entry(new)))
        return end

    def _bound_at(self, point: CurvePoint) -> str:
        """The end of the branch at a point that is at a bound, on the way out; else ""."""
        below = point.slope < 0 and point.value <= self.low + AT_BOUND
        if below or (point.slope > 0 and point.value >= self.high - AT_BOUND):
            return BOUND
        return ""

    # ---- Steps, which end at the bounds where they would pass them, and points between two neighbours

    def _advance(self, points: Sequence[CurvePoint], ds: float) -> list[CurvePoint]:
        """The points of a step of arclength ds beyond the last of some, resonances within it
        included; raises `Rejected` if a shorter step is needed."""
        current = points[-1]
        guess, by = predict(points, ds)
        row = _plane(current.tangent)
        value = float(guess[-1])
        bound = min(max(value, self.low), self.high)
        if bound != value:
            ds *= (bound - current.value) / (value - current.value)
            guess, by = predict(points, ds)
            guess[-1] = bound
            row = parameter_row(len(row), current.slope)
        ahead = self.problem.solve(guess, by, row, FARTHEST * ds)
        if ds > CORNER and np.linalg.norm(ahead.z - guess) > DRIFT * ds:
            raise Rejected("the corrector moves far")
        _check(current, ahead)
        return [*self._resonances(current, ahead, DEEPEST), ahead]

    def _resonances(self, before: CurvePoint, after: CurvePoint, deepest: int) -> list[CurvePoint]:
        """Points on the resonances between two neighbours; raises `Rejected` where one shows a peak
        of the branch, or a forced one cannot be located."""
        hidden = hidden_resonances(before.spectrum, after.spectrum)
        if deepest == 0 and any(forced for _, forced in hidden):
            raise Rejected("a resonance cannot be located")
        if deepest == 0 or not hidden:
            return []
        share, _ = hidden[0]
        expected, by = interpolate(before, after, share)
        length = float(np.linalg.norm(after.z - before.z))
        there = self.problem.solve(expected, by, _plane(before.tangent), FARTHEST * length)
        if np.linalg.norm(there.z - expected) > max(PEAK * length, SMALLEST_PEAK):
            raise Rejected("the branch has a peak within the step")
        _check(before, there)
        _check(there, after)
        return [
            *self._resonances(before, there, deepest - 1),
            there,
            *self._resonances(there, after, deepest - 1),
        ]

    def locate(
        self, before: CurvePoint, after: CurvePoint, test: Callable[[CurvePoint], float]
    ) -> CurvePoint | None:
        """The point between two neighbours where a test function vanishes; None if it has the same
        sign at both, or the curve cannot be followed to the point."""
        known = {0.0: before, 1.0: after}

        def value(share: float) -> float:
            if share not in known:
                known[share] = self._between(before, after, share)
            return test(known[share])

        if value(0.0) * value(1.0) > 0:
            return None
        try:
            root = float(brentq(value, 0.0, 1.0, xtol=PRECISION, rtol=4 * np.finfo(float).eps))
            return known.get(root) or self._between(before, after, root)
        except Rejected:
            return None

    def _between(self, before: CurvePoint, after: CurvePoint, share: float) -> CurvePoint:
        """The point of the curve at a share of the way between two neighbours."""
        chord = after.z - before.z
        length = float(np.linalg.norm(chord))
        row = _plane(chord / length, before.tangent, after.tangent)
        guess, by = interpolate(before, after, share)
        return self.problem.solve(guess, by, row, max(FARTHEST * length, 1e-6))


def follow_between(
    p: Parameters, name: str, begin: float, end: float, tol: float, longest: float = 0.1
) -> tuple[CycleProblem, Course]:
    """The branch of the cycle near the static start from one value of a parameter towards another, in
    steps up to the `longest`; errors are those of `first_cycle`."""
    bounds = (min(begin, end), max(begin, end))
    problem, start = first_cycle(p.replace(**{name: begin}), name, bounds, tol)
    steps = StepControl(longest=longest, max_points=MOST_BETWEEN)
    return problem, Tracer(problem, steps).follow(start, direction=int(np.sign(end - begin)))


def _excess_over(bound: float, point: CurvePoint) -> float:
    """The scaled parameter of a point over a bound."""
    return point.value - bound


def _check(before: CurvePoint, after: CurvePoint) -> None:
    """Raise `Rejected` unless two points are neighbours on one part of the branch."""
    if np.linalg.norm(after.z - before.z) <= CORNER:
        check_step(before, after, FARTHEST)
        return
    check_step(before, after)
    if after.orientation != before.orientation:
        raise Rejected("the orientation of the curve changes")
    if after.orbit.counts != before.orbit.counts:
        raise Rejected("the order of events changes")


def _plane(along: Array, *beside: Array) -> Array:
    """Normal of the plane in which a point is sought, some way along a unit vector: that of a fixed
    parameter where the curve is steep, by this vector and others, because a map of new parameters
    costs more than an orbit."""
    sense = float(np.sign(along[-1]))
    if min(sense * each[-1] for each in (along, *beside)) < STEEP:
        return along
    return parameter_row(len(along), sense)


def _loss(problem: CycleProblem, last: CurvePoint, rejected: Rejected) -> str:
    """Why a curve cannot be followed beyond a point at which even the shortest step was rejected.

    Where the return map is discontinuous, no cycle continues the branch. A switch is grazed there: just
    beyond, the motion has other events than the cycle, at other times, or no return.
    """
    if str(rejected) == "vanished":  # of cycles that slip all the time
        return HOPF
    cycle = last.orbit
    try:
        motion = problem.follow(last.z + BEYOND * last.tangent, tangent=False)
    except Rejected:
        return LIMIT
    moved = abs(motion.period - cycle.period) + abs(motion.stick_time - cycle.stick_time)
    same = motion.returned and motion.counts == cycle.counts
    if not same or moved > SAME_TIMES * cycle.period or abs(last.leading) > STEEPEST:
        return GRAZING
    return LOST


# ---- Special points: a test function changes sign between two points, and its root is located


def special_between(tracer: Tracer, before: CurvePoint, after: CurvePoint) -> list[Entry]:
    """The special points between two neighbours of a branch, in their order; raises `Rejected` if a
    fold between them cannot be computed."""
    if after.orbit.counts != before.orbit.counts:
        return [Entry(before, GRAZING, before.leading)]
    found = []
    knots = [before, after]
    if before.slope * after.slope < 0:
        fold = tracer.locate(before, after, lambda point: point.slope)
        if fold is None:
            raise Rejected("a fold cannot be located")
        knots.insert(1, fold)
        found.append(Entry(fold, FOLD, 1.0 + 0j))
    elif before.orientation != after.orientation:
        found.append(Entry(before, BRANCH_POINT, 1.0 + 0j))

    located = [(PERIOD_DOUBLING, tracer.locate(before, after, _doubling_test))]
    # a pair that crosses the circle before a fold often is two real multipliers at the fold
    for first, last in pairwise(knots):
        for test in _pair_tests(first, last):
            located.append((NEIMARK_SACKER, tracer.locate(first, last, test)))
    for kind, point in located:
        if point is not None:
            values = point.spectrum.values
            critical = complex(values[np.argmin(np.abs(np.abs(values) - 1))])
            if _kind_at(critical) == kind and abs(abs(critical) - 1) < ON_CIRCLE:
                found.append(Entry(point, kind, complex(critical.real, abs(critical.imag))))
    return sorted(found, key=lambda each: float((each.point.z - before.z) @ before.tangent))


def _kind_at(multiplier: complex) -> str:
    """Kind of bifurcation where a multiplier crosses the unit circle."""
    if multiplier.imag != 0:
        return NEIMARK_SACKER
    if multiplier.real > 0:
        return FOLD
    return PERIOD_DOUBLING


def _doubling_test(point: CurvePoint) -> float:
    """det (J + I), which changes sign where a real multiplier passes -1; without the factors of
    multipliers that are far away."""
    factors = 1 + point.spectrum.values
    return float(np.prod(factors / np.maximum(np.abs(factors), 1.0)).real)


def _pair_tests(before: CurvePoint, after: CurvePoint) -> Iterator[Callable[[CurvePoint], float]]:
    """Test functions of the pairs of multipliers that are complex at one of two neighbours at least, and
    may have crossed the unit circle at the other."""
    successors = follow_multipliers(before.spectrum, after.spectrum)
    first = before.spectrum.values
    last = after.spectrum.values[successors]
    crosses = (np.abs(first) - 1) * (np.abs(last) - 1) < 0
    parts = (first.imag > 0) & ((last.imag == 0) | crosses)
    meets = (first.imag == 0) & (last.imag > 0)
    yield from (partial(_excess, before, i) for i in np.flatnonzero(parts).tolist())
    yield from (partial(_excess, after, j) for j in successors[meets].tolist())


def _excess(start: CurvePoint, i: int, point: CurvePoint) -> float:
    """By how much the product of a pair exceeds one at a point: the i-th multiplier of another one, and
    the next, which is its conjugate there, though they may have become two real ones."""
    successors = follow_multipliers(start.spectrum, point.spectrum)[[i, i + 1]]
    return float(abs(np.prod(point.spectrum.values[successors]))) - 1


# ---- Period doublings seen from the cycle of twice the period. A cycle of an even number of
# ---- releases shrinks there to one of half as many, and its curve goes on along the same cycles,
# ---- half a period later: a branch begins and ends there


def comes_to_doubling(problem: CycleProblem, before: CurvePoint, after: CurvePoint) -> bool:
    """Whether a branch of cycles of an even number of releases comes to a period doubling at the
    second of two neighbours: both are the same cycles, half a period apart, or the second one hardly
    differs from itself half a period later; raises `Rejected` if a half does not return."""
    if problem.half is None:
        return False
    first = problem.half.residual(before.z)
    second = problem.half.residual(after.z)
    nearly = np.linalg.norm(second) < min(SAME_HALVES, float(np.linalg.norm(first)))
    return float(first @ second) < 0 or bool(nearly)


def locate_doubling(problem: CycleProblem, near: CurvePoint) -> CurvePoint:
    """The period doubling beside a cycle of twice the period, where that of half the releases has the
    multiplier -1; raises `Rejected` if it is not found.

    The shorter cycle is regular there, while F of the longer one has a double zero.
    """
    half = problem.half
    assert half is not None
    z = near.z.copy()
    z[: problem.n] += half.residual(near.z) / 2

    def excess(value: float) -> float:
        """By how much the critical multiplier exceeds -1 at a scaled value of the parameter; `z` is
        then the shorter cycle there."""
        nonlocal z
        z[-1] = value
        shorter = half.cycle_near(z)
        z = shorter.z
        return float(shorter.spectrum.values[nearest_to_doubling(shorter)].real) + 1

    found = root_scalar(excess, x0=near.value, x1=near.value + BESIDE, xtol=ROUNDING)
    excess(found.root)
    if not found.converged or np.linalg.norm(z - near.z) > FARTHEST_DOUBLING:
        raise Rejected("the period doubling cannot be located")
    return curve_point(z, problem.evaluate(z), near.tangent)


def nearest_to_doubling(point: CurvePoint) -> int:
    """The number of the multiplier that is nearest to -1."""
    return int(np.argmin(np.abs(point.spectrum.values + 1)))


def leave_doubling(problem: CycleProblem, half: CycleProblem, start: CurvePoint) -> CurvePoint:
    """The first cycle of a branch that begins at a period doubling, near a cycle of half as many
    releases, with the tangent away from it.

    Raises `ParameterError` if the start is not at a doubling, or no longer cycle is found.
    """
    # at a doubling the longer cycle is a double solution, which its search misses by some 1e-4
    shorter = half.cycle_near(start.z)
    critical = nearest_to_doubling(shorter)
    if abs(shorter.spectrum.values[critical] + 1) > NEAR_DOUBLING:
        rule = f"must be {half.releases}: the cycle at this state repeats after half as many"
        raise ParameterError(Fault(("releases",), str(problem.releases), rule))

    # along the eigenvector, in a plane normal to it, in which the shorter cycle is far away
    away = np.append(np.real(shorter.spectrum.right[:, critical]), 0.0)
    away /= np.linalg.norm(away)
    guess = shorter.z + DEPARTURE * away
    try:
        return problem.solve(guess, problem.evaluate(guess).by, away, DEPARTURE)
    except Rejected:
        raise ParameterError("no cycle of twice the period is near the doubling") from None
