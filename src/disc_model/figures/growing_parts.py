"""Where along a parameter a mode grows."""

import numpy as np

from disc_model.figures.colours import ROUNDING
from disc_model.figures.types import Array, Indices


def growing_part(along: Array, rate: Array, values: Array) -> tuple[Array, Array]:
    """The points of a line where its growth rate is above zero, with nan elsewhere, from where the rate
    is zero on: between two points by linear interpolation."""
    grows = np.nan_to_num(rate) > ROUNDING
    changes = grows[:-1] != grows[1:]
    known = np.isfinite(rate[:-1]) & np.isfinite(rate[1:])
    places = np.flatnonzero(changes & known)
    shares = _shares_of_zero(rate[places], rate[places + 1])
    shown = np.where(grows, values, np.nan)
    x = np.insert(along.astype(float), places + 1, _between(along, places, shares))
    y = np.insert(shown, places + 1, _between(values, places, shares))
    return x, y


def _shares_of_zero(before: Array, after: Array) -> Array:
    """The shares of steps at which a growth rate is zero; the end of a step at which it is only not
    above rounding."""
    return np.clip(before / (before - after), 0.0, 1.0)


def _between(values: Array, places: Indices, shares: Array) -> Array:
    """Values at shares of the steps that begin at some places."""
    return values[places] + shares * (values[places + 1] - values[places])
