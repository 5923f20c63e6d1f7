"""Resonances: frequencies at rest, and lines along which the stick-slip rate meets them."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from disc_model import ParameterError, Parameters, slider_at_rest_frequencies
from disc_model.stability.resonances import modes_at_rest, nearest_tongue, rigid_period, tongue_lines

P = Parameters(N=385, Omega=15)


def test_modes_at_rest_are_the_frequencies_with_the_slider_attached():
    found = modes_at_rest(P)
    np.testing.assert_allclose(
        [2 * math.pi * frequency for frequency, _, _ in found], slider_at_rest_frequencies(P), rtol=1e-9
    )
    assert sum(bound for _, _, bound in found) == 5
    assert [l for _, l, bound in found if not bound] == [1, 2, 3, 4]


def test_rigid_period_is_that_of_one_degree_of_freedom():
    """Slip from the release to rest, integrated; then stick until the spring is as tense again."""
    released, kinetic = (mu * P.N / (P.r_0 * P.k_p) for mu in (P.mu_s, P.mu_k))

    def rate(_, y):
        return [P.Omega - y[1], P.k_p / P.m * (y[0] - kinetic)]

    def at_rest(t, y):
        return y[1] if t > 1e-4 else 1.0

    at_rest.terminal = True
    slip = solve_ivp(rate, (0, 1), [released, 0.0], events=at_rest, rtol=1e-11, atol=1e-12)
    stick = (released - slip.y[0, -1]) / P.Omega
    assert rigid_period(P) == pytest.approx(slip.t[-1] + stick, rel=1e-8)


def test_lines_are_where_the_rate_meets_a_shifted_frequency():
    lines = tongue_lines(P, np.array([300.0, 385.0]), (5.0, 50.0), diameters=1, harmonics=3)
    assert {line.sign for line in lines} == {-1, 0, 1}
    assert {line.diameters for line in lines} == {1}
    for line in lines:
        for Omega, N in zip(line.Omega, line.N, strict=True):
            rate = 1 / rigid_period(P.replace(N=N, Omega=Omega))
            shifted = line.frequency + line.sign * line.diameters * Omega / (2 * math.pi)
            assert line.harmonic * rate == pytest.approx(shifted, rel=1e-9)
    every = tongue_lines(P, np.array([385.0]), (5.0, 50.0), harmonics=6)
    assert {line.diameters for line in every} >= {0, 1, 2}


@pytest.mark.parametrize(("shift", "diameters", "sign"), [(0.0, 1, 0), (1.0, 2, 1), (-1.0, 2, -1)])
def test_a_multiplier_is_given_the_mode_that_turns_it(shift, diameters, sign):
    """A mode of frequency f, seen at f + shift l Omega / 2 pi, turns the multiplier by that times the period."""
    period = 0.0148
    frequency = next(f for f, l, bound in modes_at_rest(P) if l == diameters and bound == (shift == 0))
    seen = frequency + shift * diameters * P.Omega / (2 * math.pi)
    tongue = nearest_tongue(P, period, cmath.exp(2j * math.pi * seen * period))
    assert (tongue.frequency, tongue.diameters, tongue.sign) == (pytest.approx(frequency), diameters, sign)
    assert tongue.detuning == pytest.approx(tongue.harmonic / period - seen)
    assert tongue.label.startswith(f"{tongue.harmonic:g} f_s = {frequency:.2f} Hz")
    assert tongue.label.endswith(f"{'+' if sign > 0 else '-'} {diameters} Ω/2π") == (sign != 0)


def test_a_negative_real_multiplier_is_a_half_harmonic():
    assert nearest_tongue(P, 0.0148, -1.0 + 0j, 1).harmonic % 1 == 0.5
    with pytest.raises(ParameterError, match="diameters=9: must be those of a mode"):
        nearest_tongue(P, 0.0148, 1.0 + 0j, 9)
