"""Room in Campbell diagrams: names of modes beside the panel, the legend, and rings of rates."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.end_names import spread
from disc_model.figures.sizes import COLUMN, PAGE
from disc_model.studies.quantities.campbell import EFFECTS
from tests.figures.described import campbell_study, drawn
from tests.figures.every_kind import flag
from tests.figures.reading import assert_fit_for_print

HIGH = 4.6  # inch
MOST_OF_LEGEND = 0.2  # of the height of a figure


def own_panels(study: xr.Dataset, width: float, **wishes: Any) -> list[Any]:
    """The panels of a diagram on a reader's axes."""
    size = (width, HIGH)
    _, axes = pyplot.subplots(2, 1, figsize=size, layout="constrained", sharex=True)
    panels = dm.plot_campbell(study, ax=axes, **wishes)
    panels[0].figure.draw_without_rendering()
    return [*panels]


def with_close_modes() -> xr.Dataset:
    """A study whose modes end at heights that differ by less than those of their names."""
    study = campbell_study()
    study["sliding_frequency"][:] = [180.0, 190.0, 200.0]
    return study


@pytest.mark.parametrize("width", [COLUMN, PAGE])
def test_names_of_modes_are_not_on_each_other(width: float) -> None:
    """Beside a low panel "l = 3" was written over "l = 1, 3"."""
    top, _ = own_panels(with_close_modes(), width)
    named = [text for text in top.texts if text.get_text().startswith(("l =", "in-plane"))]
    boxes = [text.get_window_extent() for text in named]
    boxes.sort(key=lambda box: box.y0)
    assert len(boxes) == 3
    for lower, upper in pairwise(boxes):
        assert lower.y1 <= upper.y0 + 1.0
    assert_fit_for_print(top.figure)


@pytest.mark.parametrize(
    ("wanted", "places"),
    [
        ([0.0, 10.0, 20.0], [0.0, 10.0, 20.0]),
        ([0.0, 2.0], [-1.5, 3.5]),
        ([2.0, 0.0], [3.5, -1.5]),
        ([0.0, 1.0, 2.0, 30.0], [-4.0, 1.0, 6.0, 30.0]),
    ],
)
def test_names_are_spread_as_little_as_can_be(wanted: list[float], places: list[float]) -> None:
    assert spread(np.array(wanted), 5.0).tolist() == pytest.approx(places)


def with_all_there_is() -> xr.Dataset:
    """A study whose diagram has lines, marks and bands of all kinds."""
    study = campbell_study()
    study["sliding_growth_rate"] = study["sliding_frequency"] - 140.0
    near_motion = np.full(21, np.nan)
    near_motion[19] = 0.0
    study["near_motion"] = ("Omega", near_motion)
    study["growth_rate"][20] = 0.3
    study["growth_rate"][2] = 30.0
    effects = ["unresolved", "beyond_scan", "rises"]
    study["crossing_effect"] = flag(("crossing",), effects, EFFECTS)
    study["crossing_step"] = ("crossing", [0.048, 0.2, 0.01])
    return study


def test_the_legend_of_all_there_is_leaves_room_for_panels() -> None:
    """It had twelve entries below each other, and nearly a third of the height."""
    _, bottom = own_panels(with_all_there_is(), COLUMN, highest=150)
    legend = bottom.get_legend()
    figure = bottom.figure
    assert len(legend.get_texts()) >= 9
    assert legend.get_window_extent().height <= MOST_OF_LEGEND * figure.bbox.height
    assert_fit_for_print(figure)


def test_a_reader_gives_an_entry_of_several_lines_other_words() -> None:
    study = with_all_there_is()
    said = "3 crossings: 1 needs steps of 0.04 rad/s (marked), 1 needs a wider scan"
    _, bottom = own_panels(study, PAGE, labels={said: "crossings"})
    assert "crossings" in [text.get_text() for text in bottom.get_legend().get_texts()]


def rings_of(rates: list[float]) -> set[float]:
    """The rates that a diagram has rings at."""
    study = campbell_study().isel(Omega=slice(0, len(rates)))
    study["growth_rate"][:] = rates
    _, bottom = dm.plot_campbell(study)
    found = set[float]()
    for line in bottom.lines:
        if line.get_markerfacecolor() == "white":
            found |= {*np.ravel(line.get_ydata()).tolist()}
    return found


def test_a_smooth_curve_of_large_rates_has_no_ring() -> None:
    """Of a disc that squeals, each point had one: any step over 0.1/s was open."""
    assert not rings_of([6.0, 7.0, 8.5, 10.0, 11.0, 11.5, 11.0])


def test_a_jump_of_small_rates_has_a_ring() -> None:
    assert rings_of([-0.05, -0.05, -0.05, 0.2, -0.05, -0.05]) == {0.2}


def over_loads(width: str) -> Any:
    """A figure of two preloads with multiples, of a width."""
    study = campbell_study()
    loads = xr.concat([study, study], xr.Variable("N", np.array([300.0, 385.0])), data_vars="all")
    return drawn("campbell", loads, by="N", multiples=[2, 2.5, 3], width=width)


@pytest.mark.parametrize(("width", "columns"), [("column", 1), ("page", 2)])
def test_panels_of_two_preloads_have_room(width: str, columns: int) -> None:
    """In a column they stood beside each other, 25 mm wide, and names of multiples touched."""
    figure = over_loads(width)
    figure.draw_without_rendering()
    places = {round(ax.get_position().x0, 3) for ax in figure.axes}
    assert len(places) == columns
    titles = [ax.get_title("left") for ax in figure.axes]
    assert titles[0].startswith("(a) ")
    assert sum("385 N" in title for title in titles) == 1
    named = [ax.get_ylabel() for ax in figure.axes if ax.get_ylabel()]
    assert len(named) == 4 // columns
    assert_fit_for_print(figure)


@pytest.mark.parametrize("width", [COLUMN, PAGE])
@pytest.mark.parametrize("highest", [None, 200.0])
def test_names_of_multiples_are_on_no_other_name(width: float, highest: float | None) -> None:
    """They stood on each other, on marks, or on the numbers of the axis beside a cut."""
    top, _ = own_panels(campbell_study(), width, multiples=[2, 2.5, 3, 3.5], highest=highest)
    named = [text for text in top.texts if "f_s" in text.get_text() and text.get_visible()]
    assert len(named) >= 4
    frame = top.get_window_extent()
    boxes = [text.get_window_extent() for text in named]
    for i, box in enumerate(boxes):
        assert frame.count_contains(box.corners()) == 4
        assert not box.count_overlaps(boxes[i + 1 :])


def test_the_name_of_a_multiple_is_not_on_the_line_of_another() -> None:
    """Where a multiple ran along a mode, its name stood on the line of the next multiple."""
    study = campbell_study()
    study["stick_slip_frequency"][:] = 225.2
    study["sliding_frequency"][:] = [1930.0, 2130.0, 2750.0]
    top, _ = own_panels(study, PAGE, multiples=[9.5, 10], highest=6000)
    named = [text for text in top.texts if "f_s" in text.get_text() and text.get_visible()]
    [of_lower] = [text for text in named if text.get_text().startswith("9.5")]
    speeds = np.linspace(8, 18, 500)
    other = top.transData.transform(np.column_stack([speeds, np.full(500, 2252.0)]))
    assert not of_lower.get_window_extent().count_contains(other)


def test_the_name_of_a_multiple_is_not_on_the_line_of_one_at_a_peak() -> None:
    """The name of 4.5 times the stick-slip frequency stood on the line of 5 times, which a peak has."""
    study = campbell_study()
    study["stick_slip_frequency"][:] = 225.2
    study["sliding_frequency"][:] = [1930.0, 2130.0, 2750.0]
    study["crossing_multiple"] = ("crossing", [10.0, 3.0, 1.0])
    study["crossing_frequency"][0] = 2252.0
    top, _ = own_panels(study, PAGE, multiples=[9.5], highest=6000)
    [name] = [text for text in top.texts if text.get_text().startswith("9.5")]
    speeds = np.linspace(8, 18, 500)
    other = top.transData.transform(np.column_stack([speeds, np.full(500, 2252.0)]))
    assert name.get_visible()
    assert not name.get_window_extent().count_contains(other)


def test_names_at_peaks_come_before_those_along_lines() -> None:
    """A multiple's name took the only room beside a peak, which had none, and read as that of the peak."""
    top, _ = own_panels(campbell_study(), COLUMN, multiples=[2, 3])
    first, *others = [text for text in top.texts if "f_s" in text.get_text()]
    assert first.get_text().startswith("2.5 ")
    assert len(others) == 2
