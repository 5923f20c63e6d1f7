"""Sections of known motions, and the stages of a run."""

import numpy as np
import pytest

from disc_model.analysis.classify import distinct_points, first_settled, stages

PHASE = np.array([0, 1, 2, 1, 2, 0], dtype=np.int8)
TIME = np.arange(6.0)


def test_stages_before_and_after_the_first_separation() -> None:
    found = stages(TIME, PHASE, 1.5, 6.0)
    assert found.divided_by_separation
    assert list(np.flatnonzero(found.early)) == [0, 1]
    assert list(np.flatnonzero(found.later)) == [3, 5]
    assert list(np.flatnonzero(found.separated)) == [2, 4]


def test_stages_without_separation_tell_what_has_settled() -> None:
    found = stages(TIME, np.zeros(6, dtype=np.int8), np.nan, 3.0)
    assert not found.divided_by_separation
    assert list(np.flatnonzero(found.early)) == [0, 1, 2]
    assert list(np.flatnonzero(found.later)) == [3, 4, 5]
    assert not found.separated.any()
    assert stages(TIME, np.zeros(6, dtype=np.int8), np.nan, np.nan).early.all()


def around(turns: float, count: int) -> np.ndarray:
    """Points of an ellipse, so many turns apart."""
    angle = 2 * np.pi * turns * np.arange(count)
    return np.column_stack([np.cos(angle), 30 * np.sin(angle)]) + 1e-5


@pytest.mark.parametrize(
    ("points", "least", "most"),
    [
        (np.empty((0, 2)), 0, 0),
        *((around(1 / period, 500), period, period) for period in (1, 2, 5)),
        (around(0.618034, 3000), 151, 399),
        (np.random.default_rng(0).random((3000, 2)), 1001, 3000),
    ],
    ids=["none", "period 1", "period 2", "period 5", "closed curve", "cloud"],
)
def test_a_section_has_as_many_points_as_its_motion_shows(points: np.ndarray, least: int, most: int) -> None:
    assert least <= distinct_points(points) <= most


def test_a_decaying_transient_does_not_lie_on_the_curve_on_which_it_ends() -> None:
    curve, turns = around(0.618034, 3000), np.arange(3000)
    spiral = (1 + 0.5 * np.exp(-turns / 100))[:, None] * curve
    # 0.5 exp(-t) falls to the tolerance between 0.01 of the curve's width and 0.01 of its radius, two and one
    assert 100 * np.log(0.5 / 0.02) - 50 < first_settled(spiral) <= 100 * np.log(0.5 / 0.01)
    assert first_settled(curve) == 0
    assert first_settled(spiral, 2000) == 2000
