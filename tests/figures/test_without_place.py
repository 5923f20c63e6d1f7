"""Points of lines that have no value along the axis."""

from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes

import disc_model as dm
from disc_model.figures.symbols import in_a_row
from tests.figures.reading import labels

CASE = dm.Parameters(N=385, Omega=15)
TABLE = pd.DataFrame({"c": [0.5, np.nan, 1.5], "mu_s": [0.38, 0.39, 0.4]})
WORDS = "not drawn: 1 of 3 without Damper c"


def load_of(case: dm.Parameters) -> dict[str, float]:
    """A result of its own."""
    return {"size": case.N * case.c}


def shown(ax: Axes) -> list[str]:
    """What the legend of a picture says, without lines."""
    return [in_a_row(text) for text in labels(ax.figure)]


def test_samples_without_a_value_along_the_axis_are_counted() -> None:
    """They were left out without a word."""
    sizes = dm.sweep(load_of, CASE, zip=TABLE)
    assert shown(dm.plot_sweep(sizes, "size")).count(WORDS) == 1


def test_the_title_does_not_say_it_again() -> None:
    """It said "1 sample without c" above the same in other words."""
    ax = dm.plot_sweep(dm.sweep(load_of, CASE, zip=TABLE), "size", x="c")
    assert "without" not in ax.figure.get_suptitle()


def test_lines_say_it_once() -> None:
    sizes = dm.sweep(load_of, CASE, zip=TABLE, N=[200.0, 385.0])
    ax = dm.plot_sweep(sizes, "size")
    assert shown(ax).count(WORDS) == 1
    dm.plot_sweep(sizes.isel(N=0), "size", ax=ax)
    assert shown(ax).count(WORDS) == 1


def test_a_symbol_with_an_index_is_set_once() -> None:
    table = pd.DataFrame({"mu_s": [0.38, np.nan, 0.4], "c": [0.5, 1.0, 1.5]})
    sizes = dm.sweep(load_of, CASE, zip=table, N=[200.0, 385.0])
    said = shown(dm.plot_sweep(sizes, "size", x="mu_s"))
    assert [text for text in said if "not drawn" in text] == [
        "not drawn: 1 of 3 without Static friction $μ_s$"
    ]


def test_a_note_alone_has_no_frame_and_no_blank_sample() -> None:
    """It stood in a frame, behind the room for a sample."""
    ax = dm.plot_sweep(dm.sweep(load_of, CASE, zip=TABLE), "size", x="c")
    [legend] = ax.figure.legends
    assert not legend.get_frame_on()
    assert _indent(legend, 0) < 3


@pytest.mark.parametrize("wish", [True, {"loc": "upper left"}], ids=["usual", "placed"])
def test_a_note_begins_where_samples_of_lines_do(wish: Any) -> None:
    sizes = dm.sweep(load_of, CASE, zip=TABLE, N=[200.0, 385.0])
    figure, ax = pyplot.subplots(layout="constrained")
    dm.plot_sweep(sizes, "size", x="c", ax=ax, legend=wish)
    dm.plot_sweep(sizes, "size", x="c", ax=ax, legend=wish)
    legend: Any = ax.get_legend()
    said = [in_a_row(text.get_text()) for text in legend.get_texts()]
    note = said.index(WORDS)
    assert legend.get_frame_on()
    assert _indent(legend, note) < 3
    assert _indent(legend, 0) > 15
    pyplot.close(figure)


def _indent(legend: Any, row: int) -> float:
    """Distance of words from where the row of a legend begins, points."""
    figure = legend.get_figure(root=True)
    figure.draw_without_rendering()
    starts = legend._legend_handle_box.get_window_extent(figure.canvas.get_renderer()).x0
    return (legend.get_texts()[row].get_window_extent().x0 - starts) / figure.dpi * 72


def test_nothing_is_said_where_all_have_a_place() -> None:
    sizes: xr.Dataset = dm.sweep(load_of, CASE, zip=TABLE.dropna())
    said = shown(dm.plot_sweep(sizes, "size"))
    assert not [text for text in said if "not drawn" in text]
