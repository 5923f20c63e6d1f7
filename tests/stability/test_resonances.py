"""Resonances: frequencies at rest, and the one that a multiplier belongs to."""

import cmath
import math

import numpy as np
import pytest

from disc_model import Parameters, coupled_natural_frequencies
from disc_model.stability.resonances import modes_at_rest, nearest_resonance

P = Parameters(N=385, Omega=15)


def test_modes_at_rest_are_the_frequencies_with_the_slider_attached():
    found = modes_at_rest(P)
    np.testing.assert_allclose(
        [2 * math.pi * frequency for frequency, _, _ in found], coupled_natural_frequencies(P), rtol=1e-9
    )
    assert sum(bound for _, _, bound in found) == 5
    assert [l for _, l, bound in found if not bound] == [1, 2, 3, 4]


@pytest.mark.parametrize(("shift", "diameters", "sign"), [(0.0, 1, 0), (1.0, 2, 1), (-1.0, 2, -1)])
def test_a_multiplier_is_given_the_mode_that_turns_it(shift, diameters, sign):
    """A mode of frequency f, seen at f + shift l Omega / 2 pi, turns the multiplier by that times the period."""
    period = 0.0148
    frequency = next(f for f, l, bound in modes_at_rest(P) if l == diameters and bound == (shift == 0))
    seen = frequency + shift * diameters * P.Omega / (2 * math.pi)
    resonance = nearest_resonance(P, period, cmath.exp(2j * math.pi * seen * period))
    assert (resonance.frequency, resonance.diameters, resonance.sign) == (pytest.approx(frequency), diameters, sign)
    assert resonance.detuning == pytest.approx(resonance.harmonic / period - seen)
    assert resonance.label.startswith(f"{resonance.harmonic:g} f_s = {frequency:.2f} Hz")
    assert resonance.label.endswith(f"{'+' if sign > 0 else '-'} {diameters} Ω/2π") == (sign != 0)
