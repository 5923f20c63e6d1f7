"""Words for motions, each with a definition that a number decides.

The in-plane motion is judged by the times between successive releases of stick, T_1, T_2, ...: a motion that repeats
after n of them is periodic with period n, however large n is, if the record holds two periods. What does not repeat
within half the record is quasi-periodic or irregular by the 0-1 test for chaos (Gottwald and Melbourne, SIAM J. Appl.
Dyn. Syst. 8, 129-145, 2009).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.signal import correlate

from disc_model.data.variables import Outcome

Array = NDArray[np.float64]
CLOSES = 1e-8
"""How exactly intervals of a periodic motion repeat, s: what is left of the approach after minutes is smaller, and the
own differences of a motion on a torus are mostly far larger."""
NEAR_RETURN = 1e-3
"""A quasi-periodic motion, too, comes back: among its first n returns one misses by about 1/n of its spread. A period
of n must close a thousand times better than that."""
FEWEST = 20
"""Fewest intervals that a motion is judged by."""
SETTLED = 0.01
"""Largest relative change of ranges, rates and shares over 40 s and more of a motion that has settled. Motions that are
not periodic vary by half of it. What grows or dies out by 0.00025/s or faster changes by more."""
REGULAR = 0.3
"""Result of the 0-1 test, which tends to 0 or to 1 with more intervals, below which a motion is regular; and as far
below 1, above which it is chaotic. Signals of known nature stay within a tenth of these ends."""
FREQUENCIES = 101
"""Of which the 0-1 test takes the median."""


class Motion(NamedTuple):
    """What a sequence of intervals is.

    Attributes
    ----------
    kind : `OTHER_CYCLE` (in contact, the quiet one included) or `SEPARATING` if it repeats, else `QUASI_PERIODIC`,
        `IRREGULAR` or, where the 0-1 test lies between the two, `UNDECIDED`
    period : number of releases after which it repeats, 0 if it does not
    spread : standard deviation over mean of the intervals; 0 for a motion with one release a period
    closure : s, largest difference of an interval and the one `period` (or one) later
    chaos : result of the 0-1 test, near 0 for regular and near 1 for chaotic motion; nan if it was not needed
    longest : longest period that the record could have shown, in releases
    """

    kind: Outcome
    period: int
    spread: float
    closure: float
    chaos: float
    longest: int

    def __str__(self) -> str:
        if self.period:
            return "periodic" if self.period == 1 else f"periodic, repeats after {self.period} releases"
        return str(self.kind).replace("_", "-")


def motion_of(intervals: Array, tolerance: float = CLOSES, *, separates: bool = False) -> Motion:
    """Classify a motion by the intervals between its releases, or between its separations.

    Parameters
    ----------
    intervals : s, shape (n,)
    tolerance : s, how exactly a periodic motion has to repeat: above what is left of the approach to it, far below
        the intervals' own differences
    separates : whether it loses contact

    Raises
    ------
    ValueError
        With fewer than `FEWEST` intervals.
    """
    if intervals.size < FEWEST:
        raise ValueError(f"{intervals.size} intervals: at least {FEWEST} are needed")
    spread = irregularity(intervals)
    longest = intervals.size // 2
    if period := shortest_period(intervals, tolerance):
        kind = Outcome.SEPARATING if separates else Outcome.OTHER_CYCLE
        return Motion(kind, period, spread, closure(intervals, period), np.nan, longest)
    chaos = zero_one(intervals)
    kind = (
        Outcome.QUASI_PERIODIC if chaos < REGULAR else Outcome.IRREGULAR if chaos > 1 - REGULAR else Outcome.UNDECIDED
    )
    return Motion(kind, 0, spread, closure(intervals, 1), chaos, longest)


def irregularity(intervals: Array) -> float:
    """Standard deviation over mean."""
    return float(np.std(intervals) / np.mean(intervals))


def closure(intervals: Array, period: int) -> float:
    """Largest difference between an interval and the one `period` releases later, s."""
    return float(np.max(np.abs(intervals[period:] - intervals[:-period])))


def shortest_period(intervals: Array, tolerance: float, near_return: float = NEAR_RETURN) -> int:
    """Least number of releases after which intervals repeat to `tolerance` s; 0 if there is none.

    At most half the intervals: a period must be seen twice. One that closes no better than the near returns of a
    quasi-periodic motion do (see `NEAR_RETURN`, or another share) is none, but for a period of 1: from one release to
    the next there is no near return, only a slow approach or drift, which `tolerance` is there to allow.
    """
    extent = float(np.ptp(intervals)) if intervals.size else 0.0
    for n in range(1, intervals.size // 2 + 1):
        if abs(intervals[n] - intervals[0]) > tolerance:
            continue
        apart = closure(intervals, n)
        if apart <= tolerance and (n == 1 or apart <= near_return * extent / n):
            return n
    return 0


def zero_one(values: Array) -> float:
    """The 0-1 test for chaos: the median over random c of the growth of p + iq = sum of values exp(i c j).

    The c, `FREQUENCIES` of them, are drawn from the middle of (0, pi), the same at every call.

    Parameters
    ----------
    values : shape (n,), a scalar signal with one value a cycle (no oversampled one, which always seems regular)

    Returns
    -------
    float
        Near 0: the translation stays bounded (periodic, quasi-periodic). Near 1: it diffuses (chaotic).
    """
    signal = np.asarray(values, dtype=float)
    signal = (signal - signal.mean()) / (signal.std() or 1.0)
    n, n_cut = signal.size, max(2, signal.size // 10)
    steps = np.arange(1, n_cut + 1)
    drawn = np.random.default_rng(0).uniform(np.pi / 5, 4 * np.pi / 5, FREQUENCIES)
    found = [_growth(signal, float(c), steps, n - n_cut) for c in drawn]
    return float(np.median(found))


def _growth(signal: Array, c: float, steps: NDArray[np.int64], count: int) -> float:
    """Correlation of the mean square displacement with time; its oscillating part is subtracted."""
    path = np.cumsum(signal * np.exp(1j * c * np.arange(1, signal.size + 1)))
    sums = np.append(0.0, np.cumsum(np.abs(path) ** 2))
    # of |path[i + j] - path[i]|^2 over i < count
    together = correlate(path, path[:count], mode="valid", method="fft").real
    square = (sums[count + steps] - sums[steps] + sums[count] - 2 * together[steps]) / count
    square -= signal.mean() ** 2 * (1 - np.cos(c * steps)) / (1 - np.cos(c))
    if np.ptp(square) == 0:
        return 0.0
    return float(np.corrcoef(steps, square)[0, 1])


def stick_disappears(before: float, after: float, bound: float = 1e-3) -> bool:
    """Whether a motion that sticks for a share of time `before` a separation does so no more `after` it.

    `bound` is the share of time that counts as none: a stray stick among thousands of cycles does not refute it.
    """
    return before > bound >= after


class Location(NamedTuple):
    """Where in the swing contact is lost.

    Attributes
    ----------
    kind : "at the lowest position", "falling", "rising" or "at the highest position"
    height : share of the swing, 0 at the lowest and 1 at the highest point, median
    to_lowest : median share of the swing between the loss of contact and the next lowest point
    """

    kind: str
    height: float
    to_lowest: float


def separation_location(time: Array, height: Array, starts: NDArray[np.int64], bound: float = 0.1) -> Location:
    """Where in the swing contact is lost, from samples of the height and the indices of the losses.

    Parameters
    ----------
    time, height : uniform samples, shape (n,)
    starts : indices into them, first samples of the separations
    bound : share of the swing within which a point is the lowest (or the highest) one

    Notes
    -----
    "At the lowest position": the loss is within `bound` of the swing of the lowest point of its own cycle, whether
    just before or just after it. The cycle is the stretch of one dominant period around the loss.
    """
    velocity = np.gradient(height, time)
    # half a period of the dominant oscillation
    amplitude = np.abs(np.fft.rfft(height - np.mean(height)))
    half = max(2, round(len(height) / max(1, int(np.argmax(amplitude[1:]) + 1))) // 2)
    share, lowest, speed = [], [], []
    for i in starts:
        cycle = height[max(0, i - half) : i + half + 1]
        swing = float(np.ptp(cycle)) or 1.0
        share.append((height[i] - cycle.min()) / swing)
        ahead = height[i : i + half + 1]
        lowest.append((height[i] - ahead.min()) / swing)
        speed.append(velocity[i])
    if not share:
        raise ValueError("no separation")
    where, drop, moving = (float(np.median(x)) for x in (share, lowest, speed))
    if where <= bound:
        kind = "at the lowest position"
    elif where >= 1 - bound:
        kind = "at the highest position"
    else:
        kind = "rising" if moving > 0 else "falling"
    return Location(kind, where, drop)
