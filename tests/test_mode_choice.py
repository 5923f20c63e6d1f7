"""How many modes a case needs: by frequencies of the disc, and by growth rates."""

from typing import Any

import numpy as np
import pytest

from disc_model import Disc, Parameters, choose_modes, steady_sliding
from disc_model.mode_choice import RICH, UndecidedModes, error_of
from tests.blocks import STEEL
from tests.refusals import refusal

P = Parameters(N=385.0, Omega=15.1)
TABLE = Disc(diameters=range(8), omega=1000.0 + np.arange(1.0, 9), amplitude=np.ones(8))


@pytest.mark.parametrize(
    ("normalization", "tolerance", "size"),
    [("as_published", 1e-4, (5, 3)), ("orthonormal", 1e-2, (4, 0))],
)
def test_frequencies_meet_the_tolerance_with_the_fewest_modes(
    normalization: str, tolerance: float, size: tuple[int, int]
) -> None:
    p = P.replace(normalization=normalization, n_diameters=12)
    choice = choose_modes(p, tolerance)
    chosen = choice.parameters
    assert (chosen.n_diameters, chosen.n_circles) == size
    assert choice.error <= tolerance
    rich = p.replace(n_diameters=RICH[0], n_circles=RICH[1])
    smaller = chosen.replace(n_diameters=chosen.n_diameters - 1)
    assert error_of("frequencies", smaller, rich) > tolerance


@pytest.mark.parametrize(
    ("case", "options", "size", "real"),
    [
        (STEEL.replace(contact_arc=0.4), {"quantity": "sliding_growth"}, (10, 3), 84),
        pytest.param(
            Parameters(N=300, Omega=20, contact_compliance="residual"),
            {"quantity": "growth", "tolerance": 0.05}, (2, 0), 5,
            marks=[pytest.mark.slow, pytest.mark.compiled],
        ),
    ],
)  # fmt: skip
def test_growth_rates_converge(
    case: Parameters, options: dict[str, Any], size: tuple[int, int], real: int
) -> None:
    choice = choose_modes(case, **options)
    assert (choice.parameters.n_diameters, choice.parameters.n_circles) == size
    assert choice.modes == real
    assert choice.error <= options.get("tolerance", 1e-2)
    assert f"{real} real modes" in repr(choice)


def test_the_growth_rate_of_the_choice_is_that_of_many_modes() -> None:
    """3.48/s with up to 14 diameters and 20 circles."""
    chosen = choose_modes(STEEL.replace(contact_arc=0.4), quantity="sliding_growth").parameters
    assert steady_sliding(chosen).growth_rate == pytest.approx(3.479, rel=2e-2)


def test_first_modes_of_a_table_are_compared_with_all_of_them() -> None:
    low = TABLE.replace(omega=[*TABLE.omega[:2], *(1e5 * l for l in range(2, 8))])
    choice = choose_modes(P.replace(disc=low, r_0=0.1), 0.05)
    assert choice.parameters.disc == low.first(2)
    assert choice.modes == 3


@pytest.mark.parametrize("quantity", ["frequencies", "sliding_growth"])
@pytest.mark.parametrize("count", [1, 2, 8])
def test_a_whole_table_is_never_the_answer(count: int, quantity: str) -> None:
    """It was compared with itself, and its error given as 0."""
    case = P.replace(disc=TABLE.first(count), r_0=0.1)
    with pytest.raises(UndecidedModes, match="give a table with more modes"):
        choose_modes(case, quantity=quantity)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"quantity": "first_separation"}, "quantity='first_separation': .*growth"),
        ({"tolerance": 9e-5}, "tolerance=9e-05: must be >= 0.0001"),
        ({"tolerance": "small"}, "tolerance='small': must be"),
    ],
)
def test_wrong_arguments_are_refused(options: dict[str, Any], message: str) -> None:
    with refusal(message):
        choose_modes(P, **options)
