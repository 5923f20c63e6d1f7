"""Speeds of separation along their branches."""

from __future__ import annotations

import numpy as np

from disc_model.figures.grids.separating import branches


def test_a_line_does_not_jump_to_another_branch() -> None:
    """The lowest speeds were joined, across speeds at which all stays quiet."""
    speeds = [np.array(at) for at in ([17.6], [11.5, 19.5], [12.7, 14.9, 21.3], [13.8, 15.9, 23.1], [])]
    links = [(0, 17.6, 19.5), (1, 11.5, 12.7), (1, 19.5, 21.3)]
    # 13.8 is as near to 12.7 as to 14.9, which is nearer to 15.9
    assert branches(speeds) == [*links, (2, 12.7, 13.8), (2, 14.9, 15.9), (2, 21.3, 23.1)]
