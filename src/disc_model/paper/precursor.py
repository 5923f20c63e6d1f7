"""Rows on the abstract of the model's precursor, J. Sound Vib. 209 (1998): steady sliding where friction falls."""

from collections.abc import Sequence
from functools import cache

import numpy as np

from disc_model.paper.measures import Array, listed, sliding_growth
from disc_model.paper.model import FALSE, PART, TRUE, Answer, graded
from disc_model.parameters import Parameters

SPEEDS = np.arange(5.0, 1501.0, 5.0)  # rad/s, up to where all speeds are unstable without friction


@cache
def growths(loads: tuple[float, ...], c: float, **friction: float) -> list[Array]:
    """Largest growth rates of steady sliding in bilateral contact, 1/s: (load, speed).

    They are without friction, with it, and with it and a damper; for modes as published, then for modes by Eq. (17).
    """
    found = []
    for scale in ("as_published", "orthonormal"):
        p = Parameters(N=1, Omega=1, contact="bilateral", normalization=scale).replace(**friction)
        cases = p.replace(mu_s=0.0, mu_k=0.0), p, p.replace(c=c)
        points = [[[each.replace(N=N, Omega=speed) for speed in SPEEDS] for N in loads] for each in cases]
        found.append(np.array([[[*map(sliding_growth, row)] for row in rows] for rows in points]))
    return found


def texts(loads: Sequence[float], here: str, other: str) -> tuple[str, str]:
    """What was computed with the modes as published, and a note on modes by Eq. (17)."""
    return f"At {listed(loads, 'g')} N, {here}.", f"With modes by Eq. (17), {other}."


def additional(*, loads: Sequence[float], c: float, **friction: float) -> Answer:
    """Whether friction makes speeds unstable that are stable without, and the damper raises growth at all of them."""
    verdicts, found = [], []
    for alone, both, damped in growths(tuple(loads), c, **friction):
        new = (both > 0) & ~(alone > 0)
        raised = new & (damped > both)
        begins = f", all at {SPEEDS[raised.any(axis=0)].min():g} rad/s or more" if raised.any() else ""
        verdicts.append(FALSE if not new.any() else TRUE if (raised == new).all() else PART)
        found.append(
            f"steady sliding is unstable with friction and stable without it at {new.sum()} of {new.size} combinations "
            f"of load and speed. A damper of {c:g} N s/m normal to the disc raises growth at {raised.sum()} of these"
            f"{begins}, and stabilises {(new & (damped < 0)).sum()}"
        )
    return Answer(verdicts[0], *texts(loads, *found))


def reduced(*, loads: Sequence[float], c: float, **friction: float) -> Answer:
    """Whether friction lowers growth wherever sliding is unstable without it, and stabilises some of these speeds."""
    verdicts, found = [], []
    for alone, both, _ in growths(tuple(loads), c, **friction):
        old = alone > 0
        stable, lower = ((old & each).sum() for each in (both < 0, both < alone))
        verdicts.append(graded([lower == old.sum(), stable > 0]))
        text = f"steady sliding without friction is unstable at {old.sum()} combinations of load and speed"
        found.append(f"{text}. Friction stabilises {stable} of these, and lowers growth at {lower}")
    return Answer(verdicts[0], *texts(loads, *found))
