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
    padded = np.pad(slopes, 1, constant_values=np.nan)
    beside = np.array([padded[:-2], padded[2:]])
    steps = np.isfinite(beside).sum(axis=0)
    sizes = np.abs(slopes)
    # steps beside have the same direction, and are not much less steep
    goes_on = (slopes * beside > 0) & (sizes <= STEEPER * np.abs(beside))
    at_end = sizes > STEEPER_AT_END * np.fmax(*np.abs(beside))
    jumps = np.choose(steps, [change > LEAST_ALONE, at_end, ~goes_on.any(axis=0)])
    return (change > LEAST) & jumps
