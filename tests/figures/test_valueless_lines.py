"""Tests of lines without any value, which legends name with their reason."""

import numpy as np
import pytest
import xarray as xr

import disc_model as dm
from disc_model.figures.gap_rows import rows_above
from disc_model.figures.types import Axes

CASE = dm.Parameters(N=385, Omega=18)
SPEEDS = np.linspace(14, 20, 13)
LOADS = [300, 320, 340, 385, 400, 420]
FRICTION = [0.2, 0.5, 0.3, 0.5, 0.25, 0.5]
"""Half of these are above static friction, with which there is no case."""


@pytest.fixture(scope="module")
def pairs() -> xr.Dataset:
    """Paired samples over the speed, of which three fail."""
    return dm.sweep(dm.floquet, CASE, Omega=SPEEDS, zip={"N": LOADS, "mu_k": FRICTION})


def said(ax: Axes) -> list[str]:
    """The words of the entries of a legend."""
    return ax.get_legend_handles_labels()[1]


def test_a_line_that_failed_everywhere_is_one_entry(pairs: xr.Dataset) -> None:
    """It had a row of 13 marks; three of them left a third of the height for the curves."""
    ax = dm.plot_sweep(pairs, "growth_rate", x="Omega")
    assert said(ax)[1:4] == ["320 N, 0.5: failed", "340 N, 0.3", "385 N, 0.5: failed"]
    reasons = [rows.reason for rows in rows_above(ax)]
    assert reasons == ["no cycle found", "line open: another cycle, or too wide a step"]


def test_marks_say_why_no_line_has_a_value(pairs: xr.Dataset) -> None:
    """Without them nothing would be seen on the panel."""
    failed = pairs.isel({str(pairs["mu_k"].dims[0]): [1, 3]})
    ax = dm.plot_sweep(failed, "growth_rate", x="Omega")
    assert [rows.reason for rows in rows_above(ax)] == ["failed"]
