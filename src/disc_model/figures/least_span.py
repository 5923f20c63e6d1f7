"""Axes of values that are equal but for rounding: a flat line, and no peaks of rounding."""

from collections.abc import Iterable

import numpy as np

from disc_model.figures.types import Axes

LEAST_SPAN = 1e-9
"""Span of values over their size below which they are equal but for rounding."""
MARGIN = 0.05
"""Of the value, what an axis of equal values shows on either side."""


def equal_but_for_rounding(low: float, high: float) -> bool:
    """Whether all values between two are equal but for rounding."""
    return bool(high - low <= LEAST_SPAN * max(abs(low), abs(high)))


def keep_least_span(axes: Iterable[Axes]) -> None:
    """Widen vertical axes of values that are equal but for rounding, unless a reader has set their
    ends."""
    for ax in axes:
        low, high = ax.dataLim.intervaly
        is_free = ax.get_autoscaley_on() and ax.get_yscale() == "linear"
        varies = bool(np.isfinite([low, high]).all()) and low < high
        if is_free and varies and equal_but_for_rounding(low, high):
            middle = (low + high) / 2
            margin = MARGIN * abs(middle)
            ax.set_ylim(middle - margin, middle + margin, auto=True)
