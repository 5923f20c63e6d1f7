"""Steps along a curve: where the next point is expected, how long steps are, and which are
refused."""

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

from disc_model.stability.continuation.curve import (
    CurvePoint,
    Rejected,
    StepControl,
    check_step,
    follow_curve,
    interpolate,
    predict,
)
from tests.refusals import refusal


def point(z: Any, tangent: Any) -> CurvePoint:
    blank: Any = None
    along = np.array(tangent, dtype=float)
    by = np.full((1, 2), float(z[0]))
    return CurvePoint(np.array(z, dtype=float), by, along, 1.0, blank, np.zeros((1, 1)))


EAST = point((0, 0), (1, 0))
NORTH = point((1, 1), (0, 1))


def test_between_two_points_lies_the_cubic_with_both_tangents() -> None:
    """At the middle the Hermite cubic has half of both places, and an eighth of the chord's length
    of both slopes."""
    found = interpolate(EAST, NORTH, 0.5)
    eighth = math.sqrt(2) / 8
    np.testing.assert_allclose(found.z, [0.5 + eighth, 0.5 - eighth], rtol=1e-14)
    np.testing.assert_allclose(found.by, 0.5)
    for share, end in ((0.0, EAST), (1.0, NORTH)):
        here = interpolate(EAST, NORTH, share)
        np.testing.assert_allclose(here.z, end.z, atol=1e-15)
        beside = (interpolate(EAST, NORTH, share + 1e-6).z - here.z) / 1e-6
        np.testing.assert_allclose(beside, math.sqrt(2) * end.tangent, atol=1e-5)


def test_a_step_is_predicted_on_the_cubic_unless_the_former_one_was_less_than_half_as_long() -> (
    None
):
    length = math.sqrt(2)
    np.testing.assert_allclose(
        predict(EAST, NORTH, 2 * length).z, interpolate(EAST, NORTH, 3.0).z, rtol=1e-14
    )
    ahead = predict(EAST, NORTH, 2.1 * length).z
    np.testing.assert_allclose(ahead, NORTH.z + 2.1 * length * NORTH.tangent, rtol=1e-14)
    np.testing.assert_allclose(predict(None, NORTH, 0.3).z, [1, 1.3])


def on_circle(angle: float) -> CurvePoint:
    return point((math.cos(angle), math.sin(angle)), (-math.sin(angle), math.cos(angle)))


def test_neighbours_on_a_circle_are_accepted_up_to_a_sharp_turn() -> None:
    start = on_circle(0.0)
    check_step(start, on_circle(0.4), sharpest=0.9)
    with pytest.raises(Rejected, match="too sharply"):
        check_step(start, on_circle(0.5), sharpest=0.9)  # cos 0.5 = 0.88
    # tangents that agree, on two lines beside each other
    with pytest.raises(Rejected, match="within the step"):
        check_step(EAST, point((1, 0.03), (1, 0)), sharpest=0.9)
    check_step(EAST, point((1, 0.01), (1, 0)), sharpest=0.9)
    check_step(EAST, point((1, 0.03), (1, 0)), sharpest=0.9, largest_defect=0.1)


def lengths_of_steps(
    advance: Any, most: int = 8, **steps: Any
) -> tuple[list[float], Rejected | None]:
    asked: list[float] = []

    def recorded(points: Any, ds: float) -> list[CurvePoint]:
        asked.append(ds)
        return [advance(points[-1], ds)]

    control = StepControl(max_points=most, **steps)
    _, rejected = follow_curve(EAST, recorded, control, lambda points: False)
    return asked, rejected


def straight(last: CurvePoint, ds: float) -> CurvePoint:
    return dataclasses.replace(last, z=last.z + ds * last.tangent)


def test_steps_grow_where_the_curve_is_straight_and_not_beyond_the_longest() -> None:
    asked, rejected = lengths_of_steps(straight, step=0.02, longest=0.1, growth=2.0)
    assert asked == pytest.approx([0.02, 0.04, 0.08, 0.1, 0.1, 0.1, 0.1])
    assert rejected is None


def test_steps_stay_where_the_curve_bends() -> None:
    def bends(last: CurvePoint, ds: float) -> CurvePoint:
        angle = math.atan2(last.tangent[1], last.tangent[0]) + 0.2  # cos 0.2 = 0.98
        return point(last.z, (math.cos(angle), math.sin(angle)))

    asked, _ = lengths_of_steps(bends, step=0.02, longest=0.1, easy=0.99)
    assert asked == pytest.approx([0.02] * 7)


def test_a_refused_step_is_halved_down_to_the_shortest() -> None:
    def refused(last: CurvePoint, ds: float) -> CurvePoint:
        raise Rejected("no")

    asked, rejected = lengths_of_steps(refused, step=0.02, shortest=0.004)
    assert asked == pytest.approx([0.02, 0.01, 0.005])
    assert str(rejected) == "no"


def test_a_watch_ends_a_curve_and_the_most_points_do() -> None:
    control = StepControl(max_points=5)
    points, _ = follow_curve(EAST, lambda p, ds: [straight(p[-1], ds)], control, lambda p: False)
    assert len(points) == 5
    points, _ = follow_curve(
        EAST, lambda p, ds: [straight(p[-1], ds)] * 2, control, lambda p: len(p) == 3
    )
    assert len(points) == 3


def test_steps_can_be_halved() -> None:
    with refusal(r"shortest=0\.5: must be at most step and longest"):
        StepControl(shortest=0.5)
