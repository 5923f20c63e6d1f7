"""Special points of a branch in one parameter: folds, period doublings, Neimark-Sacker
bifurcations, changes of the order of events, and branch points.

Between two neighbouring points a test function changes sign, and its root along the curve is
located to rounding.  A pair of folds within a step leaves the sign of the slope unchanged; it is
found because the slope nearly vanishes there.  Stability that changes twice within a step is found
because the leading multiplier is nearly neutral.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from disc_model.stability.continuation.curve import CurvePoint, Rejected
from disc_model.stability.continuation.problem import growth_rate
from disc_model.stability.continuation.spectrum import follow_multipliers
from disc_model.stability.continuation.tracing import BranchTracer

FOLD = "fold"
PERIOD_DOUBLING = "period_doubling"
NEIMARK_SACKER = "neimark_sacker"
GRAZING = "grazing"
BRANCH_POINT = "branch_point"
ON_CIRCLE = 1e-6  # largest difference of a critical multiplier's modulus from one
NEARLY_FOLDED = (
    0.5  # least value between three points, over that of the middle one, that is looked at
)
MOST_REFINEMENTS = 4  # of the points round a slope that nearly vanishes
# change of the growth rate within a step, over the larger one, that a straight line shows well
# enough, and a step that is short enough whatever the change
LITTLE_CHANGE = 0.2
SHORT_STEP = 0.01
# least distance of the leading multiplier's modulus from one at both ends of a step, over its largest
# change in that step and its neighbours, at which stability may change twice within the step
NEARLY_NEUTRAL = 0.5


class Located(NamedTuple):
    """A special point: its kind, the point of the curve, the critical multiplier, and the number of
    the point of the branch before it."""

    kind: str
    point: CurvePoint
    multiplier: complex
    after: int


class Unlocated(Rejected):
    """A special point that is between two points of a branch, and cannot be computed."""


def locate_between(
    tracer: BranchTracer, before: CurvePoint, after: CurvePoint, number: int = 0
) -> list[Located]:
    """The special points between two neighbours of a branch, in their order; the first of the two
    has this number. Raises `Unlocated` if a fold between them cannot be computed."""
    found = [Located(*special, number) for special in _between(tracer, before, after)]
    return sorted(found, key=lambda special: float((special.point.z - before.z) @ before.tangent))


def _between(
    tracer: BranchTracer, before: CurvePoint, after: CurvePoint
) -> Iterator[tuple[str, CurvePoint, complex]]:
    """The special points between two neighbours."""
    folded = before.slope * after.slope < 0
    if after.orbit.counts != before.orbit.counts:
        yield GRAZING, before, leading(before)
        return
    knots = [before, after]
    if folded:
        fold = locate_fold(tracer, before, after)
        knots.insert(1, fold)
        yield FOLD, fold, 1.0 + 0j
    elif before.orientation != after.orientation:
        yield BRANCH_POINT, before, 1.0 + 0j
    if _doubling_test(before) * _doubling_test(after) < 0:
        doubled = tracer.locate(before, after, _doubling_test)
        if doubled is not None:
            critical = nearest(doubled, -1.0 + 0j)
            if abs(critical + 1) < ON_CIRCLE:
                yield PERIOD_DOUBLING, doubled, critical
    # a pair that crosses the circle before a fold often is two real multipliers at the fold
    for first, last in pairwise(knots):
        yield from _neimark_sackers(tracer, first, last)


def locate_fold(tracer: BranchTracer, before: CurvePoint, after: CurvePoint) -> CurvePoint:
    """The fold between two neighbours, where the tangent has no component along the parameter;
    raises `Unlocated` if it cannot be computed."""
    fold = tracer.locate(before, after, lambda point: point.slope)
    if fold is None:
        raise Unlocated(f"near {tracer.problem.words(before)}")
    return fold


def _doubling_test(point: CurvePoint) -> float:
    """det (J + I), which changes sign where a real multiplier passes -1; without the factors of
    multipliers that are far away."""
    factors = 1 + point.spectrum.values
    return float(np.prod(factors / np.maximum(np.abs(factors), 1.0)).real)


def _neimark_sackers(
    tracer: BranchTracer, before: CurvePoint, after: CurvePoint
) -> Iterator[tuple[str, CurvePoint, complex]]:
    """The points between two neighbours where a pair of complex multipliers crosses the unit
    circle."""
    for follower in _crossing_pairs(before, after):
        point = tracer.locate(before, after, follower.excess)
        if point is None:
            continue
        critical = follower.multiplier(point)
        if abs(abs(critical) - 1) < ON_CIRCLE and critical.imag != 0:
            yield NEIMARK_SACKER, point, complex(critical.real, abs(critical.imag))


def _crossing_pairs(before: CurvePoint, after: CurvePoint) -> Iterator[_Follower]:
    """The pairs that are complex at one of two neighbours at least, and may have crossed the unit
    circle at the other."""
    successors = follow_multipliers(before.spectrum, after.spectrum)
    for i, multiplier in enumerate(before.spectrum.values):
        j = int(successors[i])
        successor = complex(after.spectrum.values[j])
        if multiplier.imag > 0 and successor.imag != 0:
            if (abs(multiplier) - 1) * (abs(successor) - 1) < 0:
                yield _Follower(before, i)
        elif multiplier.imag > 0:
            yield _Follower(before, i)
        elif multiplier.imag == 0 and successor.imag > 0:
            yield _Follower(after, j)


class _Follower:
    """The multiplier of a point that continues the i-th one of another, which is complex."""

    def __init__(self, start: CurvePoint, i: int) -> None:
        self.start = start
        self.i = i
        values = start.spectrum.values
        self.conjugate = int(np.argmin(np.abs(values - values[i].conjugate())))

    def multiplier(self, point: CurvePoint) -> complex:
        return self._successor(point, self.i)

    def _successor(self, point: CurvePoint, i: int) -> complex:
        """The multiplier of another point that continues the i-th one."""
        j = follow_multipliers(self.start.spectrum, point.spectrum)[i]
        return complex(point.spectrum.values[j])

    def excess(self, point: CurvePoint) -> float:
        """By how much its modulus exceeds one; the mean modulus of both multipliers where the pair
        has become two real ones."""
        followed = self.multiplier(point)
        if followed.imag != 0:
            return abs(followed) - 1
        other = self._successor(point, self.conjugate)
        return abs(followed * other) ** 0.5 - 1


def nearest(point: CurvePoint, value: complex) -> complex:
    """The multiplier nearest to a value."""
    values = point.spectrum.values
    return complex(values[np.argmin(np.abs(values - value))])


def leading(point: CurvePoint) -> complex:
    """The multiplier of largest modulus; 0 on a section of a single point."""
    values = point.spectrum.values
    if not values.size:
        return 0j
    return complex(values[np.argmax(np.abs(values))])


# ---- Pairs of special points within a step


def reveal_folds(tracer: BranchTracer, points: Sequence[CurvePoint]) -> list[CurvePoint]:
    """The points of a branch and, between them, one where the slope has the other sign, wherever a
    pair of folds hides within a step."""
    revealed = {}
    for i in range(1, len(points) - 1):
        point = _hidden_change(tracer, list(points[i - 1 : i + 2]), lambda point: point.slope)
        if point is not None:
            behind = float((point.z - points[i].z) @ points[i].tangent) < 0
            revealed[i - 1 if behind else i] = point
    complete = list[CurvePoint]()
    for i, point in enumerate(points):
        complete.append(point)
        if i in revealed:
            complete.append(revealed[i])
    return complete


def reveal_growth(tracer: BranchTracer, points: Sequence[CurvePoint]) -> list[CurvePoint]:
    """The points of a branch and, within long steps in which the growth rate changes much, further
    ones: a straight line from point to point would show it wrong."""
    complete = list(points[:1])
    for before, after in pairwise(points):
        complete += _of_other_growth(tracer, before, after)
        complete.append(after)
    return complete


def _of_other_growth(
    tracer: BranchTracer, before: CurvePoint, after: CurvePoint
) -> list[CurvePoint]:
    """The points that `reveal_growth` adds between two neighbours."""
    first = _growth(before)
    last = _growth(after)
    little = abs(last - first) <= LITTLE_CHANGE * max(abs(first), abs(last))
    length = float(np.linalg.norm(after.z - before.z))
    if little or length <= SHORT_STEP or before.orbit.counts != after.orbit.counts:
        return []
    if not (math.isfinite(first) and math.isfinite(last)):
        return []
    try:
        middle = tracer.between(before, after, 0.5)
    except Rejected:
        return []
    earlier = _of_other_growth(tracer, before, middle)
    later = _of_other_growth(tracer, middle, after)
    return [*earlier, middle, *later]


def _growth(point: CurvePoint) -> float:
    """The growth rate of a point's cycle, 1/s."""
    return growth_rate(leading(point), point.orbit.period)


def reveal_stability(tracer: BranchTracer, points: Sequence[CurvePoint]) -> list[CurvePoint]:
    """The points of a branch and, between them, one of the other stability, wherever it changes
    twice within a step and the leading multiplier suggests so."""
    excess = np.array([_leading_excess(point) for point in points])
    changes = np.abs(np.diff(excess))
    complete = list(points[:1])
    for i, (before, after) in enumerate(pairwise(points)):
        largest = changes[max(i - 1, 0) : i + 2].max()
        nearly = np.abs(excess[i : i + 2]).min() < NEARLY_NEUTRAL * largest
        if nearly and excess[i] * excess[i + 1] > 0:
            point = _hidden_stability(tracer, before, after)
            if point is not None:
                complete.append(point)
        complete.append(after)
    return complete


def _hidden_stability(
    tracer: BranchTracer, before: CurvePoint, after: CurvePoint
) -> CurvePoint | None:
    """A point between two neighbours of one stability that has the other one, if it is found."""
    if before.orbit.counts != after.orbit.counts:
        return None
    try:
        middle = tracer.between(before, after, 0.5)
    except Rejected:
        return None
    if _leading_excess(middle) * _leading_excess(before) < 0:
        return middle
    return _hidden_change(tracer, [before, middle, after], _leading_excess)


def _leading_excess(point: CurvePoint) -> float:
    """By how much the modulus of the leading multiplier exceeds one."""
    return abs(leading(point)) - 1


def _hidden_change(
    tracer: BranchTracer, three: list[CurvePoint], test: Callable[[CurvePoint], float]
) -> CurvePoint | None:
    """The point between three neighbours at which a test function differs from theirs in sign, if a
    parabola through its values suggests one and it exists."""
    sign = math.copysign(1.0, test(three[1]))
    for _ in range(MOST_REFINEMENTS):
        values = [sign * test(point) for point in three]
        if not 0 < values[1] < min(values[0], values[2]):
            return None
        lengths = [float(np.linalg.norm(b.z - a.z)) for a, b in pairwise(three)]
        place, least = _least_of_parabola(lengths, values)
        if least > NEARLY_FOLDED * values[1]:
            return None
        if place < 0:
            before = three[0]
            after = three[1]
            share = 1 + place / lengths[0]
        else:
            before = three[1]
            after = three[2]
            share = place / lengths[1]
        if not 1e-3 < share < 1 - 1e-3:
            return None
        try:
            there = tracer.between(before, after, share)
        except Rejected:
            return None
        if sign * test(there) < 0:
            return there
        middle = three[1].tangent
        four = sorted([*three, there], key=lambda point: float(point.z @ middle))
        lowest = min((1, 2), key=lambda i: sign * test(four[i]))
        three = four[lowest - 1 : lowest + 2]
    return None


def _least_of_parabola(lengths: Sequence[float], values: Sequence[float]) -> tuple[float, float]:
    """Place, from the middle point, and least value of the parabola through three points at
    distances `lengths`, whose middle value is the smallest."""
    behind = (values[0] - values[1]) / lengths[0]
    ahead = (values[2] - values[1]) / lengths[1]
    curvature = (behind + ahead) / (lengths[0] + lengths[1])
    slope = ahead - curvature * lengths[1]
    place = -slope / (2 * curvature)
    return place, values[1] + slope * place / 2
