"""The residual flexibility of a plate with modes as published, along a branch in the plate's shape.

It is the difference of two modal sums, the larger over a thousand modes, and takes a second for
each value of nu, a or b, where an orbit takes a millisecond.  Along a branch it is interpolated by
Chebyshev polynomials over short intervals, to rounding.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import Chebyshev

from disc_model.disc.flexibility import contact_compliance, is_modal_sum
from disc_model.errors import DiscModelError
from disc_model.parameters import RATIOS, RESIDUAL, Parameters

SHAPE = ("nu", "a", "b")  # parameters on which the modes' shapes depend, and not only their scale
LONGEST = 0.1  # longest interval, over the parameter's value
HALVINGS = 6  # of an interval in which the polynomial does not converge, as beside a pole
DEGREE = 8  # of the polynomial
CONVERGED = 1e-10  # last coefficients over the first: the next one is smaller by 20 and more


class CompliantPlate:
    """The contact compliance of a case with "residual" contact along one of its numbers."""

    def __init__(self, base: Parameters, name: str) -> None:
        self.base = base
        self.name = name
        self.longest = LONGEST * abs(base.numbers[name])
        self._polynomials: dict[tuple[int, int], Chebyshev | None] = {}

    @staticmethod
    def is_needed(base: Parameters, names: tuple[str, ...]) -> bool:
        """Whether the compliance takes seconds at each value of a single free parameter."""
        if base.contact_compliance != RESIDUAL or not is_modal_sum(base) or len(names) > 1:
            return False
        changed = RATIOS[names[0]][0] if names[0] in RATIOS else names[0]
        return changed in SHAPE

    def at(self, value: float) -> float:
        """The contact compliance, m/N, at a value of the number; raises `ParameterError` or
        `ModeError` where there is none."""
        for halvings in range(HALVINGS):
            width = self.longest * 0.5**halvings
            place = math.floor(value / width)
            if (halvings, place) not in self._polynomials:
                self._polynomials[halvings, place] = self._interpolate(place * width, width)
            polynomial = self._polynomials[halvings, place]
            if polynomial is not None:
                return float(polynomial(value))
        return self._compute(value)

    def _compute(self, value: float) -> float:
        return contact_compliance(self.base.replace(**{self.name: value}))

    def _interpolate(self, low: float, width: float) -> Chebyshev | None:
        """The polynomial over an interval; None where it does not converge, or a value has no
        compliance."""

        def computed(values: np.ndarray) -> np.ndarray:
            return np.array([self._compute(float(value)) for value in values])

        try:
            polynomial = Chebyshev.interpolate(computed, DEGREE, (low, low + width))
        except DiscModelError:
            return None
        small = np.abs(polynomial.coef[-2:]) <= CONVERGED * abs(polynomial.coef[0])
        return polynomial if np.all(small) else None
