"""From the one tolerance a user gives to the order and the local tolerance of the series."""

from __future__ import annotations

import math


def series_order(tol: float) -> int:
    """Degree of the Taylor series: cheapest for the tolerance, measured (flat between 20 and 28 at 1e-10)."""
    digits = -math.log10(tol)
    return max(8, min(28, 4 + 2 * round(digits)))


def series_tolerance(tol: float) -> float:
    """Size of the last terms of a step, relative to the state's scale."""
    return tol
