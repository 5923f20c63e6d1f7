"""Slips in a friction force over time, measured or simulated, by the same rules."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

Array = NDArray[np.float64]

RATE = 2000.0
"""Samples of the force per second."""
WINDOW = 5
"""Samples of the median that smoothes the force."""
FALL = 0.02
"""Least fall of a slip, and least rise that ends it; force over weight. This is the planned value."""
LEAST_FALLS = (FALL, 0.03, 0.04)
"""Least falls with which every slip is found once more, to see what depends on them."""
PARTS = (0.05, 0.95)
"""Parts of the fall between which its duration is taken."""


class Slip(NamedTuple):
    """A slip: when it begins (s), the force over the weight before and after it, and its duration
    (s)."""

    start: float
    before: float
    after: float
    duration: float


def slips(force: Array, least_fall: float = FALL) -> list[Slip]:
    """Find the slips of a force over the weight, sampled at `RATE`.

    A slip is a fall of more than `least_fall` from a local maximum to the next local minimum, ended
    by a rise of as much.
    """
    smooth = median_filter(force, WINDOW, mode="nearest")
    found: list[Slip] = []
    rising = True
    top = bottom = 0
    for i, value in enumerate(smooth):
        if rising and value > smooth[top]:
            top = i
        elif rising and smooth[top] - value > least_fall:
            rising = False
            bottom = i
        elif not rising and value < smooth[bottom]:
            bottom = i
        elif not rising and value - smooth[bottom] > least_fall:
            found.append(_slip(smooth, top, bottom))
            rising = True
            top = i
    return found


def _slip(smooth: Array, top: int, bottom: int) -> Slip:
    """Return the slip between two samples."""
    before, after = smooth[top], smooth[bottom]
    part = (before - smooth[top : bottom + 1]) / (before - after)
    begins = np.flatnonzero(part < PARTS[0])[-1]
    ends = np.flatnonzero(part > PARTS[1])[0]
    return Slip(top / RATE, float(before), float(after), float(ends - begins) / RATE)
