"""What several figures draw."""

import json

import pytest
import xarray as xr
from matplotlib import pyplot

from disc_model.figures.drawing import plain_decades
from disc_model.figures.runs import show_thickness


def test_many_decades_are_powers_of_ten() -> None:
    figure, ax = pyplot.subplots()
    ax.set(yscale="log", ylim=(1e-4, 1e2))
    plain_decades(ax.yaxis)
    figure.draw_without_rendering()
    said = [text.get_text() for text in ax.get_yticklabels()]
    assert any("10^{-2}" in text for text in said)
    pyplot.close(figure)


@pytest.mark.parametrize("along", ["x", "y"])
@pytest.mark.parametrize("ends", [(-10.0, 10.0), (0.0, 4.0)])
def test_the_bar_of_the_thickness_is_as_long_as_the_disc_is_thick(
    along: str, ends: tuple[float, float]
) -> None:
    """Two millimetres on an axis in mm."""
    case = xr.DataTree(xr.Dataset(attrs={"parameters": json.dumps({"h": 2e-3})}))
    _, ax = pyplot.subplots()
    getattr(ax, f"set_{along}lim")(ends)
    show_thickness(ax, case, along)  # type: ignore[arg-type]
    [bar] = ax.lines
    first, last = ax.transAxes.transform(bar.get_xydata())
    shown = ax.transData.inverted().transform([first, last])
    length = abs(shown[1] - shown[0])["xy".index(along)]
    assert length == pytest.approx(2.0)
    assert [text.get_text() for text in ax.texts] == ["thickness 2 mm"]
    pyplot.close("all")
