"""Multipliers of a cycle, and what they say of it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

ComplexArray = NDArray[np.complex128]

KINDS = ("fold", "period_doubling", "neimark_sacker")


def multipliers(jacobian: NDArray[np.float64]) -> ComplexArray:
    """Eigenvalues of the return map's Jacobian, largest modulus first; of a complex pair the upper one first."""
    values = np.linalg.eigvals(jacobian).astype(complex)
    return values[np.lexsort((-values.imag, -values.real, -np.round(np.abs(values), 14)))]


def growth_rate(multiplier: complex, period: float) -> float:
    """log of the modulus over the period, 1/s; -inf for a multiplier of zero."""
    return math.log(abs(multiplier)) / period if multiplier else -math.inf


def kind_of(multiplier: complex) -> str:
    """Which bifurcation a multiplier brings when it crosses the unit circle."""
    if multiplier.imag != 0:
        return KINDS[2]
    return KINDS[0] if multiplier.real > 0 else KINDS[1]
