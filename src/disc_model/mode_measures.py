"""Quantities of the motion by which the number of modes of a case is chosen."""

import math
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.stability.floquet import floquet
from disc_model.stability.sliding import steady_sliding

SLIDING_GROWTH = "sliding_growth"  # the growth rate of steady sliding
HORIZON = 600.0  # s, simulated at most until the first separation


def growth(p: Parameters) -> float:
    """Growth rate of the stick-slip cycle, 1/s; nan without a cycle."""
    return float(floquet(p).growth_rate)


def sliding_growth(p: Parameters, highest: float = math.inf) -> float:
    """Growth rate of steady sliding, 1/s, of modes up to a frequency in Hz; nan if there is none."""
    rates = [value.real for value in _judged(p, highest)]
    return max(rates, default=math.nan)


def growing_modes(p: Parameters, highest: float = math.inf) -> int:
    """Number of modes of steady sliding that grow, up to a frequency in Hz."""
    grow = [value for value in _judged(p, highest) if value in _sliding(p).growing]
    return len(grow)


def growing_frequency(p: Parameters, highest: float = math.inf) -> float:
    """Frequency of the mode of steady sliding that grows fastest, up to a frequency, Hz; nan if there
    is none."""
    judged = _judged(p, highest)
    if not judged:
        return math.nan
    fastest = max(judged, key=lambda value: value.real)
    return fastest.imag / math.tau


class _Sliding(NamedTuple):
    """What is kept of steady sliding, whose matrices are large: its eigenvalues with a frequency of 0
    and above, and those of them that grow."""

    eigenvalues: tuple[complex, ...]
    growing: tuple[complex, ...]


def _judged(p: Parameters, highest: float) -> list[complex]:
    """The eigenvalues of steady sliding up to a frequency in Hz."""
    return [value for value in _sliding(p).eigenvalues if value.imag <= math.tau * highest]


@lru_cache(maxsize=64)  # the rate is asked for first, and the growing modes of two models later
def _sliding(p: Parameters) -> _Sliding:
    """The eigenvalues of steady sliding."""
    found = steady_sliding(p)
    values = found.eigenvalues[found.eigenvalues.imag >= 0]
    return _Sliding(tuple(values.tolist()), tuple(found.growing.tolist()))


def first_separation(p: Parameters) -> float:
    """Time of the first separation, s; nan if there is none within `HORIZON`."""
    result = simulate(p, HORIZON, stop_at="first_separation", events=False)
    return result.raise_for_status().first_separation


LACKING = {
    "growth": "cycle",
    SLIDING_GROWTH: "state of steady sliding",
    "first_separation": f"separation within {HORIZON:g} s",
}
"""What a model does not have whose quantity is nan."""
MEASURES: dict[str, Callable[[Parameters], float]] = {
    "growth": growth,
    SLIDING_GROWTH: sliding_growth,
    "first_separation": first_separation,
}
