"""Rows on the abstract of the model's precursor, J. Sound Vib. 209 (1998): steady sliding where friction falls."""

from collections.abc import Sequence
from functools import cache

import numpy as np

from disc_model.paper.measures import Array, sliding_growth
from disc_model.paper.model import FALSE, NOT_COMPUTED, TRUE, Answer
from disc_model.paper.section2 import BASE, moving_load_speed
from disc_model.parameters import Parameters

SPEEDS = np.arange(5.0, 1501.0, 5.0)  # rad/s, up to where all speeds are unstable without friction


@cache
def growths(loads: tuple[float, ...], c: float, **friction: float) -> list[Array]:
    """Largest growth rates of steady sliding in bilateral contact, 1/s: (load, speed).

    They are without friction, with it, and with it and a damper; for modes as published, then for modes by Eq. (17).
    """
    rates = []
    for scale in ("as_published", "orthonormal"):
        p = Parameters(N=1, Omega=1, contact="bilateral", normalization=scale).replace(**friction)
        cases = p.replace(mu_s=0.0, mu_k=0.0), p, p.replace(c=c)
        points = [[[each.replace(N=N, Omega=speed) for speed in SPEEDS] for N in loads] for each in cases]
        rates.append(np.array([[[*map(sliding_growth, row)] for row in rows] for rows in points]))
    return rates


def additional(*, loads: Sequence[float], c: float, **friction: float) -> Answer:
    """Whether friction makes speeds unstable that are stable without, and the damper raises growth at all of them; open
    where it does at some, because the disc of the precursor, of which we have the abstract, is not known."""
    verdicts, rows, critical = [], [], moving_load_speed(BASE)
    for alone, both, damped in growths(tuple(loads), c, **friction):
        new = (both > 0) & ~(alone > 0)
        raised = new & (damped > both)
        verdicts.append(FALSE if not raised.any() else TRUE if (raised == new).all() else NOT_COMPUTED)
        slowest = SPEEDS[raised.any(axis=0)].min(initial=np.inf)
        below = new & (critical > SPEEDS)
        rows.append((new.sum(), raised.sum(), slowest, (new & (damped < 0)).sum(), below.sum()))
    return Answer(verdicts[0], rows=rows, size=new.size, loads=[*loads], c=c, critical=critical)


def reduced(*, loads: Sequence[float], c: float, **friction: float) -> Answer:
    """Whether friction lowers growth wherever sliding is unstable without it, and stabilises some of these speeds."""
    verdicts, rows = [], []
    for alone, both, _ in growths(tuple(loads), c, **friction):
        old = alone > 0
        stable, lower = ((old & each).sum() for each in (both < 0, both < alone))
        verdicts.append(FALSE if not lower else TRUE if lower == old.sum() and stable else NOT_COMPUTED)
        rows.append((old.sum(), stable, lower))
    return Answer(verdicts[0], rows=rows, size=old.size, loads=[*loads])
