"""Numbers beside scales that are linear near zero and logarithmic beyond, in small panels."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.sizes import COLUMN, INCH

SPEEDS = np.linspace(9.0, 15.0, 13)  # rad/s
LOADS = np.linspace(250.0, 450.0, 5)  # N
PLANE = ("Omega", "N")
AROUND = 12.0  # mm, that labels take below and above a panel
MINUS = "\N{MINUS SIGN}"
HEIGHTS = [28.0, 36.0, 41.0, 59.0]  # mm


def study_of(name: str, low: float, high: float, unit: str) -> xr.Dataset:
    """Values over a plane, evenly between two numbers."""
    values = np.linspace(low, high, SPEEDS.size * LOADS.size)
    plane = values.reshape(SPEEDS.size, LOADS.size)
    return xr.Dataset({name: (PLANE, plane, {"units": unit})}, {"Omega": SPEEDS, "N": LOADS})


def axes_of(study: xr.Dataset, variable: str, height: float, **options: Any) -> Any:
    """The axes of a drawn picture in a column of a page, about as high as asked for, in mm."""
    size = (COLUMN, (height + AROUND) / INCH)
    figure, ax = pyplot.subplots(figsize=size, layout="constrained")
    dm.plot_sweep(study, variable, ax=ax, **options)
    figure.draw_without_rendering()
    return ax


def bar_of(study: xr.Dataset, name: str, height: float, **wishes: Any) -> Any:
    """The bar of a map, about as high as asked for."""
    figure = axes_of(study, name, height, legend=False, **wishes).figure
    bar = figure.axes[1]
    assert bar.bbox.height == pytest.approx(height / INCH * figure.dpi, rel=0.2)
    return bar


def numbers_beside(ax: Any) -> list[str]:
    """The numbers that stand beside a vertical axis, from its lower end on, none of which meet."""
    low, high = ax.get_ylim()
    labels = [*ax.get_yticklabels(), *ax.get_yticklabels(minor=True)]
    shown = [text for text in labels if text.get_text() and low <= text.get_position()[1] <= high]
    boxes = [text.get_window_extent() for text in shown]
    assert all(box.count_overlaps(boxes) == 1 for box in boxes)
    shown.sort(key=lambda text: text.get_position()[1])
    return [text.get_text() for text in shown]


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize(
    ("ends", "limits", "said"),
    [
        ((-0.25, 0.25), None, [f"{MINUS}0.3", "0", "0.3"]),
        ((-9.43, 9.43), None, [f"{MINUS}9.43", "0", "9.43"]),
        ((0.01, 9.43), (0, 9.43), ["0", "9.43"]),
        ((-0.28, -0.001), None, [f"{MINUS}0.3", "0"]),
        ((-2.0, 2.0), (-0.3, 0.3), [f"{MINUS}0.3", "0", "0.3"]),
    ],
)
def test_the_ends_of_a_bar_of_rates_are_always_said(
    height: float, ends: tuple[float, float], limits: Any, said: list[str]
) -> None:
    """-0.1, 0 and 0.1 alone let its ends, 0.3, be read as 0.13; 0 and 1 alone stood where 9.43 was."""
    study = study_of("growth_rate", *ends, unit="1/s")
    numbers = numbers_beside(bar_of(study, "growth_rate", height, limits=limits))
    assert (numbers[0], numbers[-1]) == (said[0], said[-1])
    assert set(said) < set(numbers)
    assert len(numbers) >= 4 + ("0" not in (said[0], said[-1]))


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize("ends", [(0.27, 10.0), (2.0, 90.0), (0.5, 4.0), (1.0, 1e4), (0.0, 40.0)])
def test_a_logarithmic_bar_has_three_numbers(height: float, ends: tuple[float, float]) -> None:
    """Periods of 0.27 to 10 s had 1 and 10 alone."""
    study = study_of("period", *ends, unit="s")
    assert len(numbers_beside(bar_of(study, "period", height, log=True))) >= 3


WITHIN = [(0.58, 4.1), (1.35, 9.1), (2.3, 7.8), (14.8, 20.1), (385.0, 402.0), (1.0, 1.0004)]


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize("ends", WITHIN)
def test_the_ends_of_a_logarithmic_bar_within_a_decade_are_said(
    height: float, ends: tuple[float, float]
) -> None:
    """A bar from 0.58 to 4.1 ended at 0.6 and 3, and one from 1.35 to 9.1 began at 2."""
    study = study_of("wear", *ends, unit="")
    numbers = [float(text) for text in numbers_beside(bar_of(study, "wear", height, log=True))]
    plane = study["wear"].values
    assert numbers[0] == pytest.approx(plane.min(), rel=5e-3)
    assert numbers[-1] == pytest.approx(plane.max(), rel=5e-3)
    assert len(numbers) >= 4
    assert len({*numbers}) == len(numbers)


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize("ends", WITHIN)
def test_a_logarithmic_axis_within_a_decade_has_numbers_near_its_ends(
    height: float, ends: tuple[float, float]
) -> None:
    """Of an axis from 0.58 to 4.1, the lowest third had none."""
    study = study_of("wear", *ends, unit="").isel(N=2)
    ax = axes_of(study, "wear", height, log=True)
    numbers = np.array([float(text) for text in numbers_beside(ax)])
    low, high = np.log(ax.get_ylim())
    places = (np.log(numbers) - low) / (high - low)
    assert places[0] < 0.2
    assert places[-1] > 0.8


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize("greatest", [0.6, 3.0, 30.0])
def test_a_logarithmic_part_of_an_axis_has_two_numbers(height: float, greatest: float) -> None:
    """The numbers near its ends were hidden first where they would meet."""
    study = study_of("growth_rate", -greatest, greatest, unit="1/s").isel(N=2)
    ax = axes_of(study, "growth_rate", height)
    assert ax.get_yscale() == "symlog"
    numbers = [float(text.replace(MINUS, "-")) for text in numbers_beside(ax)]
    assert len([number for number in numbers if number >= 0.1]) >= 2
    assert len([number for number in numbers if number <= -0.1]) >= 2
    low, high = ax.get_ylim()
    assert numbers[-1] > high / 10
    assert numbers[0] < low / 10


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize("ends", [(0.15, 0.32), (0.12, 0.45), (-0.25, 0.25), (2.0, 5.0)])
def test_an_axis_of_rates_has_three_numbers_of_which_one_is_near_its_end(
    height: float, ends: tuple[float, float]
) -> None:
    """Rates up to 0.45 had numbers up to 0.2, and those up to 5 up to 1."""
    study = study_of("growth_rate", *ends, unit="1/s").isel(N=2)
    ax = axes_of(study, "growth_rate", height)
    numbers = [float(text.replace(MINUS, "-")) for text in numbers_beside(ax)]
    assert len(numbers) >= 3
    assert numbers[-1] > 0.75 * ax.get_ylim()[1]


def test_rates_of_a_few_tenths_have_a_linear_axis() -> None:
    """Between 0.1 and 0.25 on a logarithmic part, a low panel had -0.2, 0 and 0.2, as a linear axis has."""
    study = study_of("growth_rate", -0.25, 0.25, unit="1/s").isel(N=2)
    ax = dm.plot_sweep(study, "growth_rate")
    assert ax.get_yscale() == "linear"
