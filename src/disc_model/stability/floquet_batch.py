"""Cycles of many cases at once: plain arrays, for grids."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from disc_model.parameters import Parameters
from disc_model.stability.cycle import CycleStatus, find_cycle, growth_rate, multipliers
from disc_model.stability.sliding import steady_sliding

STATUS_NAMES = tuple(status.value for status in CycleStatus)
"""Names of the status codes: code i is STATUS_NAMES[i]."""


def solve(parameters: list[Parameters], tol: float = 1e-12) -> dict[str, NDArray[np.generic]]:
    """The stick-slip cycle and steady sliding of every case; each is computed for itself, whatever the others are.

    Returns
    -------
    dict of arrays of shape (len(parameters),)
        growth_rate : 1/s, of the cycle, nan without one
        period : s, nan without a cycle
        stick_fraction : nan without a cycle
        status : int8, index into STATUS_NAMES
        multiplier_re, multiplier_im : the leading multiplier, of a complex pair the upper one; nan without a cycle
        sliding_growth_rate : 1/s, of steady sliding, nan if that does not exist
    """
    n = len(parameters)
    numbers = ("growth_rate", "period", "stick_fraction", "multiplier_re", "multiplier_im", "sliding_growth_rate")
    columns = {name: np.full(n, math.nan) for name in numbers}
    status = np.zeros(n, np.int8)
    for i, p in enumerate(parameters):
        cycle = find_cycle(p, tol)
        status[i] = STATUS_NAMES.index(cycle.status.value)
        columns["sliding_growth_rate"][i] = steady_sliding(p).growth_rate
        if cycle.solution is None:
            continue
        flight, leading = cycle.solution.flight, multipliers(cycle.solution.jacobian)[0]
        columns["growth_rate"][i] = growth_rate(leading, flight.period)
        columns["period"][i] = flight.period
        columns["stick_fraction"][i] = flight.stick_time / flight.period
        columns["multiplier_re"][i], columns["multiplier_im"][i] = leading.real, leading.imag
    return {**columns, "status": status}
