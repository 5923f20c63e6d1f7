"""Resonances that multipliers pass between two points, of multipliers made up by modulus and angle."""

import numpy as np
import pytest

from disc_model.stability.continuation.spectrum import Passing, passings, turns_of


def multipliers(moduli: list[float], angles: list[float]) -> np.ndarray:
    return np.array(moduli) * np.exp(1j * np.array(angles))


def test_the_width_of_a_resonance_of_two_is_the_sum_of_their_dampings() -> None:
    """The first overtakes the second, at 0.1 of its 0.19 rad; the later point is the nearer one."""
    before = multipliers([0.9, 0.99], [1.0, 1.1])
    same = multipliers([0.9, 0.99], [1.2, 1.11])
    [found] = passings(turns_of(before, same))
    expected = Passing(share=0.1 / 0.19, distance=0.09, width=0.11, forced=False)
    assert tuple(found) == pytest.approx(tuple(expected), rel=1e-9)

    # dampings are those of the nearer point
    later = multipliers([0.92, 0.985], [1.2, 1.11])
    [found] = passings(turns_of(before, later))
    assert found.width == pytest.approx(0.08 + 0.015, rel=1e-9)
    sooner = multipliers([0.92, 0.985], [1.3, 1.11])
    [found] = passings(turns_of(before, sooner))
    assert found.distance == pytest.approx(0.1, rel=1e-9)
    assert found.width == pytest.approx(0.11, rel=1e-9)


@pytest.mark.parametrize(
    ("start", "end", "forced"), [(0.02, -0.04, True), (np.pi - 0.02, np.pi + 0.04, False)]
)
def test_a_multiplier_passes_its_conjugate_at_one_or_at_minus_one(
    start: float, end: float, forced: bool
) -> None:
    """The cycle itself responds at 1 only; the sum is twice the angle."""
    [found] = passings(turns_of(multipliers([0.9], [start]), multipliers([0.8], [end])))
    expected = Passing(share=1 / 3, distance=0.04, width=0.2, forced=forced)
    assert tuple(found) == pytest.approx(tuple(expected), rel=1e-9)


def test_strongly_damped_multipliers_pass_nothing() -> None:
    before = multipliers([0.49, 0.99], [1.0, 1.1])
    after = multipliers([0.9, 0.99], [1.2, 1.11])
    assert passings(turns_of(before, after)) == []
