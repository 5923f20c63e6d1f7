"""What a continuation has found, as a `Branch` in SI units."""

from collections.abc import Sequence

import numpy as np

from disc_model.stability.continuation import ends, special
from disc_model.stability.continuation.arguments import ROUNDING
from disc_model.stability.continuation.branch import Branch
from disc_model.stability.continuation.course import SAME_VALUE, Course
from disc_model.stability.continuation.curve import CurvePoint
from disc_model.stability.continuation.problem import CycleProblem, growth_rate
from disc_model.stability.continuation.special_point import SpecialPoint
from disc_model.stability.cycle import multipliers

SHOWN_ENDS = (ends.GRAZED, ends.HOPF, ends.DOUBLED, ends.MOST_POINTS, ends.LOST)
"""Ends that are special points of a kind of their own."""


def branch_of(
    problem: CycleProblem, course: Course, exact: Sequence[float] = (), wanted: Sequence[float] = ()
) -> Branch:
    """The branch of a course, in SI units. Values of the parameter that scaling has moved by its
    rounding from one of some `exact` or `wanted` ones are these."""
    points = course.points
    values = np.array([point.z[problem.n :] * problem.scales for point in points])
    for value in (*exact, *wanted):
        values[np.abs(values - value) <= SAME_VALUE * abs(value)] = value
    every = [multipliers(point.jacobian) for point in points]
    period = np.array([point.orbit.period for point in points])
    stick_time = np.array([point.orbit.stick_time for point in points])
    growth = [growth_rate(each[0], time) for each, time in zip(every, period, strict=True)]
    rows = _special_points(problem, course)
    folds = [row.values for row in rows if row.kind == special.FOLD]
    reasons = [end.text for end in (course.first, course.last) if end is not None]
    return Branch(
        parameters=problem.names,
        values=values,
        period=period,
        stick_fraction=stick_time / period,
        growth_rate=np.array(growth),
        multipliers=np.array(every),
        diameters=np.array([problem.leading_diameters(point) for point in points]),
        separations=np.array([point.orbit.counts.separations for point in points]),
        releases=np.array([point.orbit.counts.releases for point in points]),
        points=np.array([problem.reference_point(point.z) for point in points]),
        folds=np.array(folds).reshape(-1, len(problem.names)),
        ended="; ".join(dict.fromkeys(reasons)),
        case=problem.base,
        special=rows,
        not_reached=_missed(values, wanted, ROUNDING * problem.scales[0]),
        _make_map=problem.make_map,
    )


def _missed(values: np.ndarray, wanted: Sequence[float], slack: float) -> np.ndarray:
    """Those of some wanted values from which all along a branch differ by more than a slack."""
    nearest = [np.abs(values - value).min() for value in wanted]
    return np.array(wanted, dtype=float)[np.array(nearest) > slack]


def _special_points(problem: CycleProblem, course: Course) -> tuple[SpecialPoint, ...]:
    """The special points of a course, its ends included, in their order."""
    places = list(course.special)
    last = len(course.points) - 1
    closed = course.last.kind == ends.CLOSED
    if not (closed or (course.first is not None and course.first.kind == ends.STOPPED)):
        places.insert(0, _end_of(course.first, course.points[0], 0))
    if not (closed or course.last.kind == ends.STOPPED):
        places.append(_end_of(course.last, course.points[-1], last))
    rows = []
    for place in places:
        z = place.point.z
        orbit = place.point.orbit
        values = z[problem.n :] * problem.scales
        case = problem.base.replace(**dict(zip(problem.names, values.tolist(), strict=True)))
        rows.append(
            SpecialPoint(
                kind=place.kind,
                values=values,
                period=orbit.period,
                stick_fraction=orbit.stick_time / orbit.period,
                growth_rate=growth_rate(special.leading(place.point), orbit.period),
                multiplier=place.multiplier,
                after=place.after,
                case=case,
                modal=problem.reference_point(z) / problem.reference.scale,
                make_map=problem.make_map,
            )
        )
    return tuple(rows)


def _end_of(end: ends.End | None, point: CurvePoint, number: int) -> special.Located:
    """The end of a branch as a special point; without a reason it is the start."""
    kind = "end"
    if end is not None and end.kind in SHOWN_ENDS:
        kind = end.kind
    return special.Located(kind, point, special.leading(point), number)
