"""Lines, their names, and spectra in time, for signals made of known lines."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from disc_model.analysis import spectra
from disc_model.disc.modes import coupled_natural_frequencies
from disc_model.parameters import Parameters

RATE = 4000.0
TIME = 3.0 + np.arange(40_000) / RATE
F_S = 67.63
F_DRIVE = 2.4032
KNOWN = {F_DRIVE: 1.0, F_S - F_DRIVE: 3e-2, F_S + F_DRIVE: 2e-2, 2 * F_S - F_DRIVE: 1e-2}


def signal(parts: dict[float, float]) -> np.ndarray:
    waves = [a * np.cos(2 * np.pi * f * TIME + i) for i, (f, a) in enumerate(parts.items())]
    return np.sum([np.full(TIME.shape, 0.7), *waves], axis=0)


@pytest.mark.parametrize(
    ("parts", "options", "expected"),
    [
        (KNOWN, {}, KNOWN),
        (KNOWN, {"apart": 1e-9}, KNOWN),
        ({100.0: 1.0, 300.0: 5e-4, 700.0: 1e-4}, {"above": 200.0, "floor": 0.3}, {300.0: 5e-4}),
        # side lobes of the window are no lines
        ({60.03: 2.0, 110.0: 2e-4}, {"floor": 0.0, "below": 1000.0}, {60.03: 2.0, 110.0: 2e-4}),
        ({60.03: 2.0, 110.0: 2e-5}, {"floor": 0.0, "below": 1000.0}, {60.03: 2.0}),
    ],
)
def test_lines_are_found_with_frequency_and_amplitude(
    parts: dict[float, float], options: dict[str, float], expected: dict[float, float]
) -> None:
    found = dict(spectra.lines(TIME, signal(parts), **options))
    assert [*found] == pytest.approx([*expected], abs=0.01)
    assert [*found.values()] == pytest.approx([*expected.values()], rel=0.02)


@pytest.mark.parametrize("kind", [pd.Series, xr.DataArray, list])
def test_samples_may_be_of_any_kind(kind: Callable[[np.ndarray], Any]) -> None:
    time = kind(TIME[1000:])
    values = kind(signal(KNOWN)[1000:])
    if kind is pd.Series:  # the rows of a part of a table do not begin at 0
        time.index += 1000
        values.index += 1000
    plain = (np.asarray(time), np.asarray(values))
    for function in (spectra.lines, spectra.time_frequency):
        np.testing.assert_array_equal(function(time, values)[-1], function(*plain)[-1])


def test_the_main_vibration_has_its_share_of_the_variance() -> None:
    values = signal({135.42: 3.0, 270.9: 1.0})
    found = spectra.main_frequency(TIME, values)
    assert found == pytest.approx(135.42, abs=5e-3)
    assert spectra.share_at(TIME, values, found) == pytest.approx(0.9, abs=5e-3)
    assert spectra.share_at(TIME, values, 270.9) == pytest.approx(0.1, abs=1e-3)
    with pytest.raises(ValueError, match="no line"):
        spectra.main_frequency(TIME, np.full(TIME.size, 0.7))


@pytest.mark.parametrize(
    ("time", "values", "fault"),
    [
        (np.delete(TIME, 20_000), TIME[1:], "time: must rise in even steps"),
        (TIME[::-1], TIME, "time: must rise in even steps"),
        (np.where(TIME[5] == TIME, np.nan, TIME), TIME, "time: must rise in even steps"),
        (TIME, np.where(TIME[5] == TIME, np.nan, TIME), "values: must be finite"),
        (TIME[1:], TIME, "must be two or more, one for each time"),
    ],
)
def test_a_measured_signal_with_gaps_is_refused(time: Any, values: Any, fault: str) -> None:
    for spectrum in (spectra.lines, spectra.time_frequency):
        with pytest.raises(ValueError, match=fault):
            spectrum(time, values)


@pytest.mark.parametrize(
    ("n", "m", "name"),
    [
        (0, 1, "f_Ω"), (0, 2, "2 f_Ω"), (1, -1, "f_s − f_Ω"), (1, 1, "f_s + f_Ω"),
        (3, 0, "3 f_s"), (4, -1, "4 f_s − f_Ω"), (12, 3, "12 f_s + 3 f_Ω"), (5, -3, "5 f_s − 3 f_Ω"),
    ],
)  # fmt: skip
def test_lines_are_named(n: int, m: int, name: str) -> None:
    found = spectra.identify(n * F_S + m * F_DRIVE + 0.1, F_S, F_DRIVE)
    assert (found.n, found.m, str(found)) == (n, m, name)
    assert found.deviation == pytest.approx(0.1)


def test_of_names_that_fit_alike_the_one_of_the_smallest_orders_is_taken() -> None:
    """f_s + 3 f_drive and 2 f_s - 3 f_drive are 0.0006 Hz apart."""
    assert spectra.identify(8.9999, 6.0, 1.0001)[:2] == (1, 3)


def test_time_frequency_follows_a_chirp() -> None:
    t = TIME - TIME[0]
    found = spectra.time_frequency(
        TIME, 3 * np.cos(2 * np.pi * (100 * t + 10 * t**2)), window=0.25, hop=0.05
    )
    ridge = found.frequency[np.argmax(found.power, axis=0)]
    assert ridge == pytest.approx(100 + 20 * (found.time - TIME[0]), abs=4)
    assert found.time[0] == pytest.approx(TIME[0] + 0.125, abs=0.05)


def test_a_sine_of_amplitude_one_has_the_power_one_half() -> None:
    found = spectra.time_frequency(TIME, np.sin(2 * np.pi * 100 * TIME))
    np.testing.assert_allclose(found.power.max(axis=0), 0.5, rtol=1e-6)


def test_the_shortest_record_of_a_spectrum_in_time_is_a_window_and_two_steps() -> None:
    time = np.arange(110) / 100
    assert spectra.time_frequency(time, time).time[0] >= 0.5
    with pytest.raises(ValueError, match=r"^1\.09 s of samples are too few"):
        spectra.time_frequency(time[1:], time[1:])


# ---- resonances

P = Parameters(N=385, Omega=15.0)
TURN = P.Omega / (2 * np.pi)


def test_modes_at_rest_are_those_of_disc_and_slider_together() -> None:
    found = spectra.modes_at_rest(P)
    every = [mode.frequency for mode in found]
    assert every == pytest.approx(coupled_natural_frequencies(P) / (2 * np.pi), rel=1e-12)
    assert [mode.diameters for mode in found if not mode.bound] == [1, 2, 3, 4]
    assert [mode.diameters for mode in found] == [1, 0, 1, 2, 2, 3, 3, 4, 4]


@pytest.mark.parametrize(
    ("bound", "diameters", "sign", "harmonic"),
    [(False, 2, -1, 2), (False, 2, 1, 2), (True, 1, 0, 2), (True, 0, 0, 3), (True, 0, 0, 2.5)],
)
@pytest.mark.parametrize("detuning", [0.4, -0.7])
def test_the_resonance_of_a_multiplier(
    bound: bool, diameters: int, sign: int, harmonic: float, detuning: float
) -> None:
    """Its multiple of the rate lies beside the mode in the slider's frame."""
    kind = (bound, diameters)
    mode = next(m for m in spectra.modes_at_rest(P) if (m.bound, m.diameters) == kind)
    seen = mode.frequency + sign * diameters * TURN
    period = harmonic / (seen + detuning)
    multiplier: complex = np.exp(2j * np.pi * seen * period)
    if harmonic % 1:  # a period doubling
        multiplier = complex(-1)
    found = spectra.nearest_resonance(P, period, complex(multiplier), diameters)
    assert (found.harmonic, found.diameters, found.sign) == (harmonic, diameters, sign)
    assert found.frequency == mode.frequency
    side = {-1: " - 2 Ω/2π", 0: "", 1: " + 2 Ω/2π"}[sign]
    assert found.label == f"{harmonic:g} f_s = {mode.frequency:.2f} Hz{side}"
