"""Steps of the speed at which the stick-slip frequency jumps from one kind of cycle to another."""

import numpy as np

from disc_model.arrays import Array, Mask

LEAST = 0.01
"""Relative change from which a step may be a jump."""
LEAST_ALONE = 0.1
"""Relative change from which it is one if there is no step beside it."""
STEEPER = 3.0
"""How many times as steep as those beside it a jump is at least."""
STEEPER_AT_END = 10.0
"""The same of a step that has another on one side only: a curve may flatten out over a wide step."""


def frequency_jumps(speeds: Array, frequency: Array) -> Mask:
    """Steps between ascending speeds at which a frequency jumps, one fewer than the speeds: it goes on
    neither before nor after with a like slope. None beside a speed without a frequency."""
    slopes = np.diff(frequency) / np.diff(speeds)
    change = np.abs(np.diff(np.log(frequency)))
    beside = np.concatenate([[np.nan], slopes, [np.nan]])
    before = beside[:-2]
    after = beside[2:]
    steps_beside = np.isfinite(before).astype(int) + np.isfinite(after)
    goes_on = _goes_on(slopes, before) | _goes_on(slopes, after)
    steepest = np.fmax(np.abs(before), np.abs(after))
    inside = (steps_beside == 2) & ~goes_on
    at_end = (steps_beside == 1) & (np.abs(slopes) > STEEPER_AT_END * steepest)
    alone = (steps_beside == 0) & (change > LEAST_ALONE)
    return (change > LEAST) & (inside | at_end | alone)


def _goes_on(slopes: Array, others: Array) -> Mask:
    """Whether others have the same direction as slopes, and are not much less steep."""
    return (slopes * others > 0) & (np.abs(slopes) <= STEEPER * np.abs(others))
