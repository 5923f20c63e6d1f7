"""Classification of motions by numerical criteria, whether they have settled, and sections at the
drive's period.

A motion that does not repeat within half the record is classified by the 0-1 test for chaos
(Gottwald and Melbourne, SIAM J. Appl. Dyn. Syst. 8, 129-145, 2009). The largest exponent, in
`regularity` of `stability/attractors.py`, cannot replace it: it does not see jumps that part
neighbouring motions, such as a release that one of them has.
"""

import math
from collections.abc import Mapping
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from disc_model.arrays import Array, Indices
from disc_model.data.variables import Outcome

CLOSES = 1e-8
"""s, to which intervals of a periodic motion repeat; those on a torus mostly differ by far more."""
NEAR_RETURN = 1e-3
"""Of its first n returns a quasi-periodic motion has one that misses by 1/n of its spread: a period
must be far closer."""
FEWEST = 20  # fewest intervals from which a motion is classified
REGULAR = 0.3
"""A motion is regular if the 0-1 test gives less, chaotic above one minus this; known signals are
within 0.1 of the ends."""
ANGLES = 101  # of the 0-1 test


class Motion(NamedTuple):
    """Classification of a motion by a sequence of intervals.

    Attributes
    ----------
    kind : `OTHER_CYCLE` for a periodic motion, otherwise `QUASI_PERIODIC`, `IRREGULAR` or, if the 0-1 test is
        inconclusive, `UNDECIDED`
    period : number of intervals, of releases or of separations, after which they repeat; 0 if they do not
    closure : s, largest difference between an interval and the one `period` (or one) later
    chaos : result of the 0-1 test, near 0 for regular and near 1 for chaotic motion; nan if it was not needed
    """

    kind: Outcome
    period: int = 0
    closure: float = math.nan
    chaos: float = math.nan

    def __str__(self) -> str:
        if self.period == 1:
            return "periodic"
        if self.period:
            return f"periodic, repeats after {self.period} intervals"
        return str(self.kind).replace("_", "-")


def motion_of(intervals: Array) -> Motion:
    """Classify a motion by the intervals between its releases, or between its separations, in s, shape
    (n,).

    Raises
    ------
    ValueError
        If there are fewer than `FEWEST` intervals.
    """
    if intervals.size < FEWEST:
        raise ValueError(f"{intervals.size} intervals: at least {FEWEST} are needed")
    period = shortest_period(intervals)
    if period:
        return Motion(Outcome.OTHER_CYCLE, period, closure(intervals, period))
    chaos = zero_one(intervals)
    kind = Outcome.UNDECIDED
    if chaos < REGULAR:
        kind = Outcome.QUASI_PERIODIC
    elif chaos > 1 - REGULAR:
        kind = Outcome.IRREGULAR
    return Motion(kind, 0, closure(intervals, 1), chaos)


def closure(intervals: Array, period: int) -> float:
    """Largest difference between an interval and the one `period` releases later, s."""
    return float(np.max(np.abs(intervals[period:] - intervals[:-period])))


def shortest_period(
    intervals: Array, tolerance: float = CLOSES, near_return: float = NEAR_RETURN
) -> int:
    """Least number of releases, up to half of all, after which intervals repeat to `tolerance` s; 0
    if there is none. One that closes no better than near returns (`NEAR_RETURN`) does not count,
    but for 1: a slow transient."""
    if not intervals.size:
        return 0
    extent = float(np.ptp(intervals))
    for n in range(1, intervals.size // 2 + 1):
        if abs(intervals[n] - intervals[0]) > tolerance:
            continue
        apart = closure(intervals, n)
        if apart <= tolerance and (n == 1 or apart <= near_return * extent / n):
            return n
    return 0


def zero_one(values: Array) -> float:
    """The 0-1 test for chaos: the median over random c of the growth of p + iq = sum of values
    exp(i c j).

    The 101 values of c are drawn from the middle of (0, pi); they are the same at every call.

    Parameters
    ----------
    values : shape (n,), a scalar signal with one value a cycle (an oversampled signal always seems regular)

    Returns
    -------
    float
        Near 0 if (p, q) stays bounded (periodic, quasi-periodic); near 1 if it diffuses (chaotic).
    """
    # imported here: it takes longer than most jobs, which do without this test
    from scipy.signal import correlate

    signal = np.asarray(values, dtype=float)
    signal = (signal - signal.mean()) / (signal.std() or 1.0)
    places = np.arange(1, signal.size + 1)
    steps = np.arange(1, max(2, signal.size // 10) + 1)
    count = signal.size - steps.size
    growths = []
    for c in np.random.default_rng(0).uniform(np.pi / 5, 4 * np.pi / 5, ANGLES):
        path = np.cumsum(signal * np.exp(1j * c * places))

        # mean of |path[i + j] - path[i]|^2 over i < count
        sums = np.append(0.0, np.cumsum(np.abs(path) ** 2))
        together = correlate(path, path[:count], mode="valid", method="fft").real
        square = sums[count + steps] - sums[steps] + sums[count] - 2 * together[steps]

        # it grows with j in chaos
        growths.append(np.corrcoef(steps, square)[0, 1] if np.ptp(square) else 0.0)
    return float(np.median(growths))


def separation_location(height: Array, starts: Indices) -> float:
    """Find the position in the oscillation at which contact is lost, from samples of the height.

    Parameters
    ----------
    height : uniform samples, shape (n,)
    starts : indices of the first samples of the separations

    Returns
    -------
    float
        Median share of the range of the cycle, one dominant period around the loss: 0 at its lowest, 1 at its highest
        point
    """
    # half a period of the dominant oscillation
    amplitude = np.abs(np.fft.rfft(height - np.mean(height)))
    oscillations = int(np.argmax(amplitude[1:]) + 1)
    half = max(2, round(len(height) / oscillations) // 2)

    shares = []
    for start in starts:
        cycle = height[max(0, start - half) : start + half + 1]
        shares.append((height[start] - cycle.min()) / (np.ptp(cycle) or 1.0))
    return float(np.median(shares))


def share(hits: int, trials: int, unknown: int = 0) -> tuple[float, float, float]:
    """Share of hits among trials, and the ends of its Wilson interval of 95 %. Further trials with an
    unknown result count as misses at the lower end and as hits at the upper."""
    from scipy.stats import binomtest

    if trials == 0:
        return np.nan, 0.0, 1.0
    low, high = (
        binomtest(count, trials + unknown).proportion_ci(method="wilson")
        for count in (hits, hits + unknown)
    )
    return hits / trials, float(low.low), float(high.high)


# ---- Points of a Poincare section, one sample every 2 pi/Omega

SAME = 0.01  # share of the range, along every axis, within which two points count as one


def first_settled(points: Array, start: int = 0) -> int:
    """Index from which all points lie on the set of a settled motion, which the later half of its
    points stands for.

    A point lies on the set if its distance from that half is at most `SAME`, or the largest between
    neighbours there.

    Parameters
    ----------
    points : shape (n, d), n > 0
    start : index from which the motion is known to have settled, by its drift: transients may be short beside a record
    """
    from scipy.spatial import KDTree

    ends = points[(start + len(points)) // 2 :]
    smallest = STILL * np.abs(ends).max(axis=0) + np.finfo(float).tiny
    extent = np.maximum(np.ptp(ends, axis=0), smallest)
    tree = KDTree(ends / extent)

    # neighbours on the set, the first of which is the point itself
    between, _ = tree.query(ends / extent, k=2, p=np.inf)
    distance, _ = tree.query(points / extent, p=np.inf)
    away = distance > max(SAME, float(between[:, 1].max()))
    return max(start, 1 + int(np.flatnonzero(away).max(initial=-1)))


# ---- Whether a motion has settled: the rate at which a record of it still changes, and the least
# rate that it shows. A record does not exclude what stays unseen, such as a slow departure from an
# unstable cycle or a sudden end of chaos.

WINDOWS = 8  # number of windows into which a record is cut,
LEAST_SAMPLES = 8  # and least number of samples in each
PARTS = 1 - np.geomspace(1, 0.05, 40)
"""Starts of later parts of a record, over its length: each omits 7 % of the rest."""
QUANTILE = 3.707
"""Of Student's t, `WINDOWS` - 2 degrees of freedom, 99 % on both sides: half-width of a slope."""
RESOLUTION = 0.01
"""Least change over a record that counts as visible, relative to the width of the motion."""
SLOWEST = 5e-5
"""1/s: a settled motion's width changes by less than 5 % in 1000 s, and the record can show that."""
STILL = 1e-3
"""Width, over the mean, below which a signal counts as constant: changes are then relative to this
width."""


class Settled(StrEnum):
    """Answers to the question whether a motion has settled, in the words of datasets."""

    UNDECIDED = "undecided"
    CHANGING = "changing"
    SETTLED = "settled"


class Settling(NamedTuple):
    """Answer to the question whether a motion has settled.

    Attributes
    ----------
    answer : `SETTLED` if the record excludes rates above `SLOWEST`, `CHANGING` if it shows such a rate
    rate : 1/s, rate of change relative to the motion's width; or growth rate of disturbances of a cycle
    least : 1/s, least rate that the record is able to show, of the part of the motion that changes if one does;
        infinite if the record is too short, 0 with multipliers
    since : s, time from which the motion has settled
    """

    answer: Settled = Settled.UNDECIDED
    rate: float = np.nan
    least: float = np.inf
    since: float = np.nan

    def __str__(self) -> str:
        if self.answer is Settled.UNDECIDED:
            return f"{self.answer}, since the record cannot show changes below {self.least:.2g}/s"
        return f"{self.answer} at {self.rate:.2g}/s"


def settling(
    time: ArrayLike, values: ArrayLike, slowest: float = SLOWEST, still: float = STILL
) -> Settling:
    """Decide by drift of mean, spread and number of samples whether a motion has settled in a
    record or its later part.

    Parameters
    ----------
    time : s, shape (n,), ascending: of events, of turns, or of bins
    values : shape (n,), of the motion at these times
    slowest : 1/s, least rate that matters
    still : least width to which changes are relative, over the mean; 1 for values that are widths themselves
    """
    t = np.asarray(time, dtype=float)
    x = np.asarray(values, dtype=float)
    if not t.size or not np.isfinite(x).all():
        return Settling()
    starts = t[0] + PARTS * (t[-1] - t[0])
    # shorter parts cannot show that little
    long = t[-1] - starts >= RESOLUTION / slowest
    for first in np.searchsorted(t, starts[long]):
        part = _drift(t[first:], x[first:], slowest, still)
        if part.answer is Settled.SETTLED:
            return part
    return _drift(t, x, slowest, still)


def _drift(t: Array, x: Array, slowest: float, still: float) -> Settling:
    """Whether mean, spread and number of samples change in a record, by straight lines through their
    values in windows; arguments as in `settling`."""
    edges = np.linspace(t[0], t[-1], WINDOWS + 1)
    windows = np.split(x, np.searchsorted(t, edges[1:-1]))
    counts = np.array([len(part) for part in windows])
    if counts.min() < LEAST_SAMPLES:
        return Settling()

    # moments of each window, relative to the width of the motion
    means, spreads = np.transpose([(part.mean(), part.std()) for part in windows])
    width = max(2 * spreads.max(), still * np.abs(means).max(), np.finfo(float).tiny)
    moments = np.array([means / width, 2 * spreads / width, counts / counts.mean()])

    # slopes of lines through them, and their errors, 1/s
    middle = (edges[1:] + edges[:-1]) / 2 - (t[0] + t[-1]) / 2
    (slopes, _), covariance = np.polyfit(middle, moments.T, 1, cov=True)
    errors = np.maximum(QUANTILE * np.sqrt(covariance[0, 0]), RESOLUTION / (t[-1] - t[0]))

    # the fastest change, of those that are clear if there are any
    sizes = np.abs(slopes)
    clear = sizes > np.maximum(errors, slowest)
    fastest = np.lexsort((sizes, clear))[-1]
    rate = float(slopes[fastest])
    if clear[fastest]:
        return Settling(Settled.CHANGING, rate, float(errors[fastest]))
    least = float(errors.max())
    if max(least, sizes.max()) <= slowest:
        return Settling(Settled.SETTLED, rate, least, float(t[0]))
    return Settling(Settled.UNDECIDED, rate, least)


SECTIONS = ("psi", "w_point")
"""Variables of a section that both must have settled."""


def settled_since(section: Mapping[str, ArrayLike], bins: Mapping[str, ArrayLike] | None) -> float:
    """Time from which all points of a motion's section lie on its end, s; nan if this is not shown.

    Parameters
    ----------
    section : samples once a turn of the drive, by name: time (s), and `SECTIONS` with their velocities, shape (n,)
    bins : ranges of an envelope beside it, if there is one, such as w_point_min and w_point_max: their widths decide
        where the section itself shows nothing
    """
    time = np.asarray(section["time"])
    since: list[float] = []
    for name in SECTIONS:
        found = settling(time, section[name])
        if math.isnan(found.since) and bins is not None:
            widths = np.subtract(bins[f"{name}_max"], bins[f"{name}_min"])
            # the last one is cut
            found = settling(np.asarray(bins["time"])[:-1], widths[:-1], still=1.0)
        since.append(found.since)
    if np.isnan(since).any():
        return math.nan
    start = min(int(np.searchsorted(time, max(since))), len(time) - 1)
    columns = [section[f"{name}{of}"] for name in SECTIONS for of in ("", "_velocity")]
    return float(time[first_settled(np.column_stack(columns), start)])
