"""The scales of growth rates in the explorer: nobody takes a logarithmic one for linear."""

import itertools

import pytest

from tests import needs
from tests.explorer.test_finding import Open, opened
from tests.explorer.test_page import contents

__all__ = ["opened"]  # a fixture

pytestmark = [pytest.mark.slow, needs.BROWSER.mark]

SCALE = {"width": 0.01, "end": 0.3}
HEIGHT = 380  # pixels, of the axis in a usual window
LOW = 200  # and in a telephone


def as_numbers(words: list[str]) -> list[float]:
    """Numbers that are written on an axis."""
    found = []
    for word in words:
        mantissa, _, power = word.replace("−", "-").partition("·10")
        plain = power.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
        found.append(float(f"{mantissa}e{plain or 0}"))
    return found


def test_rates_within_a_decade_have_a_linear_axis(opened: Open) -> None:
    """A rate of 0.0571 1/s was read as 0.028, halfway on an unlabelled logarithmic scale."""
    with opened(contents()) as shown:
        for rates in ([-0.012, 0.0571], [0.0, 0.1], [-0.1, -0.02], [2.0, 15.0], [-40.0, -5.0]):
            words, is_linear = shown.ask("wordsOfRates", rates, SCALE, HEIGHT)
            assert is_linear, rates
            assert len(words) >= 3


def test_a_logarithmic_part_of_an_axis_has_three_numbers(opened: Open) -> None:
    """It had those of decades alone, and none at its ends."""
    with opened(contents()) as shown:
        cases = ([-0.2, 0.3], [-0.011, 0.4], [-3.0, 0.004], [0.05, 44.4], [-44.4, -1e-12])
        wide = ([-1e-5, 700.0], [0.0, 0.11], [-0.002, 0.12], [-1e-12, 1e4])
        for rates, height in itertools.product((*cases, *wide), (HEIGHT, LOW)):
            words, is_linear = shown.ask("wordsOfRates", rates, SCALE, height)
            numbers = as_numbers(words)
            assert not is_linear, rates
            assert numbers == sorted(numbers, reverse=True)
            assert numbers[-1] <= rates[0] + 1e-9, "a number at the lower end"
            assert numbers[0] >= rates[1] - 1e-9, "and at the upper one"
            for sign in (1, -1):
                beyond = [number for number in numbers if sign * number >= SCALE["width"]]
                is_shown = max(sign * rate for rate in rates) > SCALE["width"]
                assert len(beyond) >= 3 * is_shown, (rates, height, words)


def test_a_narrow_range_beyond_a_decade_has_twos_and_fives(opened: Open) -> None:
    with opened(contents()) as shown:
        words, _ = shown.ask("wordsOfRates", [-0.011, 0.16], SCALE, HEIGHT)
    expected = [0.2, 0.1, 0.05, 0.02, 0.01, 0.0, -0.01, -0.02, -0.05]
    assert as_numbers(words) == expected


def test_bars_of_rates_have_three_numbers_beyond_their_linear_part(opened: Open) -> None:
    with opened(contents()) as shown:
        cases = (([0.001, 0.1], 0.12), ([-0.1, -0.01], 0.12), ([-0.2, 0.2], 0.3))
        for rates, end in cases:
            scale = {**SCALE, "end": end}
            words = as_numbers(shown.ask("wordsOfBar", rates, scale))
            assert words == sorted(words)
            for sign in {1 if rate > 0 else -1 for rate in rates}:
                beyond = [number for number in words if sign * number >= SCALE["width"]]
                assert len(beyond) >= 3, (rates, words)
                assert max(beyond, key=abs) == sign * end, "the end"


def test_lines_over_decades_have_numbers_at_both_ends(opened: Open) -> None:
    ticks = "return scaleOfHeights({}, arguments[0]).ticks().map(([, text]) => text)"
    with opened(contents()) as shown:
        words = shown.page.run(ticks, [3.0, 40.0, 450.0])
    assert sorted(as_numbers(words)) == [2, 5, 10, 20, 50, 100, 200, 500]


def test_a_bar_of_large_rates_has_both_signs_of_a_number_and_zero(opened: Open) -> None:
    """In a narrow window it had -0.1 in the place of zero, and not 0.1."""
    with opened(contents()) as shown:
        words = as_numbers(shown.ask("wordsOfBar", [-9.0, 9.0], {"width": 0.3, "end": 9.0}))
    assert 0 in words
    assert words == [-word for word in reversed(words)]
