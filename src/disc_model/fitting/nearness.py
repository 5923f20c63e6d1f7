"""The minimum of chi squared that is nearest to the start in directions that the measurements do not determine.

There chi squared hardly changes, and a search ends anywhere, as at coefficients of friction above 1. It is done again
among parameters that differ from the start in determined directions only."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from disc_model.arrays import Array
from disc_model.fitting.determination import sensitivity_of

RISE = 3.84
"""Rise of chi squared up to which other values fit as well: right ones have a larger one in 1 of 20 fits."""
HALVINGS = 4
"""Number of times that the way from the start to the end of a search is halved."""
FLAT = 0.1
"""Standard deviation of a combination over that of the one known least, from which it is not known
either."""


def undetermined_directions(first: Array, places: Sequence[int]) -> Array:
    """Return directions of scaled parameters that measurements do not determine, in columns.

    Parameters
    ----------
    first : Jacobian of the weighted deviations at the start, (m, n)
    places : numbers of the parameters that are not determined
    """
    spread = sensitivity_of(first).inverse[list(places)]
    directions, sizes, _ = np.linalg.svd(spread, full_matrices=False)
    unknown = sizes >= FLAT * sizes[0]
    if len(places) > 1 and unknown.all():
        unknown[-1] = False
    found = np.zeros((first.shape[1], int(unknown.sum())))
    found[list(places)] = directions[:, unknown]
    return found


def other_directions(directions: Array) -> Array:
    """Return directions at right angles to these, in columns."""
    complete, _, _ = np.linalg.svd(directions, full_matrices=True)
    return np.asarray(complete[:, directions.shape[1] :])


def cost_that_is_as_good(end: Any) -> float:
    """Return the largest cost, half of chi squared, of values that fit as well as the end of a search.

    Where deviations are larger than the uncertainties explain, it is larger by as much.
    """
    freedom = max(len(end.fun) - len(end.x), 1)
    scatter = max(1.0, 2 * end.cost / freedom)
    return float(end.cost + 0.5 * RISE * scatter)
