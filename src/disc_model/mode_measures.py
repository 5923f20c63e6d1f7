"""Quantities of the motion by which the number of modes of a case is chosen."""

from collections.abc import Callable

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
    return steady_sliding(p).growth_rate


def first_separation(p: Parameters) -> float:
    """Time of the first separation, s; nan if there is none within `HORIZON`."""
    result = simulate(p, HORIZON, stop_at="first_separation", events=False)
    return result.raise_for_status().first_separation


MEASURES: dict[str, Callable[[Parameters], float]] = {
    "growth": growth,
    SLIDING_GROWTH: sliding_growth,
    "first_separation": first_separation,
}
