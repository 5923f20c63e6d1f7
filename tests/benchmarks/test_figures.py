"""The figures of the benchmark say what its datasets hold."""

from itertools import combinations

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from benchmarks import figures
from benchmarks.figures.looks import TEXTS
from benchmarks.methods import METHODS
from benchmarks.scenes import Verdict

GREY_APART = 0.12  # difference of lightness that a grey print shows


def lightness(colour: str) -> float:
    """Lightness in grey print, from 0 for black to 1 for white."""
    return float(np.dot(to_rgb(colour), [0.299, 0.587, 0.114]))


def labels(figure: Figure) -> list[str]:
    """Entries of the legends of a figure."""
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


@pytest.mark.parametrize("table", ["verdicts", "answered"])
def test_shades_of_verdicts_differ_in_grey_print(table: str) -> None:
    """What is right had the lightness of what is wrong without a warning."""
    shades = {name: lightness(shade) for name, (_, shade) in TEXTS[table].items()}
    for (one, light), (other, dark) in combinations(shades.items(), 2):
        assert abs(light - dark) > GREY_APART, (one, other)


def test_cost_against_accuracy_names_the_methods_that_have_points(dataset: xr.Dataset) -> None:
    figure = figures.overview(dataset)
    expected = {METHODS[name].label for name in ("series", "RK4", "Radau")}
    assert set(labels(figure)) == {*expected, f"{METHODS['RK4'].label}, without Python"}
    assert [text.get_text() for text in figure.axes[0].texts] == ["wrong\nevents"]


def test_cost_against_accuracy_draws_both_in_seconds(dataset: xr.Dataset) -> None:
    ax, *_ = figures.overview(dataset).axes
    assert ax.get_ylabel() == "Time per simulated second (s)"
    assert ax.get_xlabel() == "Event-time error (s)"
    series = dataset.sel(scene="stick_slip", solver="series")
    right = series["verdict"].values == Verdict.CONVERGED
    line = next(line for line in ax.lines if line.get_zorder() == 3)
    np.testing.assert_array_equal(line.get_xdata(), series["event_error"].values[right])
    np.testing.assert_array_equal(line.get_ydata(), series["cost"].values[right])


def test_a_cell_of_prices_names_its_setting(priced: xr.Dataset) -> None:
    texts = [text.get_text() for text in figures.prices(priced).axes[0].texts]
    assert texts == ["2 s", "tol 1e-2", "wrong at 2", "0.4 ms", "tol 1e-6", "wrong"]


def relative_luminance(colour: object) -> float:
    """As WCAG 2 defines it."""
    channels = np.array(to_rgb(colour))
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def test_words_of_prices_are_seen_on_what_is_behind_them(priced: xr.Dataset) -> None:
    """Red words stood on blue and green."""
    [ax, *_] = figures.prices(priced).axes
    cells = [cell for cell in ax.patches if cell.get_width() == 1]
    for text in ax.texts:
        plate = text.get_bbox_patch()
        if plate is None:
            x, y = text.get_position()
            [plate] = [cell for cell in cells if cell.get_bbox().contains(x, y)]
        pair = [relative_luminance(shade) for shade in (text.get_color(), plate.get_facecolor())]
        contrast = (max(pair) + 0.05) / (min(pair) + 0.05)
        assert contrast >= 4.5, text.get_text()  # WCAG 2, level AA


def test_costs_of_answers_name_lines_and_numbers_of_modes(priced: xr.Dataset) -> None:
    figure = figures.draw("answers", [priced])
    assert labels(figure) == [
        "late",
        "series, modes, rigid contact",
        "series, from the cycle itself",
    ]
    assert [text.get_text() for text in figure.axes[0].texts] == ["8", "4"]
