"""The course of a branch in one parameter: both ways from a point, until it leaves the bounds,
closes, or ends.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from disc_model.data.variables import value_with_unit
from disc_model.stability.continuation import ends, special
from disc_model.stability.continuation.curve import (
    CurvePoint,
    Rejected,
    StepControl,
    follow_curve,
    interpolate,
)
from disc_model.stability.continuation.doubling import (
    comes_to_doubling,
    doubling_end,
    leave_doubling,
    locate_doubling,
)
from disc_model.stability.continuation.ends import End
from disc_model.stability.continuation.problem import CycleProblem
from disc_model.stability.continuation.special import Located, Unlocated
from disc_model.stability.continuation.tracing import PEAK, BranchTracer, parameter_row
from disc_model.stability.cycle import FloquetResult

UNLOCATED = "a fold that cannot be located"  # beginning of one of the reasons to end
KIND_WORDS = {
    special.FOLD: "fold",
    special.PERIOD_DOUBLING: "period doubling",
    special.NEIMARK_SACKER: "Neimark-Sacker bifurcation",
}
SAME_POINT = 1e-7  # distance of two computations of one point of a branch, over the deflection
BESIDE = 0.1  # distance from a chord of points that may lie on the curve beside it, over the chord
BESIDE_HOPF = 1e-3  # distance from a Hopf point within which no other special point is listed
SAME_VALUE = 1e-12  # relative difference of two values of a parameter that count as one


@dataclass
class Course:
    """Points along a branch, the special points between them, and why it ends: at its first point
    if it was followed both ways, and at its last."""

    points: list[CurvePoint]
    special: list[Located]
    first: End | None
    last: End


def _say_nothing(point: CurvePoint) -> None:
    """Tell no one of a point."""


class Search:
    """The search for a branch of a problem in one parameter, between the bounds of a span, up to
    the first special point of one of the kinds `stop_at` if there is one. It tells of each point that is
    found along the branch."""

    def __init__(
        self,
        problem: CycleProblem,
        steps: StepControl,
        span: tuple[float, float],
        stop_at: frozenset[str] = frozenset(),
        tell: Callable[[CurvePoint], None] = _say_nothing,
    ) -> None:
        self.problem = problem
        self.steps = steps
        self.span = span
        self.stop_at = stop_at
        self.tell = tell
        self.low = span[0] / problem.scales[0]
        self.high = span[1] / problem.scales[0]
        limits = (-np.inf, np.inf) if steps.beyond else (self.low, self.high)
        self.tracer = BranchTracer(problem, steps, *limits)
        self.trace = _Trace(problem.n + 1)

    def follow_cycle(self, cycle: FloquetResult, direction: int = 0) -> Course:
        """The branch from a cycle of the problem's own case on, as `follow`."""
        rising = parameter_row(self.problem.n + 1, 1.0)
        return self.follow(self.problem.start(cycle, rising), direction)

    def follow(self, start: CurvePoint, direction: int = 0) -> Course:
        """The branch from a point on: both ways, or with rising (1) or falling (-1) values alone; one
        way from a period doubling, at which the branch of twice the period begins."""
        departure = leave_doubling(self.problem, start)
        if departure is not None:
            course = self.one_way(departure)
            course.first = End(ends.STOPPED, doubling_end(self.problem, start).text)
            course.special.insert(0, Located(special.PERIOD_DOUBLING, start, 1.0 + 0j, 0))
            return course
        if direction:
            return self.one_way(start if direction > 0 else start.reversed())
        down = self.one_way(start.reversed())
        if down.last.kind == ends.CLOSED:
            return down
        self.tracer.behind = [point.reversed() for point in reversed(down.points[1:])]
        up = self.one_way(start)
        last = len(down.points) - 1
        turned = [place._replace(after=last - 1 - place.after) for place in reversed(down.special)]
        onward = [place._replace(after=last + place.after) for place in up.special]
        return Course(
            points=[point.reversed() for point in reversed(down.points)] + up.points[1:],
            special=turned + onward,
            first=down.last,
            last=up.last,
        )

    def one_way(self, start: CurvePoint) -> Course:
        """The branch from a point along its tangent."""
        self.trace.add(start)
        end = self.bound_at(start)
        if end is not None:
            return Course([start], [], None, end)
        watch = _Watch(self)
        points, rejected = follow_curve(start, self.tracer.advance, self.steps, watch)
        if watch.end is not None:
            end = watch.end
        elif rejected is not None:
            end = ends.reason_of_loss(self.problem, points[-1], rejected)
        else:
            end = ends.at_most_points(self.steps.max_points)
        points = special.reveal_folds(self.tracer, points)
        if end.kind != ends.MOST_POINTS:
            points = special.reveal_growth(self.tracer, points)
        return self._located(special.reveal_stability(self.tracer, points), end)

    def _located(self, points: list[CurvePoint], end: End) -> Course:
        """A course with its special points; it ends before a fold that cannot be located, and at
        the first special point of a kind at which it shall stop."""
        found = list[Located]()
        last = len(points) - 1
        if end.kind == ends.DOUBLED:  # where the equations are singular
            last -= 1
        for i in range(last):
            try:
                between = special.locate_between(self.tracer, points[i], points[i + 1], i)
            except Unlocated as lost:
                end = End(ends.LOST, f"{UNLOCATED} {lost}")
                return Course(points[: i + 1], found, None, end)
            for place in between:
                if end.kind == ends.HOPF and _is_beside(place, points[-1]):
                    continue
                found.append(place)
                if place.kind in self.stop_at:
                    where = self.problem.words(place.point)
                    end = End(ends.STOPPED, f"the first {KIND_WORDS[place.kind]}, at {where}")
                    return Course([*points[: i + 1], place.point], found, None, end)
        return Course(points, found, None, end)

    def bound_at(self, point: CurvePoint) -> End | None:
        """The end of the branch at a point that is at a bound, on the way out, or beyond it."""
        if self.steps.beyond:
            beyond_low = point.value < self.low
            beyond_high = point.value > self.high
        else:
            beyond_low = point.slope < 0 and point.value <= self.low + _margin(self.low)
            beyond_high = point.slope > 0 and point.value >= self.high - _margin(self.high)
        if beyond_low:
            return self.end_at_bound(self.low)
        if beyond_high:
            return self.end_at_bound(self.high)
        return None

    def end_at_bound(self, bound: float) -> End:
        """The end of the branch at a bound, in words."""
        value = self.span[0] if bound == self.low else self.span[1]
        verb = "passed" if self.steps.beyond else "reached"
        return End(
            ends.BOUND, f"the bound {value_with_unit(self.problem.names[0], value)} was {verb}"
        )

    def point_at(self, before: CurvePoint, after: CurvePoint, value: float) -> CurvePoint | None:
        """The first point between two neighbours at which the scaled parameter has a value; None if
        there is none."""
        shares = _shares(before, after, value)
        return self.tracer.at_value(before, after, value, shares[0]) if shares else None

    def passes(self, before: CurvePoint, after: CurvePoint, known: CurvePoint) -> bool:
        """Whether the curve between two neighbours passes through a known point in its sense."""
        chord = after.z - before.z
        length = float(np.linalg.norm(chord))
        share = float((known.z - before.z) @ chord) / length**2
        if not 0 < share <= 1 or float(known.tangent @ chord) < 0:
            return False
        expected = interpolate(before, after, share)
        if np.linalg.norm(expected.z - known.z) > PEAK * length:
            return False
        try:
            there = self.tracer.between(before, after, share)
        except Rejected:
            return False
        away = there.z - known.z
        across = away - (away @ there.tangent) * there.tangent
        return float(np.linalg.norm(across)) < SAME_POINT

    def with_values(self, course: Course, wanted: Sequence[float]) -> Course:
        """The course with a point at each of some values, in SI units, wherever it passes one."""
        if not wanted:
            return course
        points = list[CurvePoint]()
        moved = list[Located]()
        for i, before in enumerate(course.points):
            points.append(before)
            here = [place for place in course.special if place.after == i]
            folds = [place.point for place in here if place.kind == special.FOLD]
            inserted = self._inserted([before, *folds, *course.points[i + 1 : i + 2]], wanted)
            for place in here:
                along = (place.point.z - before.z) @ before.tangent
                passed = sum((point.z - before.z) @ before.tangent < along for point in inserted)
                moved.append(place._replace(after=len(points) - 1 + int(passed)))
            points += inserted
        return Course(points, moved, course.first, course.last)

    def _inserted(self, knots: Sequence[CurvePoint], wanted: Sequence[float]) -> list[CurvePoint]:
        """The points at some values between knots of the curve, between which the parameter rises
        or falls, in their order."""
        inserted = list[CurvePoint]()
        for before, after in pairwise(knots):
            low, high = sorted([before.value, after.value])
            scaled = [value / self.problem.scales[0] for value in wanted]
            passed = [x for x in scaled if low + _margin(low) < x < high - _margin(high)]
            for value in sorted(passed, reverse=after.value < before.value):
                point = self.point_at(before, after, value)
                if point is not None:
                    inserted.append(point)
        return inserted


class _Watch:
    """What ends a branch that is followed from a point on: it tells after each new point whether
    that is the last one, and keeps the end."""

    def __init__(self, search: Search) -> None:
        self.search = search
        self.end: End | None = None

    def __call__(self, points: list[CurvePoint]) -> bool:
        before, new = points[-2:]
        self.search.tell(new)
        if len(points) > 3 and self.search.passes(before, new, points[0]):
            points[-1] = points[0]
            self.end = End(ends.CLOSED, "the branch closes on itself")
        elif comes_to_doubling(self.search.problem, before, new):
            self._end_at_doubling(points)
        elif not self._leaves(points):
            if self._repeats(before, new):
                points.pop()
                where = self.search.problem.words(new)
                text = f"the branch meets itself at {where}: shorter steps may keep it apart"
                self.end = End(ends.LOST, text)
            elif self._stops(before, new):
                self.end = End(ends.STOPPED, "")  # whose words follow when it is located
            else:
                self.search.trace.add(new)
        return self.end is not None

    def _end_at_doubling(self, points: list[CurvePoint]) -> None:
        """End the branch at the period doubling to which its last point has come, or before it where
        it cannot be located."""
        problem = self.search.problem
        points.pop()
        doubling = locate_doubling(problem, points[-1])
        if doubling is not None:
            points.append(doubling)
        self.end = doubling_end(problem, points[-1])

    def _leaves(self, points: list[CurvePoint]) -> bool:
        """Whether the branch leaves the span at the last point; or before it, and that point is
        then replaced by one at the bound, if there is one."""
        search = self.search
        before, new = points[-2:]
        self.end = search.bound_at(new)
        if self.end is not None or search.steps.beyond or before.slope * new.slope >= 0:
            return self.end is not None
        fold = self._fold_outside(before, new)
        if fold is None:
            return False
        bound = min(max(fold.value, search.low), search.high)
        at_bound = search.point_at(before, fold, bound)
        points.pop()
        if at_bound is not None:
            points.append(at_bound)
        self.end = search.end_at_bound(bound)
        return True

    def _fold_outside(self, before: CurvePoint, new: CurvePoint) -> CurvePoint | None:
        """The fold between two points if it is outside the span; where both are clearly within, it
        is not even located."""
        search = self.search
        rising = before.slope > 0
        outermost = max(before.value, new.value) if rising else min(before.value, new.value)
        margin = float(np.linalg.norm(new.z - before.z))
        if search.low + margin < outermost < search.high - margin:
            return None
        try:
            fold = special.locate_fold(search.tracer, before, new)
        except Unlocated:
            return None
        return None if search.low <= fold.value <= search.high else fold

    def _repeats(self, before: CurvePoint, new: CurvePoint) -> bool:
        """Whether the curve between two neighbours is one that has been followed before."""
        candidates = self.search.trace.beside(before, new)
        return any(self.search.passes(before, new, point) for point in candidates)

    def _stops(self, before: CurvePoint, new: CurvePoint) -> bool:
        """Whether a special point at which the branch shall stop is between two neighbours."""
        if not self.search.stop_at:
            return False
        try:
            found = special.locate_between(self.search.tracer, before, new)
        except Unlocated:
            return True
        return any(place.kind in self.search.stop_at for place in found)


class _Trace:
    """The points followed so far, in an array that grows."""

    def __init__(self, width: int) -> None:
        self.places = np.empty((64, width))
        self.points = list[CurvePoint]()

    def add(self, point: CurvePoint) -> None:
        """Add a point at the end."""
        if len(self.points) == len(self.places):
            self.places = np.concatenate([self.places, np.empty_like(self.places)])
        self.places[len(self.points)] = point.z
        self.points.append(point)

    def beside(self, before: CurvePoint, after: CurvePoint) -> list[CurvePoint]:
        """The points beside the chord between two neighbours, without these themselves."""
        chord = after.z - before.z
        away = self.places[: len(self.points)] - before.z
        shares = away @ chord / (chord @ chord)
        candidates = np.flatnonzero((shares > 0) & (shares <= 1))
        distances = np.linalg.norm(away[candidates] - np.outer(shares[candidates], chord), axis=1)
        near = candidates[distances < BESIDE * np.linalg.norm(chord)]
        return [self.points[i] for i in near if self.points[i] is not before]


def _is_beside(place: Located, end: CurvePoint) -> bool:
    """Whether a special point is so near to a Hopf point that the parameter, which changes with the
    square of the distance, changes by its rounding."""
    return bool(np.linalg.norm(place.point.z - end.z) < BESIDE_HOPF)


def _margin(value: float) -> float:
    """Largest difference of scaled values that count as equal."""
    return SAME_VALUE * max(1.0, abs(value))


def _shares(before: CurvePoint, after: CurvePoint, value: float) -> list[float]:
    """The shares of the way between two neighbours at which the cubic between them has a value of
    the parameter, ascending, in (0, 1]."""
    length = float(np.linalg.norm(after.z - before.z))
    change = after.value - before.value
    start = length * before.slope
    end = length * after.slope
    cubic = [start + end - 2 * change, 3 * change - 2 * start - end, start, before.value - value]
    roots = np.roots(cubic)
    real = roots.real[np.abs(roots.imag) < 1e-9]
    return sorted(float(root) for root in real if 0 < root <= 1)
