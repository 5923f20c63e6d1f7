"""Spectra: lines of a stationary signal, their identification, and spectra that change with time;
resonances."""

import math
import re
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from disc_model.arrays import Array, Indices
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_shapes, mode_arrays
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters

AROUND = (1.0, 6.0)
"""Hz, distances from a line between which the level of its neighbourhood is determined."""
RESOLVED = 4
"""Bins, half the width of a line's main lobe: two lines nearer to each other are not resolved."""
SIDE_LOBES = 3e-5
"""Highest side lobe of the window relative to the line's own height: 2.5e-5, and a margin of a
fifth."""
HIGHEST_HARMONIC = 12  # of the stick-slip frequency in combinations,
HIGHEST_TURN = 3  # and of the drive's
EQUALLY_NEAR = 3  # digits of Hz to which combinations are equally near
_ORDERS = [
    (n, m)
    for n in range(HIGHEST_HARMONIC + 1)
    for m in range(-HIGHEST_TURN, HIGHEST_TURN + 1)
    if n > 0 or m > 0  # others are no frequency
]
HARMONICS, TURNS = np.transpose(_ORDERS)
"""Orders n and m of all combinations, shape (combinations,)."""


class Line(NamedTuple):
    """A spectral line: frequency in Hz and amplitude in the signal's unit."""

    frequency: float
    amplitude: float


class Combination(NamedTuple):
    """The combination ``n f_s + m f_drive`` nearest to a line, and the deviation of the line from
    it, Hz."""

    n: int
    m: int
    frequency: float
    deviation: float

    def __str__(self) -> str:
        parts = []
        if self.n:
            parts.append(f"{self.n} f_s")
        if self.m:
            parts.append(f"{self.m} f_Ω")
        plain = re.sub(r"\b1 ", "", " + ".join(parts))  # f_s for 1 f_s
        return plain.replace("+ -", "− ") or "0"


class TimeFrequency(NamedTuple):
    """Power against time and frequency: `time` (s) shape (n,), `frequency` (Hz) shape (m,), `power`
    shape (m, n)."""

    time: Array
    frequency: Array
    power: Array


def rate_of(time: ArrayLike, values: ArrayLike) -> float:
    """Sampling rate (Hz) of uniform samples, both of shape (n,); raises ParameterError if they are
    not uniform."""
    time = np.asarray(time, dtype=float)
    values = np.asarray(values, dtype=float)
    if time.ndim != 1 or values.shape != time.shape or time.size < 2:
        raise ParameterError("values: must be two or more, one for each time")
    if not np.all(np.isfinite(values)):
        raise ParameterError("values: must be finite")
    step = (time[-1] - time[0]) / (len(time) - 1)
    even = np.linspace(time[0], time[-1], len(time))
    # a missing sample shifts times by half a step or more, and rounding by less
    if not step > 0 or not np.all(np.abs(time - even) < 0.45 * step):
        raise ParameterError("time: must rise in even steps; resample an uneven signal first")
    return float(1 / step)


def amplitude_spectrum(time: ArrayLike, values: ArrayLike) -> tuple[Array, Array]:
    """One-sided amplitude spectrum with a Blackman-Harris window (side lobes below -92 dB), mean
    removed.

    Returns
    -------
    frequency, amplitude : Hz and the signal's unit, shape (len(time) // 2 + 1,); a sine of amplitude 1 has a line of
        height 1, less the loss between two bins (at most 0.8 dB)
    """
    # the first import takes a second: most jobs do without
    from scipy.signal.windows import blackmanharris

    rate = rate_of(time, values)
    values = np.asarray(values, dtype=float)
    window = blackmanharris(len(values), sym=False)
    transform = np.fft.rfft((values - np.mean(values)) * window)
    frequency = np.asarray(np.fft.rfftfreq(len(values), 1 / rate), dtype=np.float64)
    return frequency, 2 * np.abs(transform) / window.sum()


def lines(
    time: ArrayLike,
    values: ArrayLike,
    *,
    above: float = 0.0,
    below: float = np.inf,
    floor: float = 1e-3,
    apart: float | None = None,
) -> list[Line]:
    """Find the lines of a signal's spectrum between two frequencies, by ascending frequency.

    Parameters
    ----------
    above, below : Hz, the two frequencies
    floor : least amplitude, relative to the strongest line between them
    apart : Hz, least distance of two lines, of which the stronger is kept; by default `RESOLVED` bins

    Notes
    -----
    A line is a local maximum of the whole spectrum, not of the part between the two frequencies. That part may have its
    maximum at its edge, next to a stronger line outside. Maxima below `SIDE_LOBES` of the spectrum's maximum are not
    lines, because they may be side lobes of the window. The frequency of a line is that at the vertex of the
    parabola through the logarithms of the three highest bins.
    """
    frequency, amplitude = amplitude_spectrum(time, values)
    step = float(frequency[1])
    distance = RESOLVED
    if apart is not None:
        distance = max(1, round(apart / step))
    peaks = _maxima(amplitude, distance)

    # vertices of parabolas through the logarithms of the maxima and their neighbours
    levels = np.log(np.maximum(amplitude, np.finfo(float).tiny))
    low = levels[peaks - 1]
    mid = levels[peaks]
    high = levels[peaks + 1]
    curvature = low - 2 * mid + high
    shift = np.divide(0.5 * (low - high), curvature, out=np.zeros(len(peaks)), where=curvature < 0)
    frequencies = frequency[peaks] + shift * step
    heights = np.exp(mid - 0.25 * (low - high) * shift)

    # those between the two frequencies that are strong enough
    inside = (frequencies > above) & (frequencies < below)
    bins = np.where(inside, amplitude[peaks], 0.0)
    lasting = inside & (bins >= floor * bins.max(initial=0.0))
    found = zip(frequencies[lasting].tolist(), heights[lasting].tolist(), strict=True)
    return [Line(*line) for line in found]


def highest_line(time: ArrayLike, values: ArrayLike, floor: float) -> float:
    """Frequency of the highest line, Hz, whose amplitude is at least `floor` times that of the
    strongest; half the sampling rate if there is no line."""
    found = lines(time, values, floor=floor)
    if not found:
        return rate_of(time, values) / 2
    return found[-1].frequency


def strongest(time: ArrayLike, values: ArrayLike, near: float, within: float) -> Line:
    """Find the strongest line within `within` Hz of the frequency `near`; raises ValueError if
    there is none."""
    peaks = lines(time, values, above=near - within, below=near + within, floor=0.0)
    if not peaks:
        raise ValueError(f"no line within {within:g} Hz of {near:g} Hz")
    return max(peaks, key=lambda line: line.amplitude)


class MainVibration(NamedTuple):
    """The sine that fits a signal best: frequency in Hz, amplitude in the signal's unit, and the
    share of the signal's variance that it explains."""

    frequency: float
    amplitude: float
    share: float


def main_vibration(time: ArrayLike, values: ArrayLike) -> MainVibration:
    """Find the vibration at one frequency that explains most of a signal.

    Its frequency is that of the strongest line, its amplitude and share are those of a least-squares
    fit of one sine and a constant. Raises ValueError if the signal has no line.

    Examples
    --------
    >>> t = np.arange(4000) / 2000
    >>> found = main_vibration(t, 3 * np.sin(2 * np.pi * 97.3 * t) + np.sin(2 * np.pi * 401 * t))
    >>> round(found.frequency, 1), round(found.amplitude, 2), round(found.share, 2)
    (97.3, 3.0, 0.9)
    """
    found = lines(time, values, floor=0.5)
    if not found:
        raise ValueError("the signal has no line")
    frequency = max(found, key=lambda line: line.amplitude).frequency

    amplitude, share = _fit_sine(time, values, frequency)
    return MainVibration(frequency, amplitude, share)


def share_at(time: ArrayLike, values: ArrayLike, frequency: float) -> float:
    """Share of a signal's variance that one sine at a frequency in Hz explains."""
    return _fit_sine(time, values, frequency)[1]


def _fit_sine(time: ArrayLike, values: ArrayLike, frequency: float) -> tuple[float, float]:
    """Amplitude of the sine at a frequency (Hz) that fits a signal best, and the share of the
    signal's variance that it explains."""
    time = np.asarray(time, dtype=float)
    values = np.asarray(values, dtype=float)
    angle = 2 * np.pi * frequency * (time - time[0])
    waves = np.column_stack([np.ones_like(angle), np.cos(angle), np.sin(angle)])
    coefficients = np.linalg.lstsq(waves, values, rcond=None)[0]
    rest = values - waves @ coefficients
    share = 1 - float(np.var(rest) / np.var(values))
    return float(np.hypot(*coefficients[1:])), share


def chance(time: ArrayLike, values: ArrayLike, line: Line, searched: float) -> float:
    """Probability that noise at the level of a line's neighbourhood has as strong a line in the
    searched band.

    Parameters
    ----------
    line : a line of the signal, found among bins no further than `searched` Hz from some frequency

    Notes
    -----
    The level is the largest of the medians of the power over four bands: on either side of the line, from its main
    lobe to the nearer end of `AROUND`, and from there to the farther end. A line on the skirt of a stronger one is
    therefore compared with that skirt. Other lines have no effect if they are few and beyond the nearer end. The power
    of noise in a bin is distributed exponentially: it exceeds x medians with the probability 2^-x. Bins are treated as
    independent; the window correlates them, so that the probability is overestimated. Raises ValueError if the
    neighbourhood has no bin, because there are too few samples.
    """
    near, far = AROUND
    frequency, amplitude = amplitude_spectrum(time, values)
    step = float(frequency[1])
    power = amplitude**2

    # the level of the neighbourhood: of four bands, the largest median
    levels = []
    for side in (-1, 1):
        off = side * (frequency - line.frequency)
        for low, high in ((RESOLVED * step, near), (near, far)):
            band = (off > low) & (off < high)
            if band.any():
                levels.append(float(np.median(power[band])))
    if not levels:
        raise ValueError(
            f"no bin of the spectrum is {near:g} to {far:g} Hz from {line.frequency:g} Hz"
        )
    level = max(levels)
    if not level > 0:
        return 0.0

    # of one bin or more among those that were searched
    of_one = np.exp2(-(line.amplitude**2) / level)
    trials = max(1.0, 2 * searched / step)
    return float(-np.expm1(trials * np.log1p(-of_one)))


def identify(frequency: float, f_s: float, f_drive: float) -> Combination:
    """Find the combination ``n f_s + m f_drive`` (0 <= n <= 12, abs(m) <= 3) nearest to a
    frequency, all in Hz.

    Of combinations that are equally near, to a thousandth of a Hz, the one with the smallest orders
    is taken.
    """
    frequencies = HARMONICS * f_s + TURNS * f_drive
    deviations = frequency - frequencies
    # the nearest first, and of those the one with the smallest orders
    distances = np.round(np.abs(deviations), EQUALLY_NEAR)
    first = np.lexsort((HARMONICS + np.abs(TURNS), distances))[0]
    return Combination(
        int(HARMONICS[first]),
        int(TURNS[first]),
        float(frequencies[first]),
        float(deviations[first]),
    )


def time_frequency(
    time: ArrayLike, values: ArrayLike, *, window: float = 1.0, hop: float = 0.05
) -> TimeFrequency:
    """Short-time Fourier transform: power in a Hann window that slides over the samples, mean
    removed.

    Parameters
    ----------
    time, values : uniform samples, shape (n,)
    window, hop : s, length of the window and distance of two windows; lines 2/window Hz apart are resolved

    Notes
    -----
    Only windows within the samples are kept: the result begins half a window after the first sample and ends half a
    window before the last. A sine of amplitude 1 has power 1/2. Raises ValueError if the samples are shorter.
    """
    from scipy.signal import ShortTimeFFT
    from scipy.signal.windows import hann

    rate = rate_of(time, values)
    values = np.asarray(values, dtype=float)
    length = round(window * rate)
    step = max(1, round(hop * rate))
    if len(values) < length + 2 * step:
        raise ValueError(
            f"{len(values) / rate:g} s of samples are too few for a window of {window:g} s"
        )
    # scale_to="magnitude": the height of a line does not depend on the window's length
    transform = ShortTimeFFT(
        hann(length, sym=False), step, rate, fft_mode="onesided2X", scale_to="magnitude"
    )
    centred = values - np.mean(values)

    # only windows within the samples
    first = transform.lower_border_end[1]
    last = transform.upper_border_begin(len(centred))[1]
    amplitude = np.abs(transform.stft(centred, p0=first, p1=last))
    middles = np.asarray(time, dtype=float)[0] + transform.delta_t * np.arange(first, last)
    return TimeFrequency(middles, transform.f, amplitude**2 / 2)


def power_share(time: ArrayLike, values: ArrayLike, above: float, reference: float) -> float:
    """Power above the frequency `above` over the power above a lower frequency `reference` (both
    Hz)."""
    frequency, amplitude = amplitude_spectrum(time, values)
    power = amplitude**2
    return float(power[frequency > above].sum() / power[frequency > reference].sum())


def coverage(
    time: ArrayLike, values: ArrayLike, low: float, high: float, floor: float = 1e-3
) -> float:
    """Share of the band `low` to `high`, Hz, where the amplitude exceeds `floor` of its strongest
    line (0 without)."""
    frequency, amplitude = amplitude_spectrum(time, values)
    band = (frequency >= low) & (frequency <= high)
    peaks = _maxima(amplitude, RESOLVED)
    strongest = amplitude[peaks][band[peaks]].max(initial=0.0)
    if not strongest > 0:
        return 0.0
    return float(np.mean(amplitude[band] > floor * strongest))


def _maxima(amplitude: Array, distance: int) -> Indices:
    """Bins of local maxima that are not side lobes and at least `distance` bins apart; the higher
    one is kept."""
    from scipy.signal import find_peaks

    peaks, _ = find_peaks(amplitude, height=SIDE_LOBES * amplitude.max(), distance=distance)
    return np.asarray(peaks, dtype=np.int64)


# ---- Resonances of the stick-slip cycle: the one to which a multiplier belongs, and its label in
# figures


@dataclass(frozen=True)
class Resonance:
    """A resonance n f_s = f -/+ l Omega / 2 pi of a cycle.

    harmonic : n; half-integer for a period doubling
    frequency, diameters : f (Hz) and l, of a mode of disc and slider at rest
    sign : -1 or 1, of l Omega / 2 pi; 0 if the mode stands in the slider's frame
    detuning : Hz, n f_s less the right side
    """

    harmonic: float
    frequency: float
    diameters: int
    sign: int
    detuning: float

    @property
    def label(self) -> str:
        """Label in figures, such as "2 f_s = 135.42 Hz" or "4 f_s = 290.28 Hz - 2 Ω/2π"."""
        standing = f"{self.harmonic:g} f_s = {self.frequency:.2f} Hz"
        if not self.sign:
            return standing
        side = "-" if self.sign < 0 else "+"
        return f"{standing} {side} {self.diameters} Ω/2π"


def nearest_resonance(
    p: Parameters, period: float, multiplier: complex, diameters: int
) -> Resonance:
    """The resonance to which a cycle's multiplier belongs, among modes of so many nodal diameters.

    In the slider's frame a free mode of l diameters has the frequency f -/+ l Omega / 2 pi; one
    bound to the slider, f. Modulo f_s that is the multiplier's angle over 2 pi T. The harmonic is
    the nearest multiple of f_s, or of f_s / 2.
    """
    rate = 1 / float(period)
    turn = p.Omega / (2 * math.pi)
    angle = math.atan2(multiplier.imag, multiplier.real) / (2 * math.pi)
    doubles = multiplier.imag == 0 and multiplier.real < 0
    half = 0.5 if doubles else 0.0

    def miss(seen: float) -> float:
        """How far a frequency, over that of releases, is from the multiplier's angle, in turns."""
        return min(abs((seen - side * angle + 0.5) % 1 - 0.5) for side in (-1, 1))

    found: list[tuple[float, Resonance]] = []
    for mode in modes_at_rest(p):
        if mode.diameters != diameters:
            continue
        for sign in _senses(mode):
            seen = (mode.frequency + sign * mode.diameters * turn) / rate
            harmonic = round(seen - half) + half
            detuning = float((harmonic - seen) * rate)
            resonance = Resonance(harmonic, mode.frequency, mode.diameters, sign, detuning)
            found.append((miss(seen), resonance))
    nearest = min(found, key=lambda pair: pair[0])
    return nearest[1]


class ModeAtRest(NamedTuple):
    """A mode of disc and slider at rest: its frequency, Hz, nodal diameters, and whether it is bound
    to the slider."""

    frequency: float
    diameters: int
    bound: bool


def _senses(mode: ModeAtRest) -> tuple[int, ...]:
    """Senses in which a mode travels in the slider's frame: -1, 1, and 0 where it stands."""
    if not mode.diameters:
        return (0,)
    return (0, -1, 1) if mode.bound else (-1, 1)


def modes_at_rest(p: Parameters) -> list[ModeAtRest]:
    """All modes of disc and slider at rest, by ascending frequency. A coupled mode has the diameters
    of the disc's mode with most of its energy; a compliant contact adds one mode."""
    modes = mode_arrays(p)
    count = len(modes.omega)
    found = []

    # those in which the slider takes part
    omegas, shapes = coupled_shapes(p, contact_compliance(p))
    for omega, shape in zip(omegas, shapes.T, strict=True):
        largest = int(np.argmax(np.abs(shape[:count])))
        diameters = int(modes.diameters[largest])
        found.append(ModeAtRest(float(omega) / (2 * math.pi), diameters, bound=True))

    # those with a nodal diameter at the slider
    for omega, diameters in zip(modes.omega, modes.diameters, strict=True):
        if diameters > 0:
            found.append(ModeAtRest(float(omega) / (2 * math.pi), int(diameters), bound=False))
    return sorted(found)
