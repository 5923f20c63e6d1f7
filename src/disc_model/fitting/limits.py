"""Limits of a parameter on one side, where a bound that no case can pass is within its interval on the other.

Chi squared rises from its least value within the bound by ``slope * d + d**2 / variance`` over a distance d from the
bound, if predictions are linear and the other parameters follow. The limit is where it has risen by z^2, z being the
quantile of the confidence. It lies beyond the true value in at least this share of measurements, and in more if the
true value is near the bound."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from disc_model.arrays import Array

RISE = (0.8, 3.0)
"""Rise of chi squared up to a limit over that of linear predictions; beyond these no limit is given."""


def limit_beyond(
    search: Any,
    covariance: Array,
    i: int,
    side: int,
    confidence: float,
    deviations: Callable[[Array], Array],
) -> float:
    """The limit of a scaled parameter; nan if predictions are not linear, or missing, up to it.

    Parameters
    ----------
    search : at its end, over scaled parameters
    covariance : of these
    i : number of the parameter
    side : 1 for an upper limit, -1 for a lower one
    confidence : share of measurements in which the limit lies beyond the true value
    deviations : over the scaled parameters
    """
    from scipy import stats

    rise = float(stats.norm.ppf(confidence)) ** 2
    variance = float(covariance[i, i])
    slope = max(side * 2 * float(search.jac[:, i] @ search.fun), 0.0)
    root = math.sqrt(slope**2 + 4 * rise / variance)
    distance = 0.5 * variance * (root - slope)
    moved = deviations(search.x + side * distance * covariance[:, i] / variance)
    risen = float(moved @ moved) - float(search.fun @ search.fun)
    if not RISE[0] * rise <= risen <= RISE[1] * rise:
        return math.nan
    return float(search.x[i] + side * distance)
