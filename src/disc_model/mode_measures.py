"""Quantities of the motion by which the number of modes of a case is chosen."""

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

from disc_model.mode_request import SLIDING_GROWTH
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.stability.floquet import floquet
from disc_model.stability.sliding import steady_sliding

HORIZON = 600.0  # s, simulated at most until the first separation


def growth(p: Parameters) -> float:
    """Growth rate of the stick-slip cycle, 1/s; nan without a cycle."""
    return float(floquet(p).growth_rate)


def sliding_growth(p: Parameters) -> float:
    """Growth rate of steady sliding, 1/s; nan if there is none."""
    return _sliding(p).growth_rate


def growing_modes(p: Parameters) -> int:
    """Number of modes of steady sliding that grow."""
    return _sliding(p).growing_modes


class _Sliding(NamedTuple):
    """What is kept of steady sliding, whose matrices are large."""

    growth_rate: float
    growing_modes: int


@lru_cache(maxsize=64)  # the rate is asked for first, and the growing modes of two models later
def _sliding(p: Parameters) -> _Sliding:
    """The growth rate of steady sliding, and how many modes grow."""
    found = steady_sliding(p)
    return _Sliding(found.growth_rate, found.growing.size)


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
