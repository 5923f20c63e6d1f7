"""Curves of a study with many lines: all have room, those without a point have no name, and values are
known however a file writes them."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from disc_model.data.variables import attributes
from disc_model.errors import ParameterError
from disc_model.figures.kinds import kind_of
from disc_model.figures.kinds.base import key_of, unknown
from disc_model.figures.render import render
from tests.figures.reading import assert_fit_for_print

SPEEDS = np.linspace(10.0, 15.0, 6)  # rad/s


def study(loads: np.ndarray) -> xr.Dataset:
    """Rates of cycles at speeds and loads."""
    rates = 0.01 * (SPEEDS[:, None] - 12) + 1e-3 * np.arange(loads.size)
    status = np.full(rates.shape, "ok", dtype=object)
    rate = (("Omega", "N"), rates, {"units": "s-1", "long_name": "growth rate of the cycle"})
    return xr.Dataset(
        {"growth_rate": rate, "status": (("Omega", "N"), status)},
        {"Omega": ("Omega", SPEEDS, attributes("Omega")), "N": ("N", loads, attributes("N"))},
        {"quantity": "floquet"},
    )


def drawn(data: xr.Dataset, **further: Any) -> Figure:
    """A figure of these rates over the speed, a line for each load."""
    asked = {"kind": "curve", "variable": "growth_rate", "x": "Omega", "by": "N", **further}
    plot = kind_of("curve").model_validate(asked)
    return render(plot, {"rates": xr.DataTree(data)})


def names_in(figure: Figure) -> list[str]:
    return [text.get_text() for text in figure.legends[0].get_texts()]


@pytest.mark.parametrize("width", ["column", "page"])
def test_the_legend_of_many_lines_leaves_their_panel_room(width: str) -> None:
    """It lay over the panel, which had no height."""
    data = study(np.linspace(300.0, 400.0, 11))
    doubtful = (("Omega", "N"), np.zeros((6, 11), dtype=int))
    figure = drawn(data.assign(near_motion=doubtful), width=width)
    assert_fit_for_print(figure)
    [ax] = figure.axes
    [legend] = figure.legends
    assert len(names_in(figure)) == 12
    assert ax.bbox.height > 1.1 * figure.dpi
    label = ax.xaxis.label.get_window_extent()
    assert legend.get_window_extent().y1 <= label.y0


def test_lines_without_a_point_have_no_name() -> None:
    """The legend named a load that is left out."""
    data = study(np.array([300.0, 350.0, 400.0]))
    figure = drawn(data.where(data["N"] > 300), legend=True)
    assert names_in(figure) == ["Preload N = 350 N", "400 N"]
    figure = drawn(data.where(data["N"] == 350), legend=True)
    assert names_in(figure) == ["Preload N = 350 N"]


def test_names_are_found_by_value() -> None:
    """Only the text "300.0" was understood."""
    data = study(np.array([300.0, 350.0, 400.0]))
    names = {300: "light", "350": "middle", "4e2": "heavy"}
    assert names_in(drawn(data, names=names, legend=True)) == ["light", "middle", "heavy"]
    assert key_of(0) == key_of(0.0) == key_of("0.0")
    assert key_of(0.1 + 0.2) == key_of("0.3")
    assert not [*unknown("names", {0: "none"}, "by", [0.0, 0.003])]
    assert [*unknown("names", {1: "none"}, "by", [0.0, 0.003])]
    with pytest.raises(ParameterError, match="names"):
        drawn(data, names=3)


def test_a_label_beside_a_panel_ends_below_a_long_title() -> None:
    """It ran into the title of a figure in one column."""
    data = study(np.array([300.0, 350.0]))
    words = "growth rate of a cycle whose name is nearly as long as its panel"
    data["growth_rate"].attrs["long_name"] = words
    title = "A title that is so long that it spans the whole width of a column"
    figure = drawn(data, width="column", title=title, legend=True)
    figure.draw_without_rendering()
    label = figure.axes[0].yaxis.label.get_window_extent()
    [heading] = figure.texts
    assert label.y1 <= heading.get_window_extent().y0 + 1
