"""The range of the disc under the slider, from the steps that a method takes."""

from __future__ import annotations

import numpy as np

from disc_model.benchmarks.methods.physics import Array, Physics


class Heights:
    """Least and greatest w (m) of what it is shown; nan before that."""

    def __init__(self, physics: Physics) -> None:
        self.physics = physics
        self.low, self.high = np.nan, np.nan

    def path(self, times: Array, states: Array) -> None:
        """Take in successive steps of one phase: times (s, shape (k,)), states (k, size).

        Between two steps w is the cubic that has its value and its rate at both.
        """
        q = self.physics
        w = states[:, q.a] @ q.shape
        rate = states[:, q.alpha] @ q.shape + states[:, q.f] * (states[:, q.b] @ q.slope)
        self.values(w)
        if len(w) > 1:
            self.values(_turns(np.diff(times), w, rate))

    def values(self, w: Array) -> None:
        """Take in values of w."""
        if w.size:
            self.low, self.high = float(np.fmin(self.low, w.min())), float(np.fmax(self.high, w.max()))


def _turns(h: Array, w: Array, rate: Array) -> Array:
    """Values of the cubics at their turning points inside their steps."""
    rise, first, last = np.diff(w), h * rate[:-1], h * rate[1:]
    square, cube = 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise
    with np.errstate(invalid="ignore", divide="ignore"):
        # roots of first + 2 square s + 3 cube s^2, in the form that does not cancel
        half = -(square + np.copysign(np.sqrt(square**2 - 3.0 * cube * first), square))
        s = np.concatenate([half / (3.0 * cube), first / half])
    start, first, square, cube = (np.concatenate([x, x]) for x in (w[:-1], first, square, cube))
    inside = (s > 0.0) & (s < 1.0)
    value = start + s * (first + s * (square + s * cube))
    turns: Array = value[inside]
    return turns
