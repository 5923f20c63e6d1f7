"""The cycles along a branch in one parameter, from point to point.

A step is accepted only if nothing suggests a jump to another branch or another part of this one:
the corrector stays near the prediction, both points lie on one smooth curve, the orientation and
the order of events are the same, and no resonance has passed unseen.  Where a multiplier passes 1,
the cycle may respond by a peak that is much narrower than a step, with folds on its flanks; where
two others resonate, it may be unstable within a narrow tongue.  So a point is computed on each
resonance, and must lie where the step leads to expect it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product

import numpy as np
from scipy.optimize import brentq

from disc_model.stability.continuation.curve import (
    DRIFT,
    FARTHEST,
    CurvePoint,
    Guess,
    Rejected,
    StepControl,
    check_step,
    curve_point,
    interpolate,
    predict,
    solve,
)
from disc_model.stability.continuation.problem import CycleProblem, has_own_vibration
from disc_model.stability.continuation.spectrum import Passing, passings, turns_between
from disc_model.stability.return_map import Array

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
# distance within which a point of the curve is anywhere on a compliant contact: a stiff one's own
# vibration has bends of that size, and rounding moves points by a tenth of it
SLACK = 1e-6
HALVINGS_OF_CORNER = 3  # of such a step, on each of which a branch point leaves the curve smooth
# A stiff contact's own vibration has peaks that are narrower than any step. Where even the shortest
# step fails, the branch is sought behind them, at these distances.
LEAPS = tuple(1e-5 * 2.0**i for i in range(10))
AT_BRANCH_POINT = 1e-3  # distance of the critical multiplier from one at such a step's ends
BEHIND = (0.5, 4.0, np.inf)  # distances of the points from which it is expected there, over these
PRECISION = 1e-11  # of the share of a step at which a point is located
EVEN = 0.5  # least slope over the largest one, of a curve without folds between two points
STEEP = 0.1  # slope of the tangent above which a step ends at a given parameter, so that one map serves it


class BranchTracer:
    """Steps along the curve of a `CycleProblem` in one parameter, which end at the scaled bounds
    `low` and `high` of the parameter where they would pass them."""

    def __init__(
        self, problem: CycleProblem, steps: StepControl, low: float = -np.inf, high: float = np.inf
    ) -> None:
        self.problem = problem
        self.steps = steps
        self.slack = SLACK if has_own_vibration(problem.base) else 0.0
        self.low = low
        self.high = high
        self.behind = list[CurvePoint]()  # points of the branch before its start, if it has some

    def advance(self, points: Sequence[CurvePoint], ds: float) -> list[CurvePoint]:
        """The points of a step of arclength ds beyond the last of some, resonances within it
        included; raises `Rejected` if a shorter step is needed."""
        try:
            return self._step(points, ds)
        except Rejected:
            ahead = None
            if ds / 2 < self.steps.shortest:
                ahead = self._leap(points)
            if ahead is None:
                raise
            return [ahead]

    def _step(self, points: Sequence[CurvePoint], ds: float) -> list[CurvePoint]:
        """As `advance`, by a step of this length."""
        current = points[-1]
        former = None
        if len(points) > 1:
            former = points[-2]
        guess = predict(former, current, ds)
        row = _plane(current.tangent)
        value = float(guess.z[-1])
        bound = min(max(value, self.low), self.high)
        if bound != value:
            ds *= (bound - current.value) / (value - current.value)
            guess = predict(former, current, ds)
            guess.z[-1] = bound
            row = parameter_row(len(row), current.slope)
        ahead = self._solve(guess, current, row, FARTHEST * ds)
        if ds > CORNER and np.linalg.norm(ahead.z - guess.z) > DRIFT * ds + self.slack:
            raise Rejected("the corrector moves far")
        self._check(current, ahead)
        return [*self._resonances(current, ahead, DEEPEST), ahead]

    def _leap(self, points: Sequence[CurvePoint]) -> CurvePoint | None:
        """A point on the branch beyond a peak that is too small to be followed, as those of a stiff
        contact's own vibration; None if there is none. It lies where the points before the peak
        lead to expect it, and has their order of events."""
        if not self.slack:
            return None
        for distance, behind in product(LEAPS, BEHIND):
            try:
                return self._beyond_peak(points, distance, behind * distance)
            except Rejected:
                continue
        return None

    def _beyond_peak(
        self, points: Sequence[CurvePoint], distance: float, behind: float
    ) -> CurvePoint:
        """The point at a distance beyond the last of some, predicted from those that are at least as
        far `behind` it; raises `Rejected` if it is another branch's."""
        last = points[-1]
        known = [*self.behind, *points]
        current = _farther(known, last, behind)
        former = _farther(known, current, behind)
        ds = distance + float(np.linalg.norm(last.z - current.z))
        guess = predict(former if former is not current else None, current, ds)
        if not self.low <= guess.z[-1] <= self.high:
            raise Rejected("the branch leaves the bounds")
        row = _plane(current.tangent)
        ahead = self._solve(guess, current, row, FARTHEST * ds)
        if np.linalg.norm(ahead.z - guess.z) > max(PEAK * ds, SMALLEST_PEAK):
            raise Rejected("the branch has a peak")
        check_step(current, ahead, self.steps.sharpest, slack=self.slack)
        if ahead.orientation != last.orientation or ahead.orbit.counts != last.orbit.counts:
            raise Rejected("the orientation of the curve changes")
        return ahead

    def between(self, before: CurvePoint, after: CurvePoint, share: float) -> CurvePoint:
        """The point of the curve at a share of the way between two neighbours."""
        guess = interpolate(before, after, share)
        return self._near(before, after, guess, _plane_between(before, after))

    def at_value(
        self, before: CurvePoint, after: CurvePoint, value: float, share: float
    ) -> CurvePoint | None:
        """The point of the curve between two neighbours with a given scaled value of the parameter,
        which the cubic between them has at a share of the way; None if it cannot be computed."""
        guess = interpolate(before, after, share)
        guess.z[-1] = value
        row = parameter_row(len(guess.z), after.value - before.value)
        try:
            return self._near(before, after, guess, row)
        except Rejected:  # as beside a fold
            return self.locate(before, after, lambda point: point.value - value)

    def locate(
        self, before: CurvePoint, after: CurvePoint, test: Callable[[CurvePoint], float]
    ) -> CurvePoint | None:
        """The point between two neighbours where a test function vanishes; None if it has the same
        sign at both, or the curve cannot be followed to the point."""
        known = {0.0: before, 1.0: after}

        def value(share: float) -> float:
            if share not in known:
                known[share] = self.between(before, after, share)
            return test(known[share])

        if value(0.0) * value(1.0) > 0:
            return None
        try:
            root = float(brentq(value, 0.0, 1.0, xtol=PRECISION, rtol=4 * np.finfo(float).eps))
            return known.get(root) or self.between(before, after, root)
        except Rejected:
            return None

    def _near(self, before: CurvePoint, after: CurvePoint, guess: Guess, row: Array) -> CurvePoint:
        length = float(np.linalg.norm(after.z - before.z))
        found = self._solve(guess, before, row, max(FARTHEST * length, 1e-6))
        chord = after.z - before.z
        return found if float(found.tangent @ chord) >= 0 else found.reversed()

    def _solve(self, guess: Guess, nearby: CurvePoint, row: Array, radius: float) -> CurvePoint:
        """The point of the curve in the plane through a guess, with the sense of a point nearby."""
        z, found = solve(
            self.problem, guess.z, row[None, :], np.vstack([guess.by, row]), radius + self.slack
        )
        point = curve_point(z, found, row)
        same_sense = float(point.tangent @ nearby.tangent) >= 0
        return point if same_sense else point.reversed()

    def _check(self, before: CurvePoint, after: CurvePoint) -> None:
        """Raise `Rejected` unless two points are neighbours on one part of the branch."""
        if np.linalg.norm(after.z - before.z) <= CORNER:
            check_step(before, after, self.steps.sharpest, FARTHEST, self.slack)
            turned = after.orientation != before.orientation
            if self.slack and turned and after.orbit.counts == before.orbit.counts:
                self._check_branch_point(before, after)
            return
        check_step(before, after, self.steps.sharpest, slack=self.slack)
        if after.orientation != before.orientation:
            raise Rejected("the orientation of the curve changes")
        if after.orbit.counts != before.orbit.counts:
            raise Rejected(order_change(before, after))

    def _check_branch_point(self, before: CurvePoint, after: CurvePoint) -> None:
        """Raise `Rejected` unless the curve is smooth between two neighbours of opposite
        orientation, and a real multiplier passes one, as at a branch point: beside a fold that is
        narrower than a step, they are on two parts of the curve."""
        for _ in range(HALVINGS_OF_CORNER):
            middle = self.between(before, after, 0.5)
            check_step(before, middle, self.steps.sharpest)
            check_step(middle, after, self.steps.sharpest)
            if middle.orientation == before.orientation:
                before = middle
            else:
                after = middle
        for point in (before, after):
            distances = np.abs(point.spectrum.values - 1)
            critical = point.spectrum.values[np.argmin(distances)]
            if critical.imag != 0 or abs(critical - 1) > AT_BRANCH_POINT:
                raise Rejected("the orientation of the curve changes")

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
        there = self._solve(expected, before, _plane(before.tangent), FARTHEST * length)
        if np.linalg.norm(there.z - expected.z) > max(PEAK * length, SMALLEST_PEAK):
            raise Rejected("the branch has a peak within the step")
        self._check(before, there)
        self._check(there, after)
        return [
            *self._resonances(before, there, deepest - 1),
            there,
            *self._resonances(there, after, deepest - 1),
        ]


def _farther(points: Sequence[CurvePoint], last: CurvePoint, distance: float) -> CurvePoint:
    """The last of some points that is at least at a distance from one of them and before it; the
    first of all if there is none."""
    for point in reversed(points):
        behind = float((last.z - point.z) @ point.tangent)
        if behind >= distance:
            return point
    return points[0]


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


def parameter_row(width: int, sense: float) -> Array:
    """The unit vector of the parameter, which is the last of `width` entries, with the sign of
    `sense`."""
    row = np.zeros(width)
    row[-1] = 1.0 if sense >= 0 else -1.0
    return row


def _unseen(passed: list[Passing]) -> list[Passing]:
    """Those resonances within a step that neither of its ends is near enough to show: all forced
    ones and, of the others, those of the least damped multipliers."""
    hidden = [each for each in passed if each.distance > RESONANT * max(each.width, NARROWEST)]
    others = sorted(each.width for each in hidden if not each.forced)
    widest = others[MOST_TONGUES - 1] if len(others) > MOST_TONGUES else np.inf
    return [each for each in hidden if each.forced or each.width <= widest]


def order_change(before: CurvePoint, after: CurvePoint) -> str:
    """How the numbers of events differ between two points, in words."""
    changes = []
    for name, first, second in zip(
        before.orbit.counts._fields, before.orbit.counts, after.orbit.counts, strict=True
    ):
        if first != second:
            changes.append(f"{name.replace('_', ' ')} {first} to {second}")
    return f"the order of events changes: {', '.join(changes)}"
