"""Bounds of parameters as texts with units."""

from collections.abc import Callable
from typing import Any

import pytest

import disc_model as dm
from tests.refusals import refusal

P = dm.Parameters(N=100, Omega=10)


@pytest.mark.parametrize(
    ("name", "bounds", "expected"),
    [
        ("N", ("0.1 kN", "150 N"), (100, 150)),
        ("k_p", ("20 N/mm", 3e4), (2e4, 3e4)),
        ("mu_s", ("0.35", "0.5"), (0.35, 0.5)),
    ],
)
def test_bounds_may_be_texts_with_units(
    name: str, bounds: tuple[Any, Any], expected: tuple[float, float]
) -> None:
    found = dm.critical(P, name, bounds, points=3)
    low, *_, high = found.values
    assert (low, high) == pytest.approx(expected, rel=1e-12)


MASSES = ("3 kg", "5 kg")
FUNCTIONS: list[Callable[[], Any]] = [
    lambda: dm.critical(P, "N", MASSES),
    lambda: dm.continue_cycle(P, "N", MASSES),
    lambda: dm.neutral_curves(P, {"N": MASSES, "mu_s": (0.3, 0.4)}, [0.35]),
]


@pytest.mark.parametrize("function", FUNCTIONS)
def test_a_unit_of_another_kind_is_told(function: Callable[[], Any]) -> None:
    with refusal("='3 kg': must be a number in N, or with a unit of its kind"):
        function()
