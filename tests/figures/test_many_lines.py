"""Curves of a study with many lines: all have room, those without a point have no name, and values are
known however a file writes them."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from disc_model.data.variables import attributes
from disc_model.figures.gap_rows import rows_above
from disc_model.figures.kinds import kind_of
from disc_model.figures.kinds.base import unknown
from disc_model.figures.render import render

SPEEDS = np.linspace(10.0, 15.0, 6)  # rad/s
PLANE = ("Omega", "N")


def study(*loads: float) -> xr.Dataset:
    """Rates of cycles at speeds and loads."""
    of_speeds = 0.01 * (SPEEDS - 12)
    of_loads = 1e-3 * np.arange(len(loads))
    rates = of_speeds[:, None] + of_loads
    status = np.full(rates.shape, "ok", dtype=object)
    words = {"units": "s-1", "long_name": "growth rate of the cycle"}
    return xr.Dataset(
        {"growth_rate": (PLANE, rates, words), "status": (PLANE, status)},
        {"Omega": ("Omega", SPEEDS, attributes("Omega")), "N": ("N", [*loads], attributes("N"))},
        {"quantity": "floquet"},
    )


def drawn(data: xr.Dataset, **further: Any) -> Figure:
    """A figure of these rates over the speed, a line for each load."""
    asked = {"kind": "curve", "variable": "growth_rate", "x": "Omega", "by": "N"}
    asked.update(further)
    plot = kind_of("curve").model_validate(asked)
    inputs = {"rates": xr.DataTree(data)}
    return render(plot, inputs)


def names_in(figure: Figure) -> list[str]:
    """What the legend of a figure says."""
    [legend] = figure.legends
    return [text.get_text() for text in legend.get_texts()]


# ---- Names


@pytest.fixture
def three_loads() -> xr.Dataset:
    """Rates at three loads."""
    return study(300.0, 350.0, 400.0)


def test_names_are_found_by_value(three_loads: xr.Dataset) -> None:
    """Only the text "300.0" was understood."""
    names = {300: "light", "350": "middle", "4e2": "heavy"}
    figure = drawn(three_loads, names=names, legend=True)
    assert names_in(figure) == ["light", "middle", "heavy"]


@pytest.mark.parametrize(("value", "faults"), [(0, 0), (1, 1)])
def test_names_of_values_that_there_are_not_are_faults(value: int, faults: int) -> None:
    found = unknown("names", {value: "none"}, "by", [0.0, 0.003])
    assert len([*found]) == faults


def rows_of_gaps(count: int) -> tuple[list[str], int, set[str]]:
    """Of so many lines, each of which ends earlier than the one before: the words above their panel, the
    number of rows there, and the dashes of the lines."""
    data = study(*np.linspace(300.0, 400.0, count))
    rates = data["growth_rate"].values
    status = data["status"].values.copy()
    for i in range(count):
        status[len(SPEEDS) - 1 - i % 3 :, i] = "no_cycle"
    gone = status != "ok"
    data = data.assign(
        growth_rate=(PLANE, np.where(gone, np.nan, rates), data["growth_rate"].attrs),
        status=(PLANE, status.astype(str)),
    )
    ax = drawn(data).axes[0]
    found = rows_above(ax)
    lines = [line for line in ax.lines if len(line.get_xdata()) >= len(SPEEDS)]
    words = [each.reason for each in found]
    rows = sum(len(each.rows) for each in found)
    return words, rows, {str(line.get_linestyle()) for line in lines}


def test_many_lines_have_one_row_for_their_gaps_and_say_of_how_many_they_are() -> None:
    """Ten rows lay on each other, and the last colours were nearly one."""
    words, rows, dashes = rows_of_gaps(10)
    assert words == ["no cycle found: 3 to 10 of 10 lines"]
    assert rows == 1
    assert dashes == {"-", "--"}
    words, rows, dashes = rows_of_gaps(6)
    assert words == ["no cycle found"]
    assert rows == 6
    assert dashes == {"-"}
