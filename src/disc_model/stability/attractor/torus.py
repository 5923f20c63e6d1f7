"""Whether a motion has come to an attracting torus, by the multipliers of a near return.

On a torus the motion nearly returns to its point of the section after n releases. The map's Jacobian over them is then
nearly that of a cycle. One of its eigenvalues belongs to a shift along the torus. If distances decay in all other
directions, the torus attracts. The same eigenvalues and the motion's change over the n releases give its distance from
the torus, as a step of Newton's method does. Exact returns, on long cycles, are a limit of this.
"""

import math

import numpy as np

from disc_model.stability.return_map import Array, ReturnMap

RELEASES, FURTHER = 200, 400
"""Number of releases among which a near return is sought, some seconds, and how many more there are after a failure."""
FEWEST = 40
"""A near return takes more releases than this: over a shorter time, rates would be less accurate."""
NEAREST, PERIODIC = 0.01, 0.001
"""Largest distance of a near return, and of a return to a cycle of at most `FEWEST` releases, over the extent of the
motion's points."""
STEADY = 0.02
"""Largest relative change of this extent since the last test."""
TURNED = 1.0
"""Largest size of the logarithm of the eigenvalue along the torus: its mean is 0 on a torus, and positive in chaos."""
SLOWEST = 0.005
"""1/s, least rate at which distances from the torus must decay: above the error of rates from inexact returns."""
DISTANCE = 0.02
"""Largest distance of the motion from the torus, over the static deflection."""


class TorusTest:
    """Repeated test of one motion in contact, on the section of a return map."""

    def __init__(self, map_: ReturnMap) -> None:
        self.map, self.further, self.extent = map_, 0, math.nan

    def shows_torus(self, x: Array) -> bool:
        """Whether the motion at a point of the section, shape (n,), has come to an attracting torus."""
        points = self._points(x)
        if not self._is_steady(points):
            return False
        points = np.concatenate([points, self._points(points[-1], self.further)[1:]])
        if len(points) <= RELEASES + self.further:
            return False
        away = np.linalg.norm(points[1:] - x, axis=1)
        if away[:FEWEST].min() <= PERIODIC * self.extent:
            return False
        nearest = int(np.argmin(away[FEWEST:]))
        if away[FEWEST + nearest] <= NEAREST * self.extent and self._attracts(x, FEWEST + nearest + 1):
            return True
        self.further = FURTHER
        return False

    def shows_no_change(self, x: Array) -> bool:
        """Whether the motion's points have the extent that they had at the last test."""
        return self._is_steady(self._points(x))

    def _points(self, x: Array, releases: int = RELEASES) -> Array:
        return np.array([x, *self.map.returns(x, releases, coarse=True)])

    def _is_steady(self, points: Array) -> bool:
        before = self.extent
        self.extent = float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) > RELEASES else math.nan
        return abs(self.extent - before) <= STEADY * self.extent

    def _attracts(self, x: Array, releases: int) -> bool:
        """Whether the motion is near a torus, and distances from it decay, by a near return."""
        flight = self.map.evaluate(x, releases=releases, coarse=True)
        if not flight.returned or not np.all(np.isfinite(flight.jacobian)):
            return False
        values, vectors = np.linalg.eig(flight.jacobian)
        growth = np.log(np.maximum(abs(values), 1e-300))
        slowest = -SLOWEST * flight.period
        parts = np.linalg.lstsq(vectors, (flight.end - x).astype(complex))[0]
        # a near return lies beside its point along the torus: this shift neither turns nor decays
        shifts = (values.imag == 0) & (values.real > 0) & (abs(growth) <= TURNED)
        along = int(np.argmax(np.where(shifts, abs(parts), -1.0)))
        others = np.flatnonzero((np.arange(len(values)) != along) | ~shifts | (growth <= slowest))
        if growth[others].max() > slowest:
            return False
        distance = vectors[:, others] @ (parts[others] / (1 - values[others]))
        return bool(np.linalg.norm(distance) <= DISTANCE * self.map.deflection)
