"""Colours of numbers on a map."""

import numpy as np
import pytest
import xarray as xr
from cmcrameri import cm
from matplotlib import colormaps
from matplotlib.colors import AsinhNorm, LogNorm

from disc_model.figures.colour_wishes import ColourWishes, is_diverging
from disc_model.figures.colours import (
    colours_of,
    counted,
    growth_colours,
    growth_norm,
    within_a_decade,
)

RATE = xr.DataArray(0.0, name="growth_rate")
PERIOD = xr.DataArray(0.0, name="period")
LOG = ColourWishes(log=True)
RATES_SHOWN = [-0.3, -0.1, -0.03, -0.01, 0, 0.01, 0.03, 0.1, 0.3]


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


@pytest.mark.parametrize("number", [0.0, 3.0, -2.5])
def test_the_bar_of_a_single_number_names_it_alone(number: float) -> None:
    scale = colours_of(np.array([number, np.nan, number]), PERIOD)
    assert scale.places == [number]
    assert scale.norm(number) == pytest.approx(0.5)


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


def test_a_logarithmic_scale_of_positive_numbers_ends_at_them() -> None:
    scale = colours_of(np.array([0.02, 3.0, np.nan]), PERIOD, LOG)
    assert isinstance(scale.norm, LogNorm)
    assert (scale.norm.vmin, scale.norm.vmax) == (0.02, 3.0)
    assert scale.cmap is cm.batlow
    # growth has the red half of the scale of its maps
    assert colours_of(np.array([3.0]), RATE, LOG).cmap(1.0) == pytest.approx(cm.vik(1.0))
    one = colours_of(np.array([5.0]), PERIOD, LOG).norm
    assert (one.vmin, one.vmax) == (5.0, 50.0)


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


@pytest.mark.parametrize(("ends", "within"), [((2, 19), True), ((2, 20), False), ((2, 300), False)])
def test_steps_within_a_decade_are_even(ends: tuple[float, float], within: bool) -> None:
    assert within_a_decade(LogNorm(*ends)) is within


@pytest.mark.parametrize(
    ("ends", "places"),
    [
        ((0.27, 10), [0.27, 0.5, 1, 2, 5, 10]),
        ((2, 90), [2, 5, 10, 20, 50, 90]),
        ((1, 10), [1, 2, 5, 10]),
        ((2, 19), [2, 5, 10, 15, 19]),
        ((385, 402), [385, 390, 395, 400, 402]),
        ((1, 100), []),
    ],
)
def test_few_powers_of_ten_have_the_ends_and_steps_between_them(
    ends: tuple[float, float], places: list[float]
) -> None:
    """Periods of 0.27 to 10 s had the numbers 1 and 10 alone, and those of 0.27 to 2 s none at their ends."""
    assert colours_of(np.array(ends), PERIOD, LOG).places == pytest.approx(places)


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


@pytest.mark.parametrize(
    ("rates", "places", "open_ends"),
    [
        ([0.002, 0.2], [0, 0.01, 0.03, 0.1, 0.3], (False, False)),
        ([-0.002, -0.2], [-0.3, -0.1, -0.03, -0.01, 0], (False, False)),
        ([1e-12, -0.2], [-0.3, -0.1, -0.03, -0.01, 0], (False, False)),
        ([-0.2, 0.01], RATES_SHOWN, (False, False)),
        ([0.01, 0.02, 44.0], [0, 0.01, 0.03, 0.1, 0.3], (False, True)),
        ([-5.0, 0.01, 0.02], RATES_SHOWN, (True, False)),
        ([0.05, 0.05], [0, 0.01, 0.03, 0.1, 0.3], (False, False)),
        ([0.0, 0.0], RATES_SHOWN, (False, False)),
        ([np.nan, -0.05], [-0.3, -0.1, -0.03, -0.01, 0], (False, False)),
        ([0.9, 1.0, 1.1], [0, 0.1, 0.3, 1.1], (False, False)),
    ],
)
def test_the_bar_of_growth_rates_has_the_signs_that_they_have(
    rates: list[float], places: list[float], open_ends: tuple[bool, bool]
) -> None:
    """It went as far to the other side, had no numbers at its ends, and arrows beyond which no rate lay."""
    scale = growth_colours(np.array(rates))
    assert scale.places == pytest.approx(places)
    assert scale.open_ends == open_ends


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rates_of_one_sign_have_the_colours_that_they_have_beside_others(sign: float) -> None:
    rates = sign * np.array([0.0, 0.01, 0.1, 0.2])
    alone = growth_colours(rates)
    beside = growth_colours(np.append(rates, -0.1 * sign))
    for rate in rates:
        colour = alone.cmap(alone.norm(rate))
        assert colour == pytest.approx(beside.cmap(beside.norm(rate)), abs=0.02)


def test_the_half_of_other_colours_has_a_neutral_zero() -> None:
    scale = growth_colours(DECAY, ColourWishes(cmap="RdBu_r"))
    middle = colormaps.get_cmap("RdBu_r")(0.5)
    assert scale.cmap(scale.norm(0.0)) == pytest.approx(middle, abs=0.02)


def test_limits_that_begin_at_zero_have_a_neutral_zero() -> None:
    scale = growth_colours(GROWTH, ColourWishes(limits=(0.0, 0.08)))
    assert scale.cmap(scale.norm(0.0)) == pytest.approx(cm.vik(0.5), abs=0.02)
    assert scale.places[-1] == 0.08
    assert scale.open_ends == (True, True)
    assert growth_colours(GROWTH, ColourWishes(limits=(0.0, 0.6))).open_ends == (True, False)


def test_zeros_of_undamped_modes_do_not_set_the_scale_of_rates() -> None:
    """That of the explorer's maps left them out, that of figures did not."""
    rates = np.concatenate([np.zeros(120), np.linspace(1.0, 3.0, 100)])
    assert growth_norm(rates).vmax == growth_norm(rates[120:]).vmax


def test_a_logarithmic_scale_of_decays_differs_from_a_linear_one() -> None:
    linear, log = (
        growth_colours(DECAY, ColourWishes(log=log, cmap="viridis")) for log in (False, True)
    )
    assert linear.norm(-0.5) == pytest.approx((1.13 - 0.5) / (1.13 - 0.29))
    # nearly that of the logarithms, which is 0.60
    assert log.norm(-0.5) < linear.norm(-0.5) - 0.05


def test_limits_are_the_ends_of_any_scale_and_what_lies_beyond_is_said() -> None:
    numbers = np.array([1.0, 3.0, 20.0])
    scale = colours_of(numbers, PERIOD, ColourWishes(limits=(2.0, 30.0)))
    assert (scale.norm.vmin, scale.norm.vmax) == (2.0, 30.0)
    assert scale.open_ends == (True, False)
    assert colours_of(numbers, PERIOD).open_ends == (False, False)
    log = colours_of(numbers, PERIOD, ColourWishes(log=True, limits=(0.1, 100.0)))
    assert isinstance(log.norm, LogNorm)
    assert (log.norm.vmin, log.norm.vmax) == (0.1, 100.0)


@pytest.mark.parametrize(
    ("name", "diverges"),
    [
        ("RdBu_r", True),
        ("coolwarm", True),
        ("cmc.vik", True),
        ("cmc.berlin", True),
        ("viridis", False),
        ("gray", False),
        ("cmc.batlow", False),
        ("Reds", False),
    ],
)
def test_diverging_colours_have_a_middle(name: str, diverges: bool) -> None:
    assert is_diverging(colormaps.get_cmap(name)) is diverges


def test_counts_have_colours_of_the_whole_of_another_map() -> None:
    """The first colours of 256 stood for them, which were all dark."""
    scale = counted(3, "viridis")
    viridis = colormaps.get_cmap("viridis")
    assert scale.cmap(scale.norm(2)) == pytest.approx(viridis(2 / 3))
