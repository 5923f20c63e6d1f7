"""Attracting tori, on maps of which they are known exactly."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.linalg import block_diag

from disc_model.stability.attractor.thresholds import TORUS_FURTHER
from disc_model.stability.attractor.torus import TorusTest
from disc_model.stability.return_map import RETURNED, Counts, Flight

PERIOD = 0.02


def rotation(angle: float) -> np.ndarray:
    return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])


class TurningMap:
    """As `ReturnMap`: the motion turns by an irrational share about the unit circle, and its distance from it changes
    at a known rate; two further coordinates turn and decay."""

    deflection = 1.0

    def __init__(self, rate: float, turn: float = (math.sqrt(5) - 1) / 2) -> None:
        self.factor, self.turn = math.exp(rate * PERIOD), 2 * math.pi * turn

    def evaluate(self, x: np.ndarray, *, releases: int, **_: Any) -> Flight:
        start, jacobian, decay = x, np.eye(4), 0.9 * rotation(1.0)
        for _ in range(releases):
            radius, angle = math.hypot(x[0], x[1]), math.atan2(x[1], x[0])
            new = 1 + (radius - 1) * self.factor
            turned = rotation(angle + self.turn)
            step = turned @ np.diag([self.factor, new / radius]) @ rotation(-angle)
            jacobian = block_diag(step, decay) @ jacobian
            x = np.concatenate([new * turned[:, 0], decay @ x[2:]])
        counts = Counts(releases, 0, 0, 0, releases)
        return Flight(RETURNED, releases * PERIOD, 0.0, counts, start, x, jacobian, np.zeros((4, 0)))

    def returns(self, x: np.ndarray, most: int, **_: Any) -> Iterator[np.ndarray]:
        for _ in range(most):
            x = self.evaluate(x, releases=1).end
            yield x


@pytest.mark.parametrize(
    ("rate", "radius", "shown"),
    [
        (-0.02, 1.0, True),
        (-0.02, 1.01, True),
        (-0.02, 1.05, False),  # too far away yet
        (-0.001, 1.0, False),  # too slow to be told from none
        (0.02, 1.0, False),
        (0.02, 1.01, False),
    ],
)
def test_an_attracting_torus_is_told_from_an_unstable_one(rate: float, radius: float, shown: bool) -> None:
    test = TorusTest(TurningMap(rate))  # type: ignore[arg-type]
    x = np.array([radius, 0.0, 0.0, 0.0])
    assert not test.shows_torus(x)  # nothing is steady at the first time
    # an inexact return mixes the directions: only a nearer one, of more releases, tells -0.02/s from 0
    assert any(test.shows_torus(x) for _ in range(2)) is shown


def test_a_motion_whose_returns_end_is_on_no_torus() -> None:
    class Ends(TurningMap):
        def returns(self, x: np.ndarray, most: int, **_: Any) -> Iterator[np.ndarray]:
            return super().returns(x, min(most, TORUS_FURTHER - 1))

    x = np.array([1.0, 0.0, 0.0, 0.0])
    for map_, shown in ((TurningMap(-0.02), True), (Ends(-0.02), False)):
        test = TorusTest(map_)  # type: ignore[arg-type]
        assert [test.shows_torus(x) for _ in range(3)] == [False, False, shown]


def test_chaos_is_no_torus() -> None:
    # the positive exponent of Hénon's map is 0.42 an iteration
    class Henon(TurningMap):
        def evaluate(self, x: np.ndarray, *, releases: int, **_: Any) -> Any:
            flight, jacobian = super().evaluate(np.eye(4)[0], releases=releases), np.eye(4)
            for _ in range(releases):
                jacobian = block_diag([[-2.8 * x[0], 1.0], [0.3, 0.0]], 0.5, 0.5) @ jacobian
                x = np.array([1 - 1.4 * x[0] ** 2 + x[1], 0.3 * x[0], 0.5 * x[2], 0.5 * x[3]])
            return replace(flight, end=x, jacobian=jacobian)

    test = TorusTest(Henon(0.0))  # type: ignore[arg-type]
    x = list(test.map.returns(np.array([0.1, 0.1, 0.0, 0.0]), 100))[-1]
    assert not any(test.shows_torus(x) for _ in range(3))
