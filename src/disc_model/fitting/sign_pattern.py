"""Signs of deviations over what was set: scatter changes them at every second step, a wrong model or a
wrong fixed parameter keeps them over long stretches."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from disc_model.arrays import Array
from disc_model.fitting.measured import Measurement
from disc_model.units import is_number

LARGE = 0.1
"""Deviation in standard deviations from which its sign counts: below, it may be one of rounding."""
RARE = 0.01
"""Share of fits of the right model that have as few changes of sign, below which these are a pattern."""


class SignPattern(NamedTuple):
    """Changes of sign between neighbouring deviations, and the steps between these."""

    changes: int
    steps: int

    @property
    def chance(self) -> float:
        """Share of fits of the right model with so few changes of sign: errors that are independent
        change it at each step with even odds."""
        from scipy import stats

        return float(stats.binom.cdf(self.changes, self.steps, 0.5))

    @property
    def is_systematic(self) -> bool:
        """Whether scatter hardly ever changes signs so rarely."""
        return self.steps > 0 and self.chance < RARE


def sign_pattern(measurements: Sequence[Measurement], deviations: Array) -> SignPattern:
    """Return the changes of sign of the deviations of each quantity, in the order of what was set.

    Parameters
    ----------
    measurements : the measurements
    deviations : computed minus measured values, in standard deviations, (m,)
    """
    changes = 0
    steps = 0
    for signs in _signs_by_quantity(measurements, deviations):
        changes += sum(before != after for before, after in pairwise(signs))
        steps += len(signs) - 1
    return SignPattern(changes, steps)


def _signs_by_quantity(measurements: Sequence[Measurement], deviations: Array) -> list[list[bool]]:
    """Whether deviations are positive, for each quantity measured under several settings, in their order."""
    groups: dict[tuple[str, ...], list[tuple[tuple[float, ...], bool]]] = {}
    for each, deviation in zip(measurements, deviations.tolist(), strict=True):
        if abs(deviation) < LARGE or not _are_numbers(each):
            continue
        names = sorted(each.at)
        settings = tuple(float(each.at[name]) for name in names)
        group = groups.setdefault((each.quantity_name, *names), [])
        group.append((settings, deviation > 0))
    return [[sign for _, sign in sorted(group)] for group in groups.values()]


def _are_numbers(measurement: Measurement) -> bool:
    """Whether something was set, and all of it by numbers, which have an order."""
    return bool(measurement.at) and all(map(is_number, measurement.at.values()))
