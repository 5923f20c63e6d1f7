"""Infinite values are told from missing ones, in maps as in lines."""

import numpy as np
import pytest
import xarray as xr

from tests.figures.reading import as_map, labels

SPEEDS = [8.0, 10.0, 12.0]  # rad/s
LOADS = [200.0, 300.0, 400.0, 500.0]  # N


def grid(name: str) -> xr.Dataset:
    """A variable that is infinite, below any axis, and missing, at one speed each and a load."""
    values = np.ones((3, 4))
    at_lowest_load = values[:, 0]
    at_lowest_load[0] = np.inf
    at_lowest_load[1] = -np.inf
    at_lowest_load[2] = np.nan
    variable = (("Omega", "N"), values)
    return xr.Dataset({name: variable}, {"Omega": SPEEDS, "N": LOADS})


NAMED = {
    "size": {"infinite", "minus infinite", "no value"},
    "growth_rate": {"infinite", "growth rate −∞", "no value"},
}
"""What is said of the values of a variable, by its name."""


@pytest.mark.parametrize("name", NAMED)
def test_a_map_tells_infinite_values_from_missing_ones(name: str) -> None:
    """All were "no value", or "growth rate −∞"."""
    ax = as_map(grid(name), name)
    said = {*labels(ax.figure)}
    said.discard("stable")
    assert said == NAMED[name]
