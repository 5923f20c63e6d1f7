"""Measures of signals and sections that the paper's statements need."""

import numpy as np
from numpy.typing import ArrayLike
from scipy.signal import find_peaks

from disc_model.analysis import spectra
from disc_model.analysis.spectra import Line
from disc_model.arrays import Array

AROUND = (1.0, 6.0)
"""Hz, distances from a line between which the level of its neighbourhood is determined."""
ROUNDING = 1e-9  # share of the largest coordinate within which two points are the same


def strongest(time: ArrayLike, values: ArrayLike, near: float, within: float) -> Line:
    """Find the strongest line within `within` Hz of the frequency `near`; raises ValueError if
    there is none."""
    peaks = spectra.lines(time, values, above=near - within, below=near + within, floor=0.0)
    if not peaks:
        raise ValueError(f"no line within {within:g} Hz of {near:g} Hz")
    return max(peaks, key=lambda line: line.amplitude)


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
    frequency, amplitude = spectra.amplitude_spectrum(time, values)
    step = float(frequency[1])
    power = amplitude**2

    # the level of the neighbourhood: of four bands, the largest median
    levels = []
    for side in (-1, 1):
        off = side * (frequency - line.frequency)
        for low, high in ((spectra.RESOLVED * step, near), (near, far)):
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


def power_share(time: ArrayLike, values: ArrayLike, above: float, reference: float) -> float:
    """Power above the frequency `above` over the power above a lower frequency `reference` (both
    Hz)."""
    frequency, amplitude = spectra.amplitude_spectrum(time, values)
    power = amplitude**2
    return float(power[frequency > above].sum() / power[frequency > reference].sum())


def coverage(
    time: ArrayLike, values: ArrayLike, low: float, high: float, floor: float = 1e-3
) -> float:
    """Share of the band `low` to `high`, Hz, where the amplitude exceeds `floor` of its strongest
    line (0 without)."""
    frequency, amplitude = spectra.amplitude_spectrum(time, values)
    band = (frequency >= low) & (frequency <= high)
    peaks = find_peaks(
        amplitude, height=spectra.SIDE_LOBES * amplitude.max(), distance=spectra.RESOLVED
    )[0]
    strongest = amplitude[peaks][band[peaks]].max(initial=0.0)
    if not strongest > 0:
        return 0.0
    return float(np.mean(amplitude[band] > floor * strongest))


def distinct_points(points: Array, share: float) -> int:
    """Count the distinct points of a section, by a greedy search: points count as one if they differ by
    at most a share of the range along every axis, in which rounding is no range.

    A chain of near points is not merged, so that a closed curve has about 1/share points.

    Parameters
    ----------
    points : shape (n, d)
    """
    if points.size == 0:
        return 0
    same = np.maximum(share * np.ptp(points, axis=0), ROUNDING * np.abs(points).max())
    centres = points[:1]
    for point in points:
        if np.any(np.abs(centres - point) > same, axis=1).all():
            centres = np.vstack([centres, point])
    return len(centres)
