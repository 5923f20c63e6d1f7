"""Made-up studies for the figures of grids, and figures that are closed after each test."""

from collections.abc import Iterator

import pytest
from matplotlib import pyplot

from tests.studies.conftest import fake_motions, fold_map, plane, speeds, sweep

__all__ = ["fake_motions", "fold_map", "plane", "speeds", "sweep"]


@pytest.fixture(autouse=True)
def _close_figures() -> Iterator[None]:
    """Close the figures of a test."""
    yield
    pyplot.close("all")
