"""How many modes a case needs: by frequencies of the disc, and by growth rates."""

from typing import Any

import pytest

from disc_model import Disc, Parameters, choose_modes, steady_sliding
from disc_model.mode_choice import RICH, UndecidedModes, error_of
from tests.blocks import STEEL
from tests.refusals import refusal

P = Parameters(N=385.0, Omega=15.1)


@pytest.mark.parametrize(
    ("normalization", "tolerance", "size"),
    [("as_published", 1e-4, (5, 3)), ("orthonormal", 1e-2, (4, 0))],
)
def test_frequencies_meet_the_tolerance_with_the_fewest_modes(
    normalization: str, tolerance: float, size: tuple[int, int]
) -> None:
    p = P.replace(normalization=normalization, n_diameters=12)
    chosen = choose_modes(p, tolerance)
    assert (chosen.n_diameters, chosen.n_circles) == size
    rich = p.replace(n_diameters=RICH[0], n_circles=RICH[1])
    smaller = chosen.replace(n_diameters=chosen.n_diameters - 1)
    assert error_of("frequencies", chosen, rich) <= tolerance
    assert error_of("frequencies", smaller, rich) > tolerance


@pytest.mark.parametrize(
    ("case", "options", "size"),
    [
        (STEEL.replace(contact_arc=0.4), {"quantity": "sliding_growth"}, (10, 3)),
        pytest.param(
            Parameters(N=300, Omega=20, contact_compliance="residual"),
            {"quantity": "growth", "tolerance": 0.05}, (2, 0),
            marks=[pytest.mark.slow, pytest.mark.compiled],
        ),
    ],
)  # fmt: skip
def test_growth_rates_converge(
    case: Parameters, options: dict[str, Any], size: tuple[int, int]
) -> None:
    chosen = choose_modes(case, **options)
    assert (chosen.n_diameters, chosen.n_circles) == size


def test_the_growth_rate_of_the_choice_is_that_of_many_modes() -> None:
    """3.48/s with up to 14 diameters and 20 circles."""
    chosen = choose_modes(STEEL.replace(contact_arc=0.4), quantity="sliding_growth")
    assert steady_sliding(chosen).growth_rate == pytest.approx(3.479, rel=2e-2)


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


def test_a_table_is_refused() -> None:
    disc = Disc(diameters=[0], omega=[1e3], amplitude=[1.0])
    with refusal("disc=.*: must be left out: modes of a plate are chosen"):
        choose_modes(P.replace(disc=disc))


def test_friction_on_the_surface_at_a_point_converges_with_no_number_of_modes() -> None:
    with pytest.raises(UndecidedModes, match="at a point does not converge: give contact_arc"):
        choose_modes(STEEL, quantity="sliding_growth")
