"""From the one tolerance a user gives to the order and the local tolerance of the series."""

from __future__ import annotations

import math

# Local truncation error for a tolerance of 1.  With it event times over a second come out 20 to 200 times better than
# the tolerance, measured against the long-double references.
LOCAL = 4.0
# A looser step is no cheaper, because the series must reach from switch to switch anyway, and begins to lose switches.
LOOSEST = 1e-5


def series_tolerance(tol: float) -> float:
    """Size of the last terms of a step, relative to the state's scale."""
    return min(LOCAL * tol, LOOSEST)


def series_order(tol: float) -> int:
    """Degree of the Taylor series: cheapest for the tolerance, measured (flat between 20 and 26 at 1e-10)."""
    digits = -math.log10(series_tolerance(tol) / LOCAL)
    return min(28, 2 + 2 * round(digits))
