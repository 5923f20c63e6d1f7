"""Whether a search has ended at a minimum of chi squared, and where chi squared is less if it has not.

The search shortens its steps in all parameters alike where one of them cannot go on, as in front of a rule of cases,
and ends although others would still lower chi squared."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from disc_model.arrays import Array, Mask

PARTS = tuple(0.25**i for i in range(6))
"""Parts of steps that are tried."""
GAIN = (1e-3, 1e-8)
"""Least decrease of chi squared that counts, and over chi squared."""
LONGEST = 1.0
"""Longest step, over the parameters' scale."""
HELD = 1e-6
"""Distance from a limit at which it holds a parameter, over the parameter's scale."""


def free_of_limits(end: Any, low: Array, high: Array) -> Mask:
    """Return which scaled parameters no limit holds at the end of a search, (n,).

    Parameters
    ----------
    end : of the search
    low, high : limits of the scaled parameters, (n,)
    """
    downhill = -(end.jac.T @ end.fun)
    below = (end.x - low <= HELD) & (downhill < 0)
    above = (high - end.x <= HELD) & (downhill > 0)
    return np.asarray((end.active_mask == 0) & ~below & ~above)


def next_step(end: Any, free: Mask) -> Array:
    """Return the step of free scaled parameters from the end of a search to where chi squared would be
    least if predictions were linear, (n,)."""
    step = np.zeros(len(end.x))
    step[free] = -np.linalg.lstsq(end.jac[:, free], end.fun, rcond=None)[0]
    return step


def decrease_over(end: Any, step: Array) -> float:
    """Return how much chi squared would decrease over a step if predictions were linear."""
    linear = end.fun + end.jac @ step
    return float(end.fun @ end.fun - linear @ linear)


def lower_point(
    end: Any, free: Mask, low: Array, high: Array, deviations: Callable[[Array], Array]
) -> Array | None:
    """Return scaled parameters within limits at which chi squared is less than at the end of a search;
    None where none are found.

    Parameters
    ----------
    end : of the search
    free : parameters that no limit holds, (n,)
    low, high : limits of the scaled parameters, (n,)
    deviations : over the scaled parameters
    """
    least = float(end.fun @ end.fun)
    gain = max(GAIN[0], GAIN[1] * least)
    steps = [_shortened(step) for step in _steps(end, free)]
    for part in PARTS:
        for step in steps:
            x = end.x + part * step
            if not ((low < x) & (x < high)).all():
                continue
            moved = deviations(x)
            if float(moved @ moved) < least - gain:
                return x
    return None


def _steps(end: Any, free: Mask) -> Iterator[Array]:
    """Yield steps that may lead to a smaller chi squared: of all free parameters, of each alone, and
    both ways along what is known, by its standard deviation."""
    yield next_step(end, free)
    for i in np.flatnonzero(free):
        alone = np.zeros(len(free), bool)
        alone[i] = True
        yield next_step(end, alone)
    _, sizes, directions = np.linalg.svd(end.jac * free, full_matrices=False)
    for size, direction in zip(sizes, directions, strict=True):
        if size > 0:
            yield direction / size
            yield -direction / size


def _shortened(step: Array) -> Array:
    """Return a step that is at most the longest one."""
    longest = float(np.max(np.abs(step)))
    return step * min(1.0, LONGEST / max(longest, np.finfo(float).tiny))
