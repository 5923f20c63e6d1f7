"""Infinite values are told from missing ones, in maps as in lines."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.gap_rows import rows_above
from tests.figures.reading import as_map, labels

SPEEDS = [8.0, 10.0, 12.0]  # rad/s
LOADS = [200.0, 300.0, 400.0, 500.0]  # N


@pytest.fixture(autouse=True)
def _closed() -> object:
    yield
    pyplot.close("all")


def grid(name: str) -> xr.Dataset:
    """A variable that is infinite, below any axis, and missing, at one speed each and a load."""
    values = np.ones((3, 4))
    values[:, 0] = [np.inf, -np.inf, np.nan]
    return xr.Dataset({name: (("Omega", "N"), values)}, {"Omega": SPEEDS, "N": LOADS})


NAMED: Any = [
    ("size", {"infinite", "minus infinite", "no value"}),
    ("growth_rate", {"infinite", "growth rate −∞", "no value"}),
]


@pytest.mark.parametrize(("name", "named"), NAMED)
def test_a_map_tells_infinite_values_from_missing_ones(name: str, named: set[str]) -> None:
    """All were "no value", or "growth rate −∞"."""
    assert named == {*labels(as_map(grid(name), name).figure)} - {"stable"}


@pytest.mark.parametrize(("name", "named"), NAMED)
def test_lines_tell_infinite_values_from_missing_ones(name: str, named: set[str]) -> None:
    """Missing ones were "growth rate −∞" beside such."""
    ax = dm.plot_sweep(grid(name).sel(N=200, drop=True), name)
    assert {row.words.get_text() for row in rows_above(ax)} == named
