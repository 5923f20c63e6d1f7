"""Sobol' indices of samples by the design of Saltelli et al. (2010), and shares with confidence intervals.

A row of the outputs is a sample: f(A), f(B), and f of A with each of d inputs in turn taken from B. The first-order
index of an input is the share of the output's variance that it explains alone. The total index is its share with all
interactions. Rows with a missing output are left out, and their share must be reported with the indices.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binomtest

Array = NDArray[np.float64]

CONFIDENCE = 0.95
RESAMPLES = 500
"""Number of bootstrap samples: the ends of a 95 % interval are then accurate to about a tenth of its half width."""
AT_ONCE = 50
"""Number of resamples that are held in memory together."""


class Indices(NamedTuple):
    """First-order and total indices, shape (d,) each, and the ends of their intervals; nan if nothing varies."""

    first: Array
    first_low: Array
    first_high: Array
    total: Array
    total_low: Array
    total_high: Array


def sobol_indices(outputs: Array) -> tuple[Array, Array]:
    """First-order and total indices.

    The formulas are those of `scipy.stats.sobol_indices`. That function requires a power of two of samples, which is
    lost when rows are left out.

    Parameters
    ----------
    outputs : shape (..., n, d + 2): f(A), f(B), f(AB_1) ...

    Returns
    -------
    first, total : (..., d); nan where the outputs do not vary
    """
    a, b, mixed = outputs[..., 0, None], outputs[..., 1, None], outputs[..., 2:]
    both = outputs[..., :2]
    mean = both.mean(axis=(-2, -1))[..., None, None]
    variance = both.var(axis=(-2, -1))[..., None]
    # the variance of equal numbers is not exactly 0 because of rounding
    variance = np.where(variance > 1e-24 * np.square(mean[..., 0]), variance, np.nan)
    first = np.mean((b - mean) * (mixed - a), axis=-2) / variance
    total = 0.5 * np.mean((a - mixed) ** 2, axis=-2) / variance
    return first, total


def sobol_intervals(outputs: Array, seed: int = 0) -> Indices:
    """Indices of outputs (n, d + 2), rows with nan left out, with bootstrap intervals (percentiles) over the rows."""
    outputs = outputs[np.isfinite(outputs).all(axis=1)]
    n, d = len(outputs), outputs.shape[1] - 2
    if n < 2:
        return Indices(*np.full((6, d), np.nan))
    rng = np.random.default_rng(seed)
    chosen = rng.integers(n, size=(RESAMPLES, n))
    parts = [sobol_indices(outputs[chosen[i : i + AT_ONCE]]) for i in range(0, RESAMPLES, AT_ONCE)]
    tail, ends = (1 - CONFIDENCE) / 2, []
    for index, point_value in zip(map(np.concatenate, zip(*parts, strict=True)), sobol_indices(outputs), strict=True):
        varies = np.isfinite(index).any()  # resamples in which the outputs do not vary are left out
        interval = np.nanquantile(index, (tail, 1 - tail), axis=0) if varies else np.full((2, d), np.nan)
        ends += [point_value, *interval]
    return Indices(*ends)


class Share(NamedTuple):
    """A share and the ends of its interval."""

    value: float
    low: float
    high: float


def share(hits: int, trials: int, unknown: int = 0, confidence: float = CONFIDENCE) -> Share:
    """Share of hits among trials with a known result, with its Wilson interval.

    unknown : number of further trials; they count as misses at the lower end of the interval and as hits at the upper
    """
    if trials == 0:
        return Share(np.nan, 0.0, 1.0)
    low = binomtest(hits, trials + unknown).proportion_ci(confidence, "wilson").low
    high = binomtest(hits + unknown, trials + unknown).proportion_ci(confidence, "wilson").high
    return Share(hits / trials, float(low), float(high))
