"""Colours of numbers on a map."""

import numpy as np
import pytest
import xarray as xr
from cmcrameri import cm
from matplotlib.colors import AsinhNorm, LogNorm

from disc_model.figures.colour_wishes import ColourWishes
from disc_model.figures.colours import colours_of, counted, growth_colours, growth_norm

PERIOD = xr.DataArray(0.0, name="period")
LOG = ColourWishes(log=True)


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
    scale = colours_of(np.array(numbers), PERIOD)
    assert (scale.norm.vmin, scale.norm.vmax) == ends
    assert scale.cmap is cmap


def test_each_of_few_counts_has_a_colour_of_its_own() -> None:
    counts = xr.DataArray([0, 2], name="releases")
    scale = colours_of(np.array([0, 2]), counts)
    assert scale.ticks == ["0", "1", "2"]
    colours = {scale.cmap(scale.norm(i)) for i in range(3)}
    assert len(colours) == 3
    assert colours_of(np.array([0, 11]), counts).ticks == [str(i) for i in range(12)]
    assert not colours_of(np.array([0, 12]), counts).ticks, "too many"
    middle = counted(4)
    assert middle.norm(1.4) == middle.norm(1)
    assert middle.norm(1.6) == middle.norm(2)


@pytest.mark.parametrize(
    ("numbers", "ends", "linear", "places"),
    [
        ([-20.0, 0.02, 3.0], (-20, 20), 0.02, [-20, -1, -0.1, 0, 0.1, 1, 20]),
        ([0.0, 0.5, 30.0], (0, 30), 0.5, [0, 1, 10, 30]),
        ([-30.0, -0.5], (-30, -0.5), 0.5, [-30, -10, -1, -0.5]),
        ([-1e-9, 5.0], (-5, 5), 5e-3, [-5, -1, -0.1, -0.01, 0, 0.01, 0.1, 1, 5]),
        ([0.0, 0.0], (0, 1), 1.0, [0, 1]),
        ([-0.7, -0.5], (-0.7, -0.5), 0.5, [-0.7, -0.5]),
        ([0.0, 0.7, 0.5], (0, 0.7), 0.5, [0, 0.7]),
        ([-1.13, -0.29], (-1.13, -0.29), 0.29, [-1.13, -0.29]),
    ],
)
def test_a_logarithmic_scale_passes_through_zero(
    numbers: list[float], ends: tuple[float, float], linear: float, places: list[float]
) -> None:
    """Cells of negative numbers stayed blank, and the legend did not say so."""
    scale = colours_of(np.array([*numbers, np.nan]), PERIOD, LOG)
    assert isinstance(scale.norm, AsinhNorm)
    assert (scale.norm.vmin, scale.norm.vmax) == ends
    assert scale.norm.linear_width == pytest.approx(linear)
    assert scale.places == pytest.approx(places)
    assert scale.cmap is (cm.vik if ends[0] == -ends[1] else cm.batlow)


DECAY = np.array([-1.13, -0.5, -0.29])
GROWTH = np.array([-0.2, 0.05, 0.1])


@pytest.mark.parametrize(
    ("rates", "wishes", "ends"),
    [
        (DECAY, ColourWishes(), (-1.13, 0.0)),
        (DECAY, ColourWishes(cmap="viridis"), (-1.13, -0.29)),
        (DECAY, ColourWishes(cmap="RdBu_r"), (-1.13, 0.0)),
        (DECAY, ColourWishes(log=True), (-1.13, -0.29)),
        (DECAY, ColourWishes(limits=(-1.0, -0.5)), (-1.0, -0.5)),
        (GROWTH, ColourWishes(), (-0.3, 0.3)),
        (GROWTH, ColourWishes(cmap="viridis"), (-0.2, 0.1)),
        (GROWTH, ColourWishes(cmap="RdBu_r"), (-0.3, 0.3)),
        (GROWTH, ColourWishes(log=True), (-0.3, 0.3)),
        (GROWTH, ColourWishes(limits=(-0.1, 0.6)), (-0.6, 0.6)),
        (GROWTH, ColourWishes(limits=(0.0, 0.6)), (0.0, 0.6)),
    ],
)
def test_growth_rates_fill_a_scale_that_is_not_around_zero(
    rates: np.ndarray, wishes: ColourWishes, ends: tuple[float, float]
) -> None:
    """Rates of one sign in other colours were one dark colour, and `log` changed nothing."""
    scale = growth_colours(rates, wishes)
    assert (scale.norm.vmin, scale.norm.vmax) == pytest.approx(ends)


def test_zeros_of_undamped_modes_do_not_set_the_scale_of_rates() -> None:
    """That of the explorer's maps left them out, that of figures did not."""
    rates = np.concatenate([np.zeros(120), np.linspace(1.0, 3.0, 100)])
    assert growth_norm(rates).vmax == growth_norm(rates[120:]).vmax


def test_limits_are_the_ends_of_any_scale_and_what_lies_beyond_is_said() -> None:
    numbers = np.array([1.0, 3.0, 20.0])
    scale = colours_of(numbers, PERIOD, ColourWishes(limits=(2.0, 30.0)))
    assert (scale.norm.vmin, scale.norm.vmax) == (2.0, 30.0)
    assert scale.open_ends == (True, False)
    assert colours_of(numbers, PERIOD).open_ends == (False, False)
    log = colours_of(numbers, PERIOD, ColourWishes(log=True, limits=(0.1, 100.0)))
    assert isinstance(log.norm, LogNorm)
    assert (log.norm.vmin, log.norm.vmax) == (0.1, 100.0)
