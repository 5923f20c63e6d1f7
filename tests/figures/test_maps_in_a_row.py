"""Maps beside each other on a reader's axes: of bars with the same label, the last one has it."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

from disc_model.figures.sizes import INCH, PAGE
from tests.figures.reading import as_map

LEAST = 20 / INCH  # width of a panel, inch
WORDS = "Growth rate of the stick-slip cycle (1/s)"


def rates() -> xr.Dataset:
    """Growth rates over speed and preload."""
    plane = {"Omega": [5.0, 6, 7, 8], "N": [200.0, 300, 400, 500]}
    attrs = {"units": "s-1", "long_name": "growth rate of the stick-slip cycle"}
    values = np.linspace(-0.3, 0.3, 16).reshape(4, 4)
    return xr.DataArray(values, plane, attrs=attrs).to_dataset(name="growth_rate")


def bar_labels(figure: Any) -> list[str]:
    """The labels of the bars of a figure, from left to right."""
    bars = [ax for ax in figure.axes if ax.get_label() == "<colorbar>"]
    bars.sort(key=lambda ax: float(ax.get_position().x0))
    return [ax.get_ylabel().replace("\n", " ") for ax in bars]


@pytest.mark.parametrize("order", [(0, 1, 2), pytest.param((2, 0, 1), marks=pytest.mark.slow)])
def test_three_maps_on_a_page_have_one_label_of_their_bars(order: tuple[int, ...]) -> None:
    """Each bar had one of three lines, and the panels were 11 mm wide."""
    figure, panels = pyplot.subplots(1, 3, figsize=(PAGE, 70 / INCH), layout="constrained")
    for number in order:
        as_map(rates(), "growth_rate", ax=panels[number])
    figure.canvas.draw()
    assert bar_labels(figure) == ["", "", WORDS]
    widths = [ax.get_window_extent().width / figure.dpi for ax in panels]
    assert min(widths) > LEAST
    pyplot.close("all")


def test_maps_whose_bars_differ_have_a_label_each() -> None:
    figure, panels = pyplot.subplots(1, 3, figsize=(PAGE, 70 / INCH))
    for ax, words in zip(panels, ["one", "other", "other"], strict=True):
        as_map(rates(), "growth_rate", ax=ax, labels={"bar": words})
    assert bar_labels(figure) == ["one", "", "other"]
    pyplot.close("all")


@pytest.mark.parametrize("grid", [(1, 2), (3, 1)])
def test_maps_in_two_columns_or_below_each_other_have_a_label_each(grid: tuple[int, int]) -> None:
    figure, panels = pyplot.subplots(*grid, figsize=(PAGE, 160 / INCH))
    for ax in panels:
        as_map(rates(), "growth_rate", ax=ax)
    assert set(bar_labels(figure)) == {WORDS}
    pyplot.close("all")
