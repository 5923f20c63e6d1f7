"""Branches of the cycle over a plane: what is connected, and how it is named."""

from __future__ import annotations

import numpy as np

from disc_model.figures.grids.region_map import branches, named

# two columns of one cycle, a cut, and three of another one; nothing is followed at a corner
FOLLOWED = np.ones((4, 5), dtype=bool)
FOLLOWED[3, 4] = False
UP = np.ones((4, 5), dtype=bool)
UP[2, 4] = False
RIGHT = np.ones((4, 5), dtype=bool)
RIGHT[:, 1] = False
RIGHT[3, 3] = False


def test_points_that_go_on_into_each_other_are_one_branch() -> None:
    labels = branches(FOLLOWED, UP, RIGHT)
    assert (labels[:, :2] == 1).all()
    assert (labels[:3, 2:] == 0).all()
    assert labels[3].tolist() == [1, 1, 0, 0, -1]


def test_one_point_that_joins_makes_two_branches_one() -> None:
    right = RIGHT.copy()
    right[2, 1] = True
    assert set(branches(FOLLOWED, UP, right)[FOLLOWED]) == {0}


def test_the_last_row_and_column_go_on_into_nothing() -> None:
    """What is said of them there is of no next point."""
    up, right = np.zeros((2, 2), dtype=bool), np.zeros((2, 2), dtype=bool)
    up[-1], right[:, -1] = True, True
    assert sorted(branches(np.ones((2, 2), dtype=bool), up, right).ravel()) == [0, 1, 2, 3]


def test_large_branches_have_names_within_themselves() -> None:
    labels = branches(FOLLOWED, UP, RIGHT)
    places = {name: labels[row, column] for name, row, column in named(labels)}
    assert places == {"A": 0, "B": 1}
    many = np.arange(100).reshape(10, 10)  # a hundredth each
    assert not list(named(many))
