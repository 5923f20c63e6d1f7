"""Spectra: lines of a stationary signal, their identification, and spectra that change with time;
resonances."""

import cmath
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from disc_model.arrays import Array
from disc_model.disc.flexibility import contact_compliance
from disc_model.disc.plate import coupled_shapes, mode_arrays
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters

RESOLVED = 4
"""Bins, half the width of a line's main lobe: two lines nearer to each other are not resolved."""
SIDE_LOBES = 3e-5
"""Highest side lobe of the window relative to the line's own height: 2.5e-5, and a margin of a
fifth."""
HIGHEST_HARMONIC = 12  # of the stick-slip frequency in combinations,
HIGHEST_TURN = 3  # and of the drive's
EQUALLY_NEAR = 3  # digits of Hz to which combinations are equally near


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
        sign = " − " if self.m < 0 else " + "
        parts = ((self.n, "f_s"), (abs(self.m), "f_Ω"))
        return sign.join(f"{order} {name}".removeprefix("1 ") for order, name in parts if order)


class TimeFrequency(NamedTuple):
    """Power against time and frequency: `time` (s) shape (n,), `frequency` (Hz) shape (m,), `power`
    shape (m, n)."""

    time: Array
    frequency: Array
    power: Array


def rate_of(time: ArrayLike, values: ArrayLike) -> float:
    """Sampling rate (Hz) of uniform samples, both of shape (n,); raises ParameterError if they are
    not uniform."""
    t = np.asarray(time, dtype=float)
    x = np.asarray(values, dtype=float)
    if t.ndim != 1 or x.shape != t.shape or t.size < 2:
        raise ParameterError("values: must be two or more, one for each time")
    if not np.isfinite(x).all():
        raise ParameterError("values: must be finite")
    even, step = np.linspace(t[0], t[-1], len(t), retstep=True)
    # a missing sample shifts times by half a step or more, and rounding by less
    if not step > 0 or not np.all(np.abs(t - even) < 0.45 * step):
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
    from scipy.signal import periodogram

    signal = np.asarray(values, dtype=float)
    rate = rate_of(time, signal)
    frequency, power = periodogram(signal, rate, "blackmanharris", scaling="spectrum")
    return frequency, np.sqrt(2 * power)


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
    from scipy.signal import find_peaks

    frequency, amplitude = amplitude_spectrum(time, values)
    step = float(frequency[1])
    distance = RESOLVED if apart is None else max(1, round(apart / step))
    peaks, _ = find_peaks(amplitude, height=SIDE_LOBES * amplitude.max(), distance=distance)

    # vertices of parabolas through the logarithms of the maxima and their neighbours
    levels = np.log(np.maximum(amplitude, np.finfo(float).tiny))
    low, mid, high = (levels[peaks + beside] for beside in (-1, 0, 1))
    curvature = low - 2 * mid + high
    shift = np.divide(0.5 * (low - high), curvature, out=np.zeros(len(peaks)), where=curvature < 0)
    frequencies = frequency[peaks] + shift * step
    heights = np.exp(mid - 0.25 * (low - high) * shift)

    # those between the two frequencies that are strong enough
    inside = (frequencies > above) & (frequencies < below)
    bins = np.where(inside, amplitude[peaks], 0.0)
    lasting = inside & (bins >= floor * bins.max(initial=0.0))
    return [Line(*line) for line in np.stack([frequencies, heights], axis=1)[lasting].tolist()]


def main_frequency(time: ArrayLike, values: ArrayLike) -> float:
    """The frequency of the strongest line of a signal, Hz; raises ValueError if it has none."""
    found = lines(time, values, floor=0.5)
    if not found:
        raise ValueError("the signal has no line")
    return max(found, key=lambda line: line.amplitude).frequency


def share_at(time: ArrayLike, values: ArrayLike, frequency: float) -> float:
    """The share of a signal's variance that the best sine at a frequency (Hz) explains, by a
    least-squares fit of it and a constant.

    Examples
    --------
    >>> t = np.arange(4000) / 2000
    >>> x = 3 * np.sin(2 * np.pi * 97.3 * t) + np.sin(2 * np.pi * 401 * t)
    >>> frequency = main_frequency(t, x)
    >>> round(frequency, 1), round(share_at(t, x, frequency), 2)
    (97.3, 0.9)
    """
    seconds = np.asarray(time, dtype=float)
    angle = 2 * np.pi * frequency * (seconds - seconds[0])
    waves = np.column_stack([np.ones_like(angle), np.cos(angle), np.sin(angle)])
    signal = np.asarray(values, dtype=float)
    coefficients = np.linalg.lstsq(waves, signal, rcond=None)[0]
    return 1 - float(np.var(signal - waves @ coefficients) / np.var(signal))


def identify(frequency: float, f_s: float, f_drive: float) -> Combination:
    """Find the combination ``n f_s + m f_drive`` (0 <= n <= 12, abs(m) <= 3) nearest to a
    frequency, all in Hz.

    Of combinations that are equally near, to a thousandth of a Hz, the one with the smallest orders
    is taken.
    """
    found = []
    for n in range(HIGHEST_HARMONIC + 1):
        for m in range(-HIGHEST_TURN, HIGHEST_TURN + 1):
            if n > 0 or m > 0:  # the others are no frequency
                at = float(n * f_s + m * f_drive)
                found.append(Combination(n, m, at, float(frequency) - at))
    return min(found, key=lambda x: (round(abs(x.deviation), EQUALLY_NEAR), x.n + abs(x.m)))


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

    rate = rate_of(time, values)
    signal = np.asarray(values, dtype=float)
    length = round(window * rate)
    step = max(1, round(hop * rate))
    if len(signal) < length + 2 * step:
        raise ValueError(
            f"{len(signal) / rate:g} s of samples are too few for a window of {window:g} s"
        )
    # scale_to="magnitude": the height of a line does not depend on the window's length
    transform = ShortTimeFFT.from_window(
        "hann", rate, length, length - step, fft_mode="onesided2X", scale_to="magnitude"
    )
    first = transform.lower_border_end[1]
    last = transform.upper_border_begin(len(signal))[1]
    amplitude = np.abs(transform.stft(signal - signal.mean(), p0=first, p1=last))
    middles = np.asarray(time, dtype=float)[0] + transform.delta_t * np.arange(first, last)
    return TimeFrequency(middles, transform.f, amplitude**2 / 2)


# ---- Resonances of the stick-slip cycle: the one to which a multiplier belongs, and its label in
# figures


class Resonance(NamedTuple):
    """A resonance n f_s = f -/+ l Omega / 2 pi of a cycle.

    harmonic : n; half-integer for a period doubling
    frequency, diameters : f (Hz) and l, of a mode of disc and slider at rest
    sign : -1 or 1, of l Omega / 2 pi; 0 if the mode stands in the slider's frame
    """

    harmonic: float
    frequency: float
    diameters: int
    sign: int

    @property
    def label(self) -> str:
        """Label in figures, such as "2 f_s = 135.42 Hz" or "4 f_s = 290.28 Hz - 2 Ω/2π"."""
        side = ("", f" + {self.diameters} Ω/2π", f" - {self.diameters} Ω/2π")[self.sign]
        return f"{self.harmonic:g} f_s = {self.frequency:.2f} Hz{side}"


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
    angle = cmath.phase(multiplier) / (2 * math.pi)
    half = 0.5 * (multiplier.imag == 0 and multiplier.real < 0)  # of a period doubling
    found: list[tuple[float, Resonance]] = []
    for mode in modes_at_rest(p):
        if mode.diameters != diameters:
            continue
        signs = [-1, 1] if diameters > 0 else []
        if mode.bound:
            signs.insert(0, 0)
        for sign in signs:
            seen = (mode.frequency + sign * diameters * turn) / rate
            harmonic = round(seen - half) + half
            # how far it is from the multiplier's angle, in turns
            miss = min(abs((seen - side * angle + 0.5) % 1 - 0.5) for side in (-1, 1))
            found.append((miss, Resonance(harmonic, mode.frequency, diameters, sign)))
    return min(found, key=lambda each: each[0])[1]


class ModeAtRest(NamedTuple):
    """A mode of disc and slider at rest: its frequency, Hz, nodal diameters, and whether it is bound
    to the slider."""

    frequency: float
    diameters: int
    bound: bool


def modes_at_rest(p: Parameters) -> list[ModeAtRest]:
    """All modes of disc and slider at rest, by ascending frequency. A coupled mode has the diameters
    of the disc's mode with most of its energy; a compliant contact adds one mode."""
    modes = mode_arrays(p)
    omegas, shapes = coupled_shapes(p, contact_compliance(p))
    largest = np.abs(shapes[: len(modes.omega)]).argmax(axis=0)
    coupled = zip(omegas.tolist(), modes.diameters[largest].tolist(), strict=True)
    own = zip(modes.omega.tolist(), modes.diameters.tolist(), strict=True)
    found = [ModeAtRest(omega / math.tau, l, bound=True) for omega, l in coupled]
    # free are those with a nodal diameter at the slider
    found += [ModeAtRest(omega / math.tau, l, bound=False) for omega, l in own if l > 0]
    return sorted(found)
