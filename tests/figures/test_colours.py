"""Colours of numbers on a map."""

import numpy as np
import pytest
import xarray as xr
from cmcrameri import cm
from matplotlib.colors import AsinhNorm, LogNorm

from disc_model.figures.colours import colours_of, counted, within_a_decade

RATE = xr.DataArray(0.0, name="growth_rate")
PERIOD = xr.DataArray(0.0, name="period")


@pytest.mark.parametrize(
    ("numbers", "ends", "cmap"),
    [
        ([-1.0, 3.0], (-3.0, 3.0), cm.vik),
        ([-4.0, 3.0], (-4.0, 4.0), cm.vik),
        ([1.0, 3.0], (1.0, 3.0), cm.batlow),
        ([-3.0, -1.0], (-3.0, -1.0), cm.batlow),
        ([0.0, 2.0], (0.0, 2.0), cm.batlow),
        ([np.nan, 5.0, 7.0], (5.0, 7.0), cm.batlow),
        ([np.nan], (0.0, 1.0), cm.batlow),
    ],
)
def test_numbers_of_both_signs_are_centred_on_zero_and_others_fill_the_scale(
    numbers: list[float], ends: tuple[float, float], cmap: object
) -> None:
    scale = colours_of(np.array(numbers), PERIOD, log=False)
    assert (scale.norm.vmin, scale.norm.vmax) == ends
    assert scale.cmap is cmap


def test_each_of_few_counts_has_a_colour_of_its_own() -> None:
    counts = xr.DataArray([0, 2], name="releases")
    scale = colours_of(np.array([0, 2]), counts, log=False)
    assert scale.ticks == ["0", "1", "2"]
    colours = {scale.cmap(scale.norm(i)) for i in range(3)}
    assert len(colours) == 3
    assert colours_of(np.array([0, 11]), counts, log=False).ticks == [str(i) for i in range(12)]
    assert not colours_of(np.array([0, 12]), counts, log=False).ticks, "too many"
    middle = counted(4)
    assert middle.norm(1.4) == middle.norm(1)
    assert middle.norm(1.6) == middle.norm(2)


def test_a_logarithmic_scale_of_positive_numbers_ends_at_them() -> None:
    scale = colours_of(np.array([0.02, 3.0, np.nan]), PERIOD, log=True)
    assert isinstance(scale.norm, LogNorm)
    assert (scale.norm.vmin, scale.norm.vmax) == (0.02, 3.0)
    assert scale.cmap is cm.batlow
    # growth has the red half of the scale of its maps
    assert colours_of(np.array([3.0]), RATE, log=True).cmap(1.0) == pytest.approx(cm.vik(1.0))
    one = colours_of(np.array([5.0]), PERIOD, log=True).norm
    assert (one.vmin, one.vmax) == (5.0, 50.0)


@pytest.mark.parametrize(
    ("numbers", "ends", "linear", "places"),
    [
        ([-20.0, 0.02, 3.0], (-20, 20), 0.02, [-10, -1, -0.1, 0, 0.1, 1, 10]),
        ([0.0, 0.5, 30.0], (0, 30), 0.5, [0, 1, 10]),
        ([-30.0, -0.5], (-30, -0.5), 0.5, [-10, -1]),
        ([-1e-9, 5.0], (-5, 5), 5e-3, [-1, -0.1, -0.01, 0, 0.01, 0.1, 1]),
        ([0.0, 0.0], (0, 1), 1.0, [0, 1]),
        ([-0.7, -0.5], (-0.7, -0.5), 0.5, [-0.7, -0.5]),
        ([0.0, 0.7, 0.5], (0, 0.7), 0.5, [0, 0.7]),
    ],
)
def test_a_logarithmic_scale_passes_through_zero(
    numbers: list[float], ends: tuple[float, float], linear: float, places: list[float]
) -> None:
    """Cells of negative numbers stayed blank, and the legend did not say so."""
    scale = colours_of(np.array([*numbers, np.nan]), PERIOD, log=True)
    assert isinstance(scale.norm, AsinhNorm)
    assert (scale.norm.vmin, scale.norm.vmax) == ends
    assert scale.norm.linear_width == pytest.approx(linear)
    assert scale.places == pytest.approx(places)
    assert scale.cmap is (cm.vik if ends[0] == -ends[1] else cm.batlow)


@pytest.mark.parametrize(("ends", "within"), [((2, 19), True), ((2, 20), False), ((2, 300), False)])
def test_further_ticks_are_needed_within_a_decade(ends: tuple[float, float], within: bool) -> None:
    assert within_a_decade(LogNorm(*ends)) is within
