"""Tests of the rows of marks above panels that have lines of several sweeps."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.gap_rows import Rows, rows_above
from disc_model.figures.types import Axes

CASE = dm.Parameters(N=385, Omega=18)
FRICTION = np.linspace(0.1, 0.35, 11)


@pytest.fixture(scope="module")
def loads() -> xr.Dataset:
    """Growth rates over friction at two loads."""
    return dm.sweep(dm.floquet, CASE, mu_k=FRICTION, N=[200, 300])


@pytest.fixture(scope="module")
def dampers() -> xr.Dataset:
    """Growth rates over friction at two dampers."""
    return dm.sweep(dm.floquet, CASE, mu_k=FRICTION, c_p=[0.0, 1.0])


def beside(loads: xr.Dataset, dampers: xr.Dataset, variable: str = "growth_rate") -> Axes:
    """Both on the same axes, of the width of a column."""
    _, ax = pyplot.subplots(figsize=(3.31, 3.2), layout="constrained")
    dm.plot_sweep(loads, variable, ax=ax)
    return dm.plot_sweep(dampers, variable, ax=ax, lines="c_p")


def looks_below(rows: Rows) -> set[tuple[str, str]]:
    """Colours and dashes of the lines that are seen below marks."""
    seen = [row.below for row in rows.kept if row.below is not None]
    return {(str(line.get_color()), line.get_linestyle()) for line in seen}


def test_sweeps_share_a_strip_for_each_reason(loads: xr.Dataset, dampers: xr.Dataset) -> None:
    """Four strips took 40 % of the height, and names of two fitted the same line."""
    ax = beside(loads, dampers)
    said = [rows.words.get_text() for rows in rows_above(ax)]
    assert said == [
        "line open: another cycle, or too wide a step",
        "no cycle found",
        "unstable steady sliding",
    ]


def test_marks_lie_on_lines_of_the_looks_of_the_legend(
    loads: xr.Dataset, dampers: xr.Dataset
) -> None:
    """Strokes of both sweeps had the colour of two lines, and no dashes."""
    ax = beside(loads, dampers)
    lines: list[Any] = ax.get_legend_handles_labels()[0]
    in_legend = {(str(line.get_color()), line.get_linestyle()) for line in lines}
    first = rows_above(ax)[0]
    assert len(looks_below(first)) == 2
    assert {dashes for _, dashes in looks_below(first)} == {"-", "--"}
    for rows in rows_above(ax):
        assert looks_below(rows) <= in_legend


def test_lines_below_marks_stay_on_their_strip(loads: xr.Dataset, dampers: xr.Dataset) -> None:
    ax = beside(loads, dampers)
    figure: Any = ax.figure
    figure.draw_without_rendering()
    for rows in rows_above(ax):
        strip = rows.strip.get_window_extent()
        for row in rows.kept:
            line = row.below.get_window_extent()
            assert strip.y0 < line.y0 <= line.y1 < strip.y1
            assert [line.x0, line.x1] == pytest.approx([strip.x0, strip.x1], abs=2)


def test_one_sweep_needs_no_lines_below_marks(dampers: xr.Dataset) -> None:
    ax = dm.plot_sweep(dampers, "growth_rate", lines="c_p")
    assert not any(looks_below(rows) for rows in rows_above(ax))


def test_rows_that_all_sweeps_have_alike_stand_there_once(dampers: xr.Dataset) -> None:
    ax = dm.plot_sweep(dampers, "period", lines="c_p")
    alone = [len(rows.rows) for rows in rows_above(ax)]
    ax = dm.plot_sweep(dampers, "period", lines="c_p")
    dm.plot_sweep(dampers, "period", lines="c_p", ax=ax)
    assert [len(rows.rows) for rows in rows_above(ax)] == alone
    assert not any(looks_below(rows) for rows in rows_above(ax))


def test_rows_of_two_of_three_sweeps_are_told_apart(loads: xr.Dataset, dampers: xr.Dataset) -> None:
    """Those of two that are alike would be taken for rows of all three."""
    ax = dm.plot_sweep(dampers, "period", lines="c_p")
    dm.plot_sweep(dampers, "period", lines="c_p", ax=ax)
    dm.plot_sweep(loads, "period", lines="N", ax=ax)
    assert {dashes for rows in rows_above(ax) for _, dashes in looks_below(rows)} == {"-", "--"}
