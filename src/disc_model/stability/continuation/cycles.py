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

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property, lru_cache, partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.optimize import newton as root_by_secants

from disc_model.arrays import Array, ComplexArray
from disc_model.errors import Fault, ModeError, ParameterError
from disc_model.parameters import DEFAULTS, Parameters
from disc_model.simulation.states import State
from disc_model.stability.continuation.curve import (
    DRIFT,
    FARTHEST,
    CurvePoint,
    Evaluation,
    Guess,
    Passing,
    Rejected,
    StepControl,
    check_step,
    curve_point,
    follow_curve,
    follow_multipliers,
    interpolate,
    passes,
    passings,
    predict,
    solve,
    turns_between,
)
from disc_model.stability.cycle import SLIPPING, find_cycle, multipliers
from disc_model.stability.return_map import ENDS, PARAMETERS, Orbit, ReturnMap, SlippingMap

# typical values of parameters whose value in Table 1 is missing or 0
USUAL = {
    "Omega": 20.0,
    "N": 300.0,
    "c": 0.5,
    "c_p": 0.5,
    "contact_compliance": 1e-8,
    "contact_arc": 0.4,
    "damping_ratio": 1e-3,
    "friction_decay": 1.0,
    "viscous_friction": 0.01,
}
SMALLEST = 0.2  # of a parameter's scale, over its typical value
SMALLEST_OF_SPAN = 0.1  # of a parameter's scale, over the largest value of interest
DIFFERENCE = 1e-5  # over a parameter's scale: orbits are accurate to 1e-13, their second derivatives of order one
MAPS_AT_HAND = (
    8  # of the cases last used: points between two others are computed before these are kept
)

FASTEST_TURN = 1.2  # rad, of a multiplier within a step: its sense would be in doubt beyond pi
RESONANT = 2.0  # distance from a resonance at which it shows, over its width
NARROWEST = 1e-5  # width of a resonance of undamped multipliers, rad
MOST_TONGUES = 6  # resonances within a step, but forced ones, that are looked at
DEEPEST = 6  # points on one resonance, each where the former ones predict it
PEAK = 0.01  # distance of such a point from where it is expected that shows a peak, over the step
SMALLEST_PEAK = 1e-5  # the same, over the static deflection
# Arclength of a step within which the order of events may change, or the orientation, and the curve
# may have a corner, as where a switch that is just touched changes nothing else: at a jump of the
# map no corrector comes to a point so near.
CORNER = 1e-5
PRECISION = 1e-9  # of the share of a step at which a point is located: what remains is its square
MOST_BETWEEN = 500  # points of a branch from one value to another
EVEN = 0.5  # least slope over the largest one, of a curve without folds between two points
STEEP = 0.1  # slope of the tangent above which a step ends at a given parameter, so that one map serves it

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
ON_CIRCLE = 1e-6  # largest difference of a critical multiplier's modulus from one
SAME_POINT = 1e-7  # distance of two computations of one point of a branch, over the deflection
BESIDE_HOPF = 1e-3  # distance from a Hopf point within which no other special point is listed
SAME_VALUE = 1e-12  # relative difference of two values of a parameter that count as one
# arclengths beyond the last cycle, which is within the shortest step of a jump
BEYOND = (1e-6, 1e-5, 1e-4)
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
# distances of a branch's first cycle from the doubling, over the deflection: the branch may end nearer
DEPARTURES = (5e-3, 1e-3, 2e-4)


# ---- The equations


def parameter_scale(p: Parameters, name: str, farthest: float = 0.0) -> float:
    """The change of a parameter that counts as one: its value, a fifth of a typical one, or a tenth
    of the `farthest` value to which it is followed, whichever is most."""
    value = abs(p.numbers[name])
    usual = USUAL.get(name, DEFAULTS.get(name))
    typical = 0.0
    if isinstance(usual, float):
        typical = SMALLEST * usual
    return max(value, typical, SMALLEST_OF_SPAN * abs(farthest)) or 1.0


class CycleProblem:
    """F of the cycles of a case, in the free parameters `names`.

    Unknowns are z = (x / size, q / scales), with the norm of the static deflection as size. Cycles of
    a given number of `releases` may lose contact; those of 0 have one release in contact. Points x of
    the section are in the coordinates of the case `base`; those of another case differ from them
    where the disc's frequencies do.
    """

    def __init__(
        self,
        base: Parameters,
        names: Sequence[str],
        scales: Sequence[float],
        tol: float,
        releases: int = 0,
        make_map: Callable[..., Any] | None = None,
    ) -> None:
        self.base = base
        self.names = tuple(names)
        self.scales = np.array(scales)
        self.tol = tol
        self.releases = releases
        self.make_map = make_map or ReturnMap
        self.reference = self.make_map(base, tol)
        self.n = self.reference.size
        self.size = self.reference.deflection
        self._differentiable = tuple(name for name in names if name in PARAMETERS)
        self._map_of = lru_cache(MAPS_AT_HAND)(self._new_map)

    def values(self, z: Array) -> Array:
        """The free parameters at a point."""
        return np.asarray(z[self.n :] * self.scales)

    def case(self, z: Array) -> Parameters:
        """The case at a point; raises `ParameterError` where there is none."""
        return self._case_of(self.values(z).tolist())

    def _case_of(self, values: Sequence[float]) -> Parameters:
        return self.base.replace(**dict(zip(self.names, values, strict=True)))

    def map_at(self, z: Array) -> Any:
        """The return map of the case at a point."""
        return self._map_of(*self.values(z).tolist())

    def _new_map(self, *values: float) -> Any:
        try:
            p = self._case_of(values)
            if min(p.Omega, p.N, p.k_p) <= 0:
                raise Rejected("the drive, the preload or the in-plane spring vanishes")
            patient = self.releases > 0
            return self.make_map(p, self.tol, self._differentiable, patient=patient)
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
        changes = [
            known[name] * turn / self.size * self.scales[i]
            if name in known
            else self._difference(z, residual, i)
            for i, name in enumerate(self.names)
        ]
        by = np.column_stack([jacobian - np.eye(self.n), *changes])
        if not np.isfinite([*by.T, residual]).all():
            raise Rejected("the variational equations are singular: a switch is grazed")
        return Evaluation(residual, by, orbit, jacobian)

    def _difference(self, z: Array, here: Array, i: int) -> Array:
        """Derivative of F, which is `here` at z, by the i-th scaled parameter, by a difference of
        orbits: on both sides of z, or on one at a limit of the parameter, such as 0."""
        move = np.zeros(len(z))
        move[self.n + i] = DIFFERENCE
        sides = [side for side in (1, -1) if self._is_case(z + side * move)]
        if len(sides) == 2:
            return (self.residual(z + move) - self.residual(z - move)) / (2 * DIFFERENCE)
        [side] = sides
        return side * (self.residual(z + side * move) - here) / DIFFERENCE

    def _is_case(self, z: Array) -> bool:
        """Whether the parameters of z are those of a case."""
        try:
            self.case(z)
        except ParameterError:
            return False
        return True

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
        largest = int(np.argmax(np.abs(point.spectrum.values)))
        energy = np.abs(point.spectrum.right[: len(diameters), largest]) ** 2
        return int(np.argmax(np.bincount(diameters, energy)))

    @cached_property
    def half(self) -> CycleProblem | None:
        """The problem of cycles of half as many releases; None if these are no whole number."""
        if self.releases == 0 or self.releases % 2:
            return None
        releases = self.releases // 2
        return CycleProblem(self.base, self.names, self.scales.tolist(), self.tol, releases)


def first_cycle(
    p: Parameters,
    name: str,
    farthest: float,
    tol: float,
    guess: State | None = None,
    releases: int = 1,
    kind: str = "",
) -> tuple[CycleProblem, CurvePoint]:
    """The problem of the cycles of a kind in a free parameter up to its `farthest` value, and the cycle
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
    order = 0
    if may_separate:
        order = cycle.releases
    section = SlippingMap if kind == SLIPPING else None
    problem = CycleProblem(p, [name], [parameter_scale(p, name, farthest)], tol, order, section)
    z = problem.place(problem.reference.point(cycle.state))
    return problem, curve_point(*cycle_at_value(problem, z), parameter_row(len(z), 1.0))


def cycle_at_value(problem: CycleProblem, z: Array) -> tuple[Array, Evaluation]:
    """The cycle near a point, at its value of the one free parameter; raises `Rejected` if there is
    none."""
    row = parameter_row(len(z), 1.0)
    matrix = np.vstack([problem.evaluate(z).by, row])
    return solve(problem, z, row[None, :], matrix)


def leading(point: CurvePoint) -> complex:
    """The multiplier of largest modulus; 0 on a section of a single point."""
    values = point.spectrum.values
    if values.size:
        return complex(values[np.argmax(np.abs(values))])
    return 0j


def nearest(values: ComplexArray, wanted: complex) -> complex:
    """The one of some values that is nearest to a wanted one."""
    return complex(values[np.argmin(np.abs(values - wanted))])


def parameter_row(width: int, sense: float) -> Array:
    """The unit vector of the parameter, which is the last of `width` entries, with the sign of
    `sense`."""
    row = np.zeros(width)
    row[-1] = 1.0 if sense >= 0 else -1.0
    return row


def margin(value: float) -> float:
    """Largest difference of scaled values that count as equal."""
    return SAME_VALUE * max(1.0, abs(value))


# ---- Points along a branch


class Entry(NamedTuple):
    """A point along a branch or, if it has a kind, a special one between two of these, with its
    critical multiplier; and what is kept of it."""

    point: CurvePoint
    kind: str = ""
    multiplier: complex = 0j
    kept: Any = None


class Course(NamedTuple):
    """The points of a branch, special ones between them, and why it ends, in a word: at its first
    point, if it was followed both ways, and at its last."""

    entries: list[Entry]
    first: str
    last: str


class Tracer:
    """The way of a branch of a problem in one parameter, between the bounds of a span. It keeps of each point
    along the branch what `keep` makes of it, while the map of its case is still at hand."""

    def __init__(
        self,
        problem: CycleProblem,
        steps: StepControl,
        span: tuple[float, float],
        keep: Callable[[CurvePoint], Any] = lambda _: None,
    ) -> None:
        self.problem = problem
        self.steps = steps
        self.low, self.high = (bound / problem.scales[0] for bound in span)
        self.keep = keep

    def follow(self, start: CurvePoint, direction: int = 0) -> Course:
        """The branch from a point on: both ways, or with rising (1) or falling (-1) values alone; one
        way from a period doubling, at which the branch of twice the period begins."""
        departure = leave_doubling(self.problem, start)
        if departure is not None:
            entries, last = self._one_way(departure)
            doubling = self._entry(start, PERIOD_DOUBLING, 1.0 + 0j)
            return Course([doubling, *entries], PERIOD_DOUBLING, last)
        if direction:
            entries, last = self._one_way(start if direction > 0 else start.reversed())
            return Course(entries, "", last)
        back, first = self._one_way(start.reversed())
        if first == CLOSED:
            return Course(back, "", first)
        entries, last = self._one_way(start)
        behind = [each._replace(point=each.point.reversed()) for each in reversed(back)]
        return Course([*behind, *entries[1:]], first, last)

    def _entry(self, point: CurvePoint, kind: str = "", multiplier: complex = 0j) -> Entry:
        return Entry(point, kind, multiplier, self.keep(point))

    def _one_way(self, start: CurvePoint) -> tuple[list[Entry], str]:
        """The branch from a point along its tangent, and why it ends."""
        entries = [self._entry(start)]
        end = self._bound_at(start)
        if not end:
            watch = partial(self._take, entries)
            points, why = follow_curve(start, self._advance, self.steps, watch)
            if isinstance(why, Rejected):
                why = _loss(self.problem, points[-1], why)
            end = why
        if end == HOPF:
            last = entries[-1].point.z
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
        end = ""
        if len(points) > 3 and self._closes(before, new, points[0]):
            new = points[0]
            end = CLOSED
        elif comes_to_doubling(self.problem, before, new):
            doubling = locate_doubling(self.problem, before)
            if doubling is not None:
                entries.append(self._entry(doubling))
            return PERIOD_DOUBLING
        try:
            found = special_between(self, before, new)
        except Rejected:
            return LOST
        for point, kind, multiplier in found:
            bound = min(max(point.value, self.low), self.high)
            if kind == FOLD and point.value != bound and not self.steps.beyond:
                at_bound = self.locate(before, point, partial(_excess_over, bound))
                if at_bound is not None:
                    entries.append(self._entry(at_bound))
                return BOUND
            entries.append(self._entry(point, kind, multiplier))
        entries.append(self._entry(new))
        return end or self._bound_at(new)

    def _bound_at(self, point: CurvePoint) -> str:
        """The end of the branch at a point that is at a bound, on the way out, or beyond it; else
        ""."""
        if self.steps.beyond:
            leaves = not self.low <= point.value <= self.high
        else:
            below = point.slope < 0 and point.value <= self.low + margin(self.low)
            leaves = below or (point.slope > 0 and point.value >= self.high - margin(self.high))
        if leaves:
            return BOUND
        return ""

    def _closes(self, before: CurvePoint, after: CurvePoint, known: CurvePoint) -> bool:
        """Whether the curve between two neighbours passes through a known point in its sense."""
        share = passes(before, after, known, PEAK)
        if share is None or float(known.tangent @ (after.z - before.z)) < 0:
            return False
        try:
            there = self._between(before, after, share)
        except Rejected:
            return False
        away = there.z - known.z
        across = away - (away @ there.tangent) * there.tangent
        return float(np.linalg.norm(across)) < SAME_POINT

    # ---- Steps, which end at the bounds where they would pass them, and points between two neighbours

    def _advance(self, points: Sequence[CurvePoint], ds: float) -> list[CurvePoint]:
        """The points of a step of arclength ds beyond the last of some, resonances within it
        included; raises `Rejected` if a shorter step is needed."""
        current = points[-1]
        former = points[-2] if len(points) > 1 else None
        guess = predict(former, current, ds)
        row = _plane(current.tangent)
        value = float(guess.z[-1])
        bound = value if self.steps.beyond else min(max(value, self.low), self.high)
        if bound != value:
            ds *= (bound - current.value) / (value - current.value)
            guess = predict(former, current, ds)
            guess.z[-1] = bound
            row = parameter_row(len(row), current.slope)
        ahead = self._solve(guess, current.tangent, row, FARTHEST * ds)
        if ds > CORNER and np.linalg.norm(ahead.z - guess.z) > DRIFT * ds:
            raise Rejected("the corrector moves far")
        _check(current, ahead)
        return [*self._resonances(current, ahead, DEEPEST), ahead]

    def _resonances(self, before: CurvePoint, after: CurvePoint, deepest: int) -> list[CurvePoint]:
        """Points on the resonances between two neighbours; raises `Rejected` where one shows a peak
        of the branch, or a forced one cannot be located."""
        between = turns_between(before.spectrum, after.spectrum)
        if np.abs(between.turns).max(initial=0.0) > FASTEST_TURN:
            raise Rejected("a multiplier turns too fast")
        unseen = _unseen(passings(between))
        if not unseen:
            return []
        if deepest == 0:
            if any(each.forced for each in unseen):
                raise Rejected("a resonance cannot be located")
            return []
        expected = interpolate(before, after, unseen[0].share)
        length = float(np.linalg.norm(after.z - before.z))
        there = self._solve(expected, before.tangent, _plane(before.tangent), FARTHEST * length)
        if np.linalg.norm(there.z - expected.z) > max(PEAK * length, SMALLEST_PEAK):
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
        radius = max(FARTHEST * float(np.linalg.norm(chord)), 1e-6)
        row = _plane_between(before, after)
        return self._solve(interpolate(before, after, share), chord, row, radius)

    def _solve(self, guess: Guess, along: Array, row: Array, radius: float) -> CurvePoint:
        """The point of the curve in the plane through a guess, in the sense of a vector."""
        matrix = np.vstack([guess.by, row])
        z, found = solve(self.problem, guess.z, row[None, :], matrix, radius)
        point = curve_point(z, found, row)
        if float(point.tangent @ along) >= 0:
            return point
        return point.reversed()


def follow_between(
    p: Parameters, name: str, begin: float, end: float, tol: float, longest: float = 0.1
) -> tuple[CycleProblem, Course]:
    """The branch of the cycle near the static start from one value of a parameter towards another, in
    steps up to the `longest`; errors are those of `first_cycle`."""
    span = (min(begin, end), max(begin, end))
    case = p.replace(**{name: begin})
    problem, start = first_cycle(case, name, max(map(abs, span)), tol)
    steps = StepControl(longest=longest, max_points=MOST_BETWEEN)
    tracer = Tracer(problem, steps, span)
    return problem, tracer.follow(start, direction=int(np.sign(end - begin)))


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


def _plane(tangent: Array) -> Array:
    """Normal of the plane in which a step ends: that of a fixed parameter where the curve is not
    steep, because a map of new parameters costs more than an orbit."""
    if abs(tangent[-1]) < STEEP:
        return tangent
    return parameter_row(len(tangent), float(tangent[-1]))


def _plane_between(before: CurvePoint, after: CurvePoint) -> Array:
    """Normal of the planes in which points between two neighbours lie: that of a fixed parameter
    where the curve is steep all the way, and that of the chord elsewhere, as round a fold."""
    chord = after.z - before.z
    along = chord / np.linalg.norm(chord)
    slopes = float(np.sign(along[-1])) * np.array([before.slope, along[-1], after.slope])
    if slopes.min() > max(STEEP, EVEN * slopes.max()):
        return parameter_row(len(along), float(along[-1]))
    return np.asarray(along, dtype=float)


def _unseen(passed: list[Passing]) -> list[Passing]:
    """Those resonances within a step that neither of its ends is near enough to show: all forced
    ones and, of the others, those of the least damped multipliers."""
    hidden = [each for each in passed if each.distance > RESONANT * max(each.width, NARROWEST)]
    others = sorted(each.width for each in hidden if not each.forced)
    widest = np.inf
    if len(others) > MOST_TONGUES:
        widest = others[MOST_TONGUES - 1]
    return [each for each in hidden if each.forced or each.width <= widest]


def _loss(problem: CycleProblem, last: CurvePoint, rejected: Rejected) -> str:
    """Why a curve cannot be followed beyond a point at which even the shortest step was rejected.

    Where the return map is discontinuous, no cycle continues the branch. A switch is grazed there: just
    beyond, the motion has other events than the cycle, at other times, or no return.
    """
    if str(rejected) == "vanished":  # of cycles that slip all the time
        return HOPF
    cycle = last.orbit
    for distance in BEYOND:
        try:
            motion = problem.follow(last.z + distance * last.tangent, tangent=False)
        except Rejected:
            return LIMIT
        moved = abs(motion.period - cycle.period) + abs(motion.stick_time - cycle.stick_time)
        same = motion.returned and motion.counts == cycle.counts
        if not same or moved > SAME_TIMES * cycle.period:
            return GRAZING
    if abs(leading(last)) > STEEPEST:
        return GRAZING
    return LOST


# ---- Special points: a test function changes sign between two points, and its root is located


Special = tuple[CurvePoint, str, complex]
"""A special point of a kind, with its critical multiplier."""


def special_between(tracer: Tracer, before: CurvePoint, after: CurvePoint) -> list[Special]:
    """The special points between two neighbours of a branch, in their order; raises `Rejected` if a
    fold between them cannot be computed."""
    found = list(_found_between(tracer, before, after))
    return sorted(found, key=lambda each: float((each[0].z - before.z) @ before.tangent))


def _found_between(tracer: Tracer, before: CurvePoint, after: CurvePoint) -> Iterator[Special]:
    """The special points between two neighbours."""
    if after.orbit.counts != before.orbit.counts:
        yield before, GRAZING, leading(before)
        return
    knots = [before, after]
    if before.slope * after.slope < 0:
        fold = tracer.locate(before, after, lambda point: point.slope)
        if fold is None:
            raise Rejected("a fold cannot be located")
        knots.insert(1, fold)
        yield fold, FOLD, 1.0 + 0j
    elif before.orientation != after.orientation:
        yield before, BRANCH_POINT, 1.0 + 0j
    if _doubling_test(before) * _doubling_test(after) < 0:
        doubled = tracer.locate(before, after, _doubling_test)
        if doubled is not None:
            critical = nearest(doubled.spectrum.values, -1.0)
            if abs(critical + 1) < ON_CIRCLE:
                yield doubled, PERIOD_DOUBLING, critical
    # a pair that crosses the circle before a fold often is two real multipliers at the fold
    for first, last in pairwise(knots):
        for pair in _crossing_pairs(first, last):
            point = tracer.locate(first, last, partial(_excess, *pair))
            if point is None:
                continue
            critical, _ = _followed(*pair, point)
            if abs(abs(critical) - 1) < ON_CIRCLE and critical.imag != 0:
                yield point, NEIMARK_SACKER, complex(critical.real, abs(critical.imag))


def _doubling_test(point: CurvePoint) -> float:
    """det (J + I), which changes sign where a real multiplier passes -1; without the factors of
    multipliers that are far away."""
    factors = 1 + point.spectrum.values
    return float(np.prod(factors / np.maximum(np.abs(factors), 1.0)).real)


def _crossing_pairs(before: CurvePoint, after: CurvePoint) -> Iterator[tuple[CurvePoint, int]]:
    """The pairs of multipliers, each as a point and the number of one there, that are complex at one
    of two neighbours at least, and may have crossed the unit circle at the other."""
    successors = follow_multipliers(before.spectrum, after.spectrum)
    first = before.spectrum.values
    last = after.spectrum.values[successors]
    crosses = (np.abs(first) - 1) * (np.abs(last) - 1) < 0
    parts = (first.imag > 0) & ((last.imag == 0) | crosses)
    meets = (first.imag == 0) & (last.imag > 0)
    yield from ((before, int(i)) for i in np.flatnonzero(parts))
    yield from ((after, int(j)) for j in successors[meets])


def _followed(start: CurvePoint, i: int, point: CurvePoint) -> tuple[complex, complex]:
    """The multipliers of a point that continue the i-th one of another, of a positive imaginary part,
    and the next, which is its conjugate."""
    successors = follow_multipliers(start.spectrum, point.spectrum)[[i, i + 1]]
    first, second = point.spectrum.values[successors].tolist()
    return first, second


def _excess(start: CurvePoint, i: int, point: CurvePoint) -> float:
    """By how much the modulus of the i-th multiplier exceeds one at a point; the mean modulus where
    the pair has become two real ones."""
    first, second = _followed(start, i, point)
    if first.imag != 0:
        return abs(first) - 1
    return abs(first * second) ** 0.5 - 1


# ---- Period doublings seen from the cycle of twice the period. A cycle of an even number of
# ---- releases shrinks there to one of half as many, and its curve goes on along the same cycles,
# ---- half a period later: a branch begins and ends there


def comes_to_doubling(problem: CycleProblem, before: CurvePoint, after: CurvePoint) -> bool:
    """Whether a branch of cycles of an even number of releases comes to a period doubling at the
    second of two neighbours: both are the same cycles, half a period apart, or the second one hardly
    differs from itself half a period later."""
    if problem.half is None:
        return False
    try:
        first, second = (problem.half.residual(each.z) for each in (before, after))
    except Rejected:
        return False
    nearly = np.linalg.norm(second) < min(SAME_HALVES, float(np.linalg.norm(first)))
    return float(first @ second) < 0 or bool(nearly)


def locate_doubling(problem: CycleProblem, near: CurvePoint) -> CurvePoint | None:
    """The period doubling beside a cycle of twice the period, where that of half the releases has the
    multiplier -1; None if it is not found.

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
        z, found = cycle_at_value(half, z)
        return nearest(multipliers(found.jacobian), -1.0).real + 1

    try:
        value = root_by_secants(excess, near.value, x1=near.value + BESIDE, tol=ROUNDING)
        excess(value)
        found = problem.evaluate(z)
    except (Rejected, RuntimeError):  # which scipy raises where a search does not converge
        return None
    if np.linalg.norm(z - near.z) > FARTHEST_DOUBLING:
        return None
    return curve_point(z, found, near.tangent)


def leave_doubling(problem: CycleProblem, start: CurvePoint) -> CurvePoint | None:
    """The first cycle of a branch that begins at a period doubling, near a cycle of half as many
    releases, with the tangent away from it; None if the start is no such cycle.

    Raises `ParameterError` if the start is one of half as many releases, and not at a doubling.
    """
    half = problem.half
    if half is None or np.linalg.norm(half.residual(start.z)) > SAME_HALVES:
        return None
    # at a doubling the longer cycle is a double solution, which its search misses by some 1e-4
    z, shorter = cycle_at_value(half, start.z)
    values, vectors = np.linalg.eig(shorter.jacobian)
    critical = int(np.argmin(np.abs(values + 1)))
    if abs(values[critical] + 1) > NEAR_DOUBLING:
        rule = f"must be {half.releases}: the cycle at this state repeats after half as many"
        raise ParameterError(Fault(("releases",), str(problem.releases), rule))

    # along the eigenvector, and across the branch of half the period, on which the plane has no cycle
    away = np.append(np.real(vectors[:, critical]), 0.0)
    away /= np.linalg.norm(away)
    along = np.linalg.svd(shorter.by)[2][-1]
    row = away - (away @ along) * along
    row /= np.linalg.norm(row)
    for distance in DEPARTURES:
        guess = z + distance * away
        try:
            matrix = np.vstack([problem.evaluate(guess).by, row])
            return curve_point(*solve(problem, guess, row[None, :], matrix, distance), row)
        except Rejected:
            continue
    raise ParameterError("no cycle of twice the period is near the period doubling")
