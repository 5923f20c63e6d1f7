"""Sections of known motions, and the stages of a run."""

from __future__ import annotations

import numpy as np
import pytest

from disc_model.analysis.poincare import distinct_points, stages

PHASE = np.array([0, 1, 2, 1, 2, 0], dtype=np.int8)
TIME = np.arange(6.0)


def test_stages_before_and_after_the_first_separation() -> None:
    found = stages(TIME, PHASE, 1.5, 6.0)
    assert found.divided_by_separation
    assert list(np.flatnonzero(found.early)) == [0, 1]
    assert list(np.flatnonzero(found.later)) == [3, 5]
    assert list(np.flatnonzero(found.separated)) == [2, 4]


def test_stages_without_separation_are_halves() -> None:
    found = stages(TIME, np.zeros(6, dtype=np.int8), np.nan, 6.0)
    assert not found.divided_by_separation
    assert list(np.flatnonzero(found.early)) == [0, 1, 2]
    assert list(np.flatnonzero(found.later)) == [3, 4, 5]
    assert not found.separated.any()


@pytest.mark.parametrize("period", [1, 2, 5])
def test_a_periodic_motion_has_as_many_points(period: int) -> None:
    angle = 2 * np.pi * np.arange(500) / period
    points = np.column_stack([np.cos(angle), 30 * np.sin(angle)]) + 1e-5
    assert distinct_points(points) == period


def test_a_quasi_periodic_motion_has_a_curve_of_points() -> None:
    angle = 2 * np.pi * 0.618034 * np.arange(3000)
    count = distinct_points(np.column_stack([np.cos(angle), np.sin(angle)]))
    assert 150 < count < 400


def test_a_cloud_has_more_points_than_a_curve() -> None:
    cloud = np.random.default_rng(0).random((3000, 2))
    assert distinct_points(cloud) > 1000


def test_no_points() -> None:
    assert distinct_points(np.empty((0, 2))) == 0
