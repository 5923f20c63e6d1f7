"""Lines, their names, and spectra in time, for signals made of known lines."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from disc_model.analysis import spectra
from disc_model.disc.modes import coupled_natural_frequencies, plate_modes
from disc_model.parameters import Parameters

RATE = 4000.0
TIME = 3.0 + np.arange(40_000) / RATE
F_S = 67.63
F_DRIVE = 2.4032
KNOWN = {
    F_DRIVE: 1.0,
    F_S - F_DRIVE: 3e-2,
    F_S + F_DRIVE: 2e-2,
    2 * F_S - F_DRIVE: 1e-2,
    2 * F_S + F_DRIVE: 4e-3,
}


def signal(parts: dict[float, float]) -> np.ndarray:
    signal = np.full(TIME.shape, 0.7)
    for i, (f, a) in enumerate(parts.items()):
        angle = 2 * np.pi * f * TIME
        signal = signal + a * np.cos(angle + i)
    return signal


def test_lines_are_found_with_frequency_and_amplitude() -> None:
    found = spectra.lines(TIME, signal(KNOWN), floor=1e-3)
    assert [line.frequency for line in found] == pytest.approx(list(KNOWN), abs=0.005)
    assert [line.amplitude for line in found] == pytest.approx(list(KNOWN.values()), rel=0.02)


@pytest.mark.parametrize("kind", [pd.Series, xr.DataArray, list])
def test_samples_may_be_of_any_kind(kind: Callable[[np.ndarray], Any]) -> None:
    """Columns of a run, DataArrays, and of a table, Series, failed within numpy."""
    time = kind(TIME[1000:])
    values = kind(signal(KNOWN)[1000:])
    if kind is pd.Series:  # the rows of a part of a table do not begin at 0
        time.index += 1000
        values.index += 1000
    plain = (np.asarray(time), np.asarray(values))
    assert spectra.lines(time, values) == spectra.lines(*plain)
    assert spectra.main_vibration(time, values) == spectra.main_vibration(*plain)
    for found, expected in zip(
        spectra.time_frequency(time, values), spectra.time_frequency(*plain), strict=True
    ):
        assert np.array_equal(found, expected)


def test_a_line_is_weak_beside_the_strongest_of_its_band() -> None:
    values = signal({100.0: 1.0, 300.0: 5e-4, 700.0: 1e-4})
    found = spectra.lines(TIME, values, above=200.0, floor=0.3)
    assert [line.frequency for line in found] == pytest.approx([300.0], abs=0.01)


def test_the_main_vibration_has_its_share_of_the_variance() -> None:
    found = spectra.main_vibration(TIME, signal({135.42: 3.0, 270.9: 1.0}))
    assert found.frequency == pytest.approx(135.42, abs=0.005)
    assert found.amplitude == pytest.approx(3.0, rel=1e-3)
    assert found.share == pytest.approx(0.9, abs=1e-3)
    assert spectra.share_at(TIME, signal({135.42: 1.0, 270.9: 1.0}), 270.9) == pytest.approx(
        0.5, abs=1e-3
    )


def test_a_constant_signal_has_no_main_vibration() -> None:
    with pytest.raises(ValueError, match="no line"):
        spectra.main_vibration(TIME, np.full(TIME.size, 0.7))


@pytest.mark.parametrize(
    ("time", "values", "fault"),
    [
        (np.delete(TIME, 20_000), signal(KNOWN)[1:], "time: must rise in even steps"),
        (TIME[::-1], signal(KNOWN), "time: must rise in even steps"),
        (np.where(TIME[5] == TIME, np.nan, TIME), signal(KNOWN), "time: must rise in even steps"),
        (TIME, np.where(TIME[5] == TIME, np.nan, signal(KNOWN)), "values: must be finite"),
        (TIME[1:], signal(KNOWN), "values: must be two or more, one for each time"),
    ],
)
def test_a_measured_signal_with_gaps_had_lines_elsewhere_or_none(
    time: np.ndarray, values: np.ndarray, fault: str
) -> None:
    for spectrum in (spectra.lines, spectra.time_frequency):
        with pytest.raises(ValueError, match=fault):
            spectrum(time, values)


SHORT = np.arange(10_000) / 1000.0
NEAR = 206.0
WITHIN = 2.0


def sine(frequency: float, phase: float = 0.0) -> np.ndarray:
    return np.sin(2 * np.pi * frequency * SHORT + phase)


NAMES = {
    F_DRIVE: "f_Ω",
    2 * F_DRIVE: "2 f_Ω",
    F_S - F_DRIVE: "f_s − f_Ω",
    F_S + F_DRIVE: "f_s + f_Ω",
    3 * F_S: "3 f_s",
}


@pytest.mark.parametrize(
    ("frequency", "name"), [*NAMES.items(), (4 * F_S - F_DRIVE, "4 f_s − f_Ω")]
)
def test_lines_are_named(frequency: float, name: str) -> None:
    found = spectra.identify(frequency + 0.1, F_S, F_DRIVE)
    assert str(found) == name
    assert found.deviation == pytest.approx(0.1)


def test_time_frequency_follows_a_chirp() -> None:
    t = TIME - TIME[0]
    found = spectra.time_frequency(
        TIME, np.cos(2 * np.pi * (100 * t + 10 * t**2)), window=0.25, hop=0.05
    )
    ridge = found.frequency[np.argmax(found.power, axis=0)]
    np.testing.assert_allclose(ridge, 100 + 20 * (found.time - TIME[0]), atol=4)
    assert found.time[0] == pytest.approx(TIME[0] + 0.125, abs=0.05)
    assert found.time[-1] == pytest.approx(TIME[-1] - 0.125, abs=0.05)
    assert found.power.shape == (found.frequency.size, found.time.size)


def test_coverage_tells_lines_from_noise() -> None:
    noise = np.random.default_rng(0).normal(size=TIME.size)
    assert spectra.coverage(TIME, signal(KNOWN), 10, 300) < 0.06
    assert spectra.coverage(TIME, noise, 10, 300) > 0.95
    # the skirt of a line beside the band is no line of the band
    beside = np.sin(2 * np.pi * 9.5 * TIME)
    assert spectra.coverage(TIME, beside, 10, 300) == 0.0
    # a stronger one elsewhere does not make the lines of the band weak
    within = signal(KNOWN)
    elsewhere = 10 * np.sin(2 * np.pi * 450 * TIME)
    alone = spectra.coverage(TIME, within, 10, 300)
    assert spectra.coverage(TIME, within + elsewhere, 10, 300) == pytest.approx(alone, rel=0.1)


SKIRTS = {
    "that dies out": lambda f, rng: sine(f) * np.exp(-rng.uniform(0.2, 3) * SHORT),
    "that begins": lambda f, rng: sine(f) * (rng.uniform(2, 8) < SHORT),
    "that wanders": lambda f, rng: np.sin(
        2 * np.pi * f * SHORT + np.cumsum(0.02 * rng.standard_normal(SHORT.size))
    ),
}


@pytest.mark.parametrize("skirt", SKIRTS)
def test_what_stands_on_the_skirt_of_a_line_is_no_evidence(skirt: str) -> None:
    """Half of them passed by less than 1e-3: the level was looked for farther away than the skirt
    reaches."""
    rng = np.random.default_rng(4)
    for _ in range(20):
        values = SKIRTS[skirt](
            NEAR - WITHIN - rng.uniform(0.3, 1), rng
        ) + 1e-4 * rng.standard_normal(SHORT.size)
        # of 30,000 lines the least likely had 0.02
        for line in spectra.lines(
            SHORT, values, above=NEAR - WITHIN, below=NEAR + WITHIN, floor=0.0
        ):
            assert spectra.chance(SHORT, values, line, WITHIN) > 1e-3
        resolved = values + sine(NEAR)  # what stands on it truly
        assert (
            spectra.chance(SHORT, resolved, spectra.strongest(SHORT, resolved, NEAR, 0.5), WITHIN)
            < 1e-9
        )


def test_a_line_stands_out_or_it_is_noise() -> None:
    """Amplitudes of 0.02 are ten times the noise of unit variance in a bin, those of 0.002 as large
    as it."""
    t = np.arange(40_000) / 4000
    noise = np.random.default_rng(3).standard_normal(t.size)
    angle = 2 * np.pi * 100.0 * t
    tone = 0.2 * np.sin(angle)
    signal = noise + tone
    loud = spectra.strongest(t, signal, 100.0, 1.0)
    assert spectra.chance(t, signal, loud, 1.0) < 1e-9
    chances = [
        spectra.chance(t, noise, spectra.strongest(t, noise, f, 1.0), 1.0)
        for f in range(100, 400, 5)
    ]
    assert min(chances) > 1e-4  # the least of sixty is about 1/60
    assert np.median(chances) > 0.1
    line = spectra.Line(100.0, 1.0)
    assert spectra.chance(t, np.sin(angle), line, 1.0) == 0.0
    with pytest.raises(ValueError, match="no bin of the spectrum is 1 to 6 Hz from 100 Hz"):
        spectra.chance(t[:100], noise[:100], spectra.Line(100.0, 1.0), 1.0)


@pytest.mark.parametrize("m", [-3, -2, -1, 1, 2, 3])
@pytest.mark.parametrize("n", [1, 5, 12])
def test_combinations_of_up_to_three_times_the_drive_are_named(n: int, m: int) -> None:
    found = spectra.identify(n * F_S + m * F_DRIVE, F_S, F_DRIVE)
    assert found.n == n
    assert found.m == m
    assert found.deviation == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(("frequency", "drive"), [(9.0, 1.0), (8.9999, 1.0001)])
def test_of_names_that_fit_alike_the_one_of_the_smallest_orders_is_taken(
    frequency: float, drive: float
) -> None:
    """f_s + 3 f_drive and 2 f_s - 3 f_drive are the same frequency, or 0.0006 Hz apart."""
    found = spectra.identify(frequency, 6.0, drive)
    assert found.n == 1
    assert found.m == 3


@pytest.mark.parametrize("amplitude", [1.0, 3.0])
def test_a_sine_of_amplitude_one_has_the_power_one_half(amplitude: float) -> None:
    time = np.arange(8000) / RATE
    # in the middle of a bin of the window of one second
    found = spectra.time_frequency(time, amplitude * np.sin(2 * np.pi * 100 * time))
    # the mean of the square; sine and window repeat within the window
    np.testing.assert_allclose(found.power.max(axis=0), amplitude**2 / 2, rtol=1e-6)


def test_the_chance_of_a_line_counts_all_bins_that_were_searched() -> None:
    """With p the probability of so much in one bin, it is 1 - (1 - p)^n for n bins within the band;
    half the bins give half of it."""
    time = np.arange(40_000) / 4000
    noise = np.random.default_rng(3).standard_normal(time.size)
    frequency, amplitude = spectra.amplitude_spectrum(time, noise)
    line = spectra.Line(200.0, 0.05)
    off = np.abs(frequency - line.frequency)
    sides = [frequency < line.frequency, frequency > line.frequency]
    near = (off > 4 * frequency[1]) & (off < 1)
    far = (off > 1) & (off < 6)
    level = max(np.median(amplitude[side & band] ** 2) for side in sides for band in (near, far))
    of_one_bin = 2.0 ** (-(line.amplitude**2) / level)
    bins = int(np.sum(off <= 1.5)) - 1  # 15 on each side
    assert bins == 30
    expected = 1 - (1 - of_one_bin) ** bins
    assert spectra.chance(time, noise, line, 1.5) == pytest.approx(expected, rel=1e-9)


def test_the_detuning_is_how_far_the_multiple_lies_above_the_mode() -> None:
    p = Parameters(N=385, Omega=15.0)
    frequency, l = next((f, l) for f, l, bound in spectra.modes_at_rest(p) if l == 2 and not bound)
    seen = frequency - l * p.Omega / (2 * np.pi)  # of the backward wave, in the slider's frame
    for detuning in (0.4, -0.7):
        period = 2 / (seen + detuning)  # 2 f_s lies so far above it
        multiplier = np.exp(2j * np.pi * seen * period)
        found = spectra.nearest_resonance(p, period, complex(multiplier), l)
        assert found.harmonic == 2
        assert found.diameters == l
        assert found.sign == -1
        assert found.detuning == pytest.approx(detuning, abs=1e-9)
        assert found.frequency == pytest.approx(frequency)


def test_modes_at_rest_are_those_of_disc_and_slider_together() -> None:
    """In Hz, ascending; the one of a pair that has its node at the slider keeps its frequency."""
    p = Parameters(N=385, Omega=15.0)
    found = spectra.modes_at_rest(p)
    every = [mode.frequency for mode in found]
    assert every == pytest.approx(coupled_natural_frequencies(p) / (2 * np.pi), rel=1e-12)
    free = [mode.frequency for mode in found if not mode.bound]
    modes = plate_modes(p)
    pairs = modes[modes["diameters"] > 0]["omega"]
    assert free == pytest.approx(sorted(pairs / (2 * np.pi)), rel=1e-12)
    assert [mode.diameters for mode in found] == [1, 0, 1, 2, 2, 3, 3, 4, 4]


@pytest.mark.parametrize(
    ("multiplier", "ratio", "harmonic"),
    [(-1.0, 2.6, 2.5), (-1.0, 2.4, 2.5), (-1.0, 3.4, 3.5), (1.0, 2.6, 3.0), (1.0, 2.4, 2.0)],
)
def test_a_period_doubling_belongs_to_an_odd_multiple_of_half_the_rate(
    multiplier: float, ratio: float, harmonic: float
) -> None:
    """Of the mode without nodal diameters, which stands in the slider's frame."""
    p = Parameters(N=385, Omega=15.0)
    frequency = next(mode.frequency for mode in spectra.modes_at_rest(p) if not mode.diameters)
    rate = frequency / ratio
    found = spectra.nearest_resonance(p, 1 / rate, complex(multiplier), 0)
    assert found.frequency == frequency
    assert found.sign == 0
    assert found.harmonic == harmonic
    assert found.detuning == pytest.approx((harmonic - ratio) * rate, rel=1e-9)


def test_the_highest_line_is_that_of_a_hundredth_of_the_strongest() -> None:
    values = signal({100.0: 1.0, 300.0: 0.02, 700.0: 0.005})
    assert spectra.highest_line(TIME, values, 0.01) == pytest.approx(300, abs=0.01)
    assert spectra.highest_line(TIME, values, 0.003) == pytest.approx(700, abs=0.01)
    assert spectra.highest_line(TIME, 0 * TIME, 0.01) == RATE / 2


def test_side_lobes_of_the_window_are_no_lines() -> None:
    """A sine between two bins has one line, however small the others may be."""
    time = np.arange(0, 4, 1 / 500)
    found = spectra.lines(time, 2.0 * np.sin(2 * np.pi * 60.1 * time), floor=0.0)
    [line] = [line for line in found if line.amplitude > 1e-12]
    assert line.frequency == pytest.approx(60.1, abs=1e-3)
    # 1e-4 of the strongest is above them
    small = 2e-4 * np.sin(2 * np.pi * 110.0 * time)
    both = spectra.lines(time, 2.0 * np.sin(2 * np.pi * 60.1 * time) + small, floor=0.0)
    assert [line.frequency for line in both] == pytest.approx([60.1, 110.0], abs=1e-2)
    # and a tenth of that is not told from them
    smaller = spectra.lines(time, 2.0 * np.sin(2 * np.pi * 60.1 * time) + 0.1 * small, floor=0.0)
    assert [line.frequency for line in smaller] == pytest.approx([60.1], abs=1e-2)


@pytest.mark.parametrize(
    ("sign", "label"),
    [
        (-1, "4 f_s = 290.28 Hz - 2 Ω/2π"),
        (0, "4 f_s = 290.28 Hz"),
        (1, "4 f_s = 290.28 Hz + 2 Ω/2π"),
    ],
)
def test_a_resonance_is_named_with_the_side_of_the_turns(sign: int, label: str) -> None:
    assert spectra.Resonance(4.0, 290.28, 2, sign, 0.0).label == label


def test_a_mode_that_the_slider_holds_may_resonate_where_it_stands() -> None:
    """With twice the rate of releases, without turns of the drive."""
    p = Parameters(N=300, Omega=20)
    bound = [mode for mode in spectra.modes_at_rest(p) if mode.bound and mode.diameters]
    mode = bound[0]
    period = 2 / mode.frequency
    found = spectra.nearest_resonance(p, period, 1 + 0j, mode.diameters)
    assert found.sign == 0
    assert found.harmonic == 2
    assert found.frequency == mode.frequency
    # of the frequency by the period
    assert found.detuning == pytest.approx(0.0, abs=1e-9)


def test_lines_may_be_as_near_as_two_bins_if_that_is_asked_for() -> None:
    values = signal(KNOWN)
    usual = spectra.lines(TIME, values, floor=0.01)
    near = spectra.lines(TIME, values, floor=0.01, apart=1e-9)
    assert near == usual


def test_the_shortest_record_of_a_spectrum_in_time_is_a_window_and_two_steps() -> None:
    """Of 1 s and twice 0.05 s at 100 Hz."""
    time = np.arange(110) / 100
    values = np.sin(2 * np.pi * 10 * time)
    found = spectra.time_frequency(time, values)
    assert found.power.shape == (len(found.frequency), len(found.time))
    assert found.time[0] >= 0.5
    with pytest.raises(ValueError, match=r"^1\.09 s of samples are too few"):
        spectra.time_frequency(time[1:], values[1:])


@pytest.mark.parametrize(
    ("diameters", "bound", "senses"), [(0, True, {0}), (2, True, {0, -1, 1}), (2, False, {-1, 1})]
)
def test_a_mode_bound_to_the_slider_may_stand_or_travel(
    diameters: int, bound: bool, senses: set[int]
) -> None:
    mode = spectra.ModeAtRest(100.0, diameters, bound)
    assert {*spectra._senses(mode)} == senses
