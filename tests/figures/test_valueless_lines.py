"""Tests of lines without any value, which legends name with their reason."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

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


def test_such_an_entry_has_no_sample(pairs: xr.Dataset) -> None:
    ax = dm.plot_sweep(pairs, "growth_rate", x="Omega")
    failed: Any = ax.get_legend_handles_labels()[0][said(ax).index("320 N, 0.5: failed")]
    assert failed.get_marker() == ""
    assert failed.get_linestyle() == "None"


def test_the_reason_stands_behind_the_name_among_sweeps(pairs: xr.Dataset) -> None:
    ax = dm.plot_sweep(pairs, "growth_rate", x="Omega")
    other = dm.sweep(dm.floquet, dm.Parameters(N=385, Omega=18, c_p=1.0), Omega=SPEEDS[:4])
    dm.plot_sweep(other, "growth_rate", x="Omega", ax=ax)
    failed = [words for words in said(ax) if words.startswith("320 N, 0.5")]
    assert failed == ["320 N, 0.5, $c_p$ = 0 N s/m: failed"]


def test_marks_say_why_no_line_has_a_value(pairs: xr.Dataset) -> None:
    """Without them nothing would be seen on the panel."""
    failed = pairs.isel({str(pairs["mu_k"].dims[0]): [1, 3]})
    ax = dm.plot_sweep(failed, "growth_rate", x="Omega")
    assert [rows.reason for rows in rows_above(ax)] == ["failed"]


def test_numbers_beside_a_scale_of_rates_do_not_touch() -> None:
    """0.2 and 0.1 did, below strips that leave little height."""
    sweep = dm.sweep(dm.floquet, CASE, mu_k=np.linspace(0.1, 0.35, 11), N=[200, 300])
    figure, ax = pyplot.subplots(figsize=(3.31, 2.6), layout="constrained")
    dm.plot_sweep(sweep, "growth_rate", ax=ax)
    figure.draw_without_rendering()
    labels = ax.get_yticklabels() + ax.get_yticklabels(minor=True)
    low, high = ax.get_ylim()
    shown = [text for text in labels if text.get_text() and low <= text.get_position()[1] <= high]
    boxes = sorted((text.get_window_extent() for text in shown), key=lambda box: box.y0)
    for below, above in pairwise(boxes):
        assert above.y0 - below.y1 > 1.4 * figure.dpi / 72
