"""Poincare sections at the drive's period: stages of a run, and the number of distinct points of a section.

The section is stroboscopic: one sample every 2 pi/Omega. A motion whose period is n drive periods shows n
points, a quasi-periodic one a closed curve, an irregular one a cloud.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.data.variables import PHASES

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
SEPARATION = PHASES.index("separation")
SAME = 0.01
"""Share of the range, along every axis, within which two points count as one."""


class Stages(NamedTuple):
    """Masks over the samples of a run: in contact early, in contact later, separated. Each sample is in one of them.

    The first separation divides early from later; without one, the time from which the motion has settled does.
    """

    early: Mask
    later: Mask
    separated: Mask
    divided_by_separation: bool


def stages(time: Array, phase: NDArray[np.int8], first_separation: float, settled_since: float) -> Stages:
    """Divide a run into the stages that the paper distinguishes by colour.

    Parameters
    ----------
    time : s, shape (n,)
    phase : shape (n,), index into `disc_model.data.variables.PHASES`
    first_separation : s, nan if there was none
    settled_since : s, nan if it is not shown that the motion has settled: then all samples in contact are early
    """
    divided = math.isfinite(first_separation)
    before = np.asarray(~(time >= (first_separation if divided else settled_since)))
    apart = np.asarray(phase == SEPARATION)
    return Stages(before & ~apart, ~before & ~apart, apart, divided)


def distinct_points(points: Array, extent: Array | None = None) -> int:
    """Count the distinct points of a section, by a greedy search.

    Points within `SAME` of each other count as one. A chain of near points is not merged, so that a closed curve has
    about 1/`SAME` points.

    Parameters
    ----------
    points : shape (n, d)
    extent : shape (d,), units in which the coordinates are measured; by default the range of each
    """
    points = np.asarray(points, dtype=float)
    if points.size == 0:
        return 0
    extent = np.ptp(points, axis=0) if extent is None else extent
    rounding = 1e-9 * np.max(np.abs(points))  # bound for axes along which only rounding changes the points
    scaled = np.where(extent > rounding, (points - points.min(axis=0)) / np.where(extent > 0, extent, 1.0), 0.0)
    centres: list[Array] = []
    for point in scaled:
        if not centres or np.min(np.max(np.abs(np.array(centres) - point), axis=1)) > SAME:
            centres.append(point)
    return len(centres)
