"""What several figures draw."""

import json

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

from disc_model.figures.axis_numbers import spare_heights
from disc_model.figures.drawing import plain_decades, whole_marks
from disc_model.figures.runs import show_thickness
from tests.figures.reading import assert_numbers_are_apart


@pytest.mark.parametrize(
    ("ends", "numbers"),
    [
        ((0.4, 6.0), ["0.5", "1", "2", "5"]),
        ((3.2, 21.0), ["3.5", "5", "10", "20"]),
        ((0.0147, 0.0202), ["0.015", "0.016", "0.018", "0.02"]),
    ],
)
def test_numbers_of_few_decades_are_plain_and_apart(
    ends: tuple[float, float], numbers: list[str]
) -> None:
    """Within a decade, labels such as 4 x 10^0 covered each other."""
    figure, ax = pyplot.subplots(figsize=(3.3, 1.0), layout="constrained")
    ax.set(yscale="log", ylim=ends)
    plain_decades(ax.yaxis)
    figure.draw_without_rendering()
    low, high = ends
    ticks = [tick for tick in ax.yaxis.get_major_ticks() if low <= tick.get_loc() <= high]
    assert [tick.label1.get_text() for tick in ticks] == numbers
    spare_heights(ax)
    figure.draw_without_rendering()
    assert_numbers_are_apart(ax)
    pyplot.close(figure)


def test_many_decades_are_powers_of_ten() -> None:
    figure, ax = pyplot.subplots()
    ax.set(yscale="log", ylim=(1e-4, 1e2))
    plain_decades(ax.yaxis)
    figure.draw_without_rendering()
    said = [text.get_text() for text in ax.get_yticklabels()]
    assert any("10^{-2}" in text for text in said)
    pyplot.close(figure)


@pytest.mark.parametrize("width", [1.2, 2.0, 3.3])
@pytest.mark.parametrize("ends", [(1.0, 10.0), (0.9, 8.0), (2.0, 40.0), (0.1, 1e4), (1.0, 1e9)])
def test_numbers_along_a_narrow_logarithmic_axis_are_apart(
    width: float, ends: tuple[float, float]
) -> None:
    figure, ax = pyplot.subplots(figsize=(width, 1.5), layout="constrained")
    ax.set(xscale="log", xlim=ends)
    plain_decades(ax.xaxis)
    figure.draw_without_rendering()
    assert_numbers_are_apart(ax)
    low, high = ends
    ticks = ax.get_xticks()
    assert np.count_nonzero((ticks >= low) & (ticks <= high)) >= 2
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


def test_marks_at_the_edge_of_a_panel_stand_whole_and_those_beyond_are_not_drawn() -> None:
    _, ax = pyplot.subplots()
    [line] = ax.plot([0.0, 1.0, 2.0], [0.0, 5.0, 1.0], "-")
    [marks] = ax.plot([0.0, 1.0, 2.0], [0.0, 5.0, 1.0], "o")
    [none] = ax.plot([], [], "o")
    ax.set(xlim=(0, 2), ylim=(0, 2))
    whole_marks(ax)
    assert none.get_clip_on(), "its extent would be at the corner of the page"
    assert not marks.get_clip_on()
    np.testing.assert_array_equal(marks.get_ydata(), [0.0, np.nan, 1.0])
    assert line.get_clip_on()
    assert line.get_ydata().tolist() == [0.0, 5.0, 1.0]
    pyplot.close("all")
