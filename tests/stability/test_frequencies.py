"""Frequencies of steady sliding against another eigenproblem, those of the cycle against its return
map."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from disc_model import Parameters, coupled_natural_frequencies, floquet, plate_modes
from disc_model.analysis.spectra import modes_at_rest, nearest_resonance
from disc_model.stability.frequencies import frequencies, may_be_near

BASE = Parameters(N=385, Omega=14)
SMALL = Parameters(N=200, Omega=20, n_diameters=1)


@pytest.mark.parametrize("normalization", ["as_published", "orthonormal"])
def test_at_low_speed_sliding_has_the_frequencies_at_rest(normalization: str) -> None:
    """Those of the symmetric eigenproblem of Section 4.4, and that of the slider on its spring in
    the plane."""
    p = Parameters(N=1e-3, Omega=1e-3, D_star=0, mu_s=0, mu_k=0, normalization=normalization)
    _, found, _ = frequencies(p)
    expected = np.append(coupled_natural_frequencies(p), math.sqrt(p.k_p / p.m)) / (2 * math.pi)
    # modes are shifted by up to l Omega / 2 pi = 6e-4 Hz
    np.testing.assert_allclose(found.frequency, np.sort(expected), atol=1e-3)
    assert found.diameters[0] == -1


def test_a_light_slider_sees_waves_that_turn_with_and_against_it() -> None:
    """Without force and mass of the slider: f -/+ l Omega / 2 pi, with it and against it."""
    p = Parameters(N=1e-6, Omega=30, m=1e-9, k=1e-6, k_p=1e-9, D_star=0, mu_s=0, mu_k=0)
    _, found, _ = frequencies(p)
    modes = plate_modes(p)
    turns = p.Omega / math.tau
    expected = {}
    for mode in modes.query("diameters > 0").itertuples():
        for side in (-1, 1):
            shift = side * mode.diameters * turns
            expected[int(mode.diameters), side] = mode.omega / math.tau - shift
    for i, l in enumerate(found.diameters.tolist()):
        if l > 0:
            side = -1
            if found.forward[i] > 0.5:
                side = 1
            frequency = expected.pop((l, side))
            assert found.frequency[i] == pytest.approx(frequency, abs=1e-4)
    assert not expected


@pytest.mark.parametrize(
    "p", [SMALL, pytest.param(BASE, marks=pytest.mark.compiled)], ids=["small", "base"]
)
def test_frequencies_and_growth_rates_are_those_of_the_multipliers(p: Parameters) -> None:
    """exp((g + 2 pi i f) T) is a multiplier of each mode, and its conjugate; none is left."""
    cycle, modes, (frequency, growth_rate, mac) = frequencies(p)
    here = modes.diameters >= 0
    complex_rate = growth_rate[here] + 2j * math.pi * frequency[here]
    own = np.exp(complex_rate * cycle.period)
    both = np.concatenate([own, own.conj()])
    apart = np.abs(both[:, None] - cycle.multipliers[None, :])
    rows, columns = linear_sum_assignment(apart)
    assert len(columns) == len(cycle.multipliers)
    assert apart[rows, columns].max() < 1e-9
    assert np.isnan(frequency[~here]).all()
    # away from resonances the cycle's modes are those of sliding: 0.1 Hz of what is apart by f_s /
    # 2 = 33 Hz
    np.testing.assert_allclose(frequency[here], modes.frequency[here], atol=0.2)
    assert mac[here].min() > 0.9


@pytest.mark.parametrize(("shift", "diameters", "sign"), [(0.0, 1, 0), (1.0, 2, 1), (-1.0, 2, -1)])
def test_a_multiplier_is_given_the_mode_that_turns_it(shift, diameters, sign):
    """A mode of frequency f, seen at f + shift l Omega / 2 pi, turns the multiplier by that times
    the period."""
    period = 0.0148
    frequencies_at_rest = {}
    for at_rest, l, moves_slider in modes_at_rest(BASE):
        frequencies_at_rest.setdefault((l, moves_slider), at_rest)
    frequency = frequencies_at_rest[diameters, shift == 0]
    seen = frequency + shift * diameters * BASE.Omega / math.tau
    multiplier = cmath.exp(1j * math.tau * seen * period)
    resonance = nearest_resonance(BASE, period, multiplier, diameters)
    assert resonance.frequency == pytest.approx(frequency)
    assert resonance.diameters == diameters
    assert resonance.sign == sign
    assert resonance.label.startswith(f"{resonance.harmonic:g} f_s = {frequency:.2f} Hz")
    shift_text = {1: f"+ {diameters} Ω/2π", -1: f"- {diameters} Ω/2π", 0: " Hz"}[sign]
    assert resonance.label.endswith(shift_text)


@pytest.mark.compiled
def test_of_two_real_multipliers_a_mode_grows_by_the_larger() -> None:
    """Just before a fold a pair has met on the real axis: a mode turns twice in a period."""
    cycle, modes, (frequency, growth_rate, _) = frequencies(BASE.replace(Omega=15.0949))
    real = np.sort(cycle.multipliers[cycle.multipliers.imag == 0].real)
    assert real.round(3).tolist() == [0.982, 1.0]
    smaller, larger = np.log(real) / cycle.period
    mode = np.nanargmax(growth_rate)
    assert growth_rate[mode] == pytest.approx(larger, rel=1e-9)
    assert np.nanmin(np.abs(growth_rate - smaller)) > 0.1
    assert frequency[mode] * cycle.period == pytest.approx(2, abs=1e-12)
    assert abs(frequency[mode] - modes.frequency[mode]) < 0.5


@pytest.mark.compiled
@pytest.mark.parametrize(("growth", "near"), [(35, True), (39, False)])
def test_growth_is_counted_over_the_returns_of_the_motion(growth: float, near: bool) -> None:
    """Up to a factor of e^37 in the 300 returns after which the motion is compared with the cycle."""
    cycle = floquet(Parameters(N=260, Omega=19))
    assert may_be_near(replace(cycle, growth_rate=growth / (300 * cycle.period))) is near
