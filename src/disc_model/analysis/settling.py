"""Whether a motion has settled: the rate at which a record of it still changes, and the least rate that it shows.

This is the one test behind "settled" in studies, figures and verdicts. A stable cycle that the motion follows
(`disc_model.stability.attractor.outcome`) proves more, since its multipliers know every rate. A
record shows no rate far below one over its length: what stays unseen, such as a slow departure from an unstable cycle
or a sudden end of a chaotic transient, is excluded by no record.
"""

from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from disc_model.data.variables import Variable

Array = NDArray[np.float64]
WINDOWS, FEWEST = 8, 8  # number of windows into which a record is cut, and least number of samples in each
PARTS = 1 - np.geomspace(1, 0.05, 40)
"""Starts of the later parts of a record that are tried, relative to its length: each leaves out 7 % of the rest."""
QUANTILE = 3.707
"""Of Student's t with `WINDOWS` - 2 degrees of freedom, 99 % on both sides: half-width of a slope, in its errors."""
RESOLUTION = 0.01  # least change over a record that counts as visible, relative to the width of the motion
SLOWEST = 5e-5
"""1/s: a motion has settled if its width changes by less than 5 % in 1000 s, and the record is able to show that."""
STILL = 1e-3  # width, over the mean, below which a signal counts as constant: changes are then relative to this width


class Settled(StrEnum):
    """Answers."""

    UNDECIDED = "undecided"
    CHANGING = "changing"
    SETTLED = "settled"


ANSWER = Variable("1", "whether the motion has settled", tuple(Settled))  # its variable in datasets


class Settling(NamedTuple):
    """Answer to the question whether a motion has settled.

    Attributes
    ----------
    answer : `SETTLED` if the record excludes rates above `SLOWEST`, `CHANGING` if it shows one
    rate : 1/s, rate of change relative to the motion's width; or growth rate of disturbances of a cycle
    least : 1/s, least rate that the record is able to show; infinite if it is too short, 0 with multipliers
    since : s, time from which the motion has settled
    """

    answer: Settled = Settled.UNDECIDED
    rate: float = np.nan
    least: float = np.inf
    since: float = np.nan

    def __str__(self) -> str:
        rate = "" if np.isnan(self.rate) else f" at {self.rate:.2g}/s"
        return f"{self.answer}{rate}, the record shows {self.least:.2g}/s or more"


def settling(time: ArrayLike, values: ArrayLike, slowest: float = SLOWEST, still: float = STILL) -> Settling:
    """Decide by the drift of mean, spread and number of samples among windows, over all of a record or its later part.

    Parameters
    ----------
    time : s, shape (n,), ascending: of events, of turns, or of bins
    values : shape (n,), of the motion at these times
    slowest : 1/s, least rate that matters
    still : least width to which changes are relative, over the mean; 1 for values that are widths themselves
    """
    t, x = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    if not t.size or not np.isfinite(x).all():
        return Settling()

    whole = _drift(t, x, slowest, still)
    # shorter parts cannot show that little
    starts = [start for start in t[0] + PARTS * (t[-1] - t[0]) if t[-1] - start >= RESOLUTION / slowest]
    later = (_drift(t[i:], x[i:], slowest, still) for i in np.searchsorted(t, starts))
    return next((part for part in later if part.answer is Settled.SETTLED), whole)


def _drift(t: Array, x: Array, slowest: float, still: float) -> Settling:
    """The answer of one record."""
    edges = np.linspace(t[0], t[-1], WINDOWS + 1)
    parts = np.split(x, np.searchsorted(t, edges[1:-1]))
    if min(part.size for part in parts) < FEWEST:
        return Settling()
    means, spreads, counts = np.array([(part.mean(), part.std(), part.size) for part in parts]).T
    width = max(2 * spreads.max(), still * float(np.abs(means).max()), np.finfo(float).tiny)
    moments = np.array([means / width, 2 * spreads / width, counts / counts.mean()])
    middle = (edges[1:] + edges[:-1]) / 2 - (t[0] + t[-1]) / 2
    slopes = moments @ middle / (middle @ middle)
    rest = moments - moments.mean(axis=1, keepdims=True) - np.outer(slopes, middle)
    errors = QUANTILE * np.sqrt((rest**2).sum(axis=1) / (WINDOWS - 2) / (middle @ middle))
    errors, sizes = np.maximum(errors, RESOLUTION / (t[-1] - t[0])), np.abs(slopes)
    clear = sizes > np.maximum(errors, slowest)
    fastest, least = int(np.argmax(sizes + clear)), float(errors.max())  # of those that are clear, if any
    if clear.any():
        return Settling(Settled.CHANGING, float(slopes[fastest]), least)
    if max(least, sizes.max()) <= slowest:
        return Settling(Settled.SETTLED, float(slopes[fastest]), least, float(t[0]))
    return Settling(Settled.UNDECIDED, float(slopes[fastest]), least)
