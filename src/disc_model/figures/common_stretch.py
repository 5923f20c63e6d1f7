"""The stretch of time in which several runs on the same axes are seen beside each other."""

import math
from collections.abc import Sequence
from typing import NamedTuple

ROUNDING = 1e-3
"""Share of the shortest stretch by which equal times may differ: ends of samples differ by less."""


class Shown(NamedTuple):
    """What axes show of several stretches.

    from_end : whether time is counted from the end of each
    limits : of the time, s; None for all that is drawn
    """

    from_end: bool = False
    limits: tuple[float, float] | None = None


def stretch_shown(stretches: Sequence[tuple[float, float] | None]) -> Shown:
    """How runs are seen beside each other that are sampled in some stretches of time, s.

    Stretches up to a common end are seen where all have samples. Those that have no time in common are seen
    by the time before the end of each, and all others whole.
    """
    known = [stretch for stretch in stretches if stretch is not None]
    if len(known) < 2 or len(known) < len(stretches):
        return Shown()
    shortest = min(end - start for start, end in known)
    last_start = max(start for start, _ in known)
    first_end = min(end for _, end in known)
    if last_start >= first_end:
        return Shown(from_end=True, limits=(-shortest, 0.0))
    last_end = max(end for _, end in known)
    if math.isclose(first_end, last_end, abs_tol=ROUNDING * shortest):
        return Shown(limits=(last_start, last_end))
    return Shown()
