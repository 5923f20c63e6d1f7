"""Whether a motion has come to an attracting torus, by the multipliers of a near return.

On a torus the motion nearly returns to its point of the section after n releases. The map's Jacobian over them is then
nearly that of a cycle. One of its eigenvalues belongs to a shift along the torus. If distances decay in all other
directions, the torus attracts. The same eigenvalues and the motion's change over the n releases give its distance from
the torus, as a step of Newton's method does. Exact returns, on long cycles, are a limit of this.
"""

import math

import numpy as np

from disc_model.stability.attractor import thresholds
from disc_model.stability.return_map import Array, ReturnMap


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
        if len(points) <= thresholds.TORUS_RELEASES + self.further:
            return False
        away = np.linalg.norm(points[1:] - x, axis=1)
        if away[: thresholds.TORUS_FEWEST].min() <= thresholds.TORUS_PERIODIC * self.extent:
            return False
        nearest = thresholds.TORUS_FEWEST + int(np.argmin(away[thresholds.TORUS_FEWEST :]))
        if away[nearest] <= thresholds.TORUS_NEAREST * self.extent and self._attracts(x, nearest + 1):
            return True
        self.further = thresholds.TORUS_FURTHER
        return False

    def shows_no_change(self, x: Array) -> bool:
        """Whether the motion's points have the extent that they had at the last test."""
        return self._is_steady(self._points(x))

    def _points(self, x: Array, releases: int = thresholds.TORUS_RELEASES) -> Array:
        return np.array([x, *self.map.returns(x, releases, coarse=True)])

    def _is_steady(self, points: Array) -> bool:
        before, whole = self.extent, len(points) > thresholds.TORUS_RELEASES
        self.extent = float(np.linalg.norm(np.ptp(points, axis=0))) if whole else math.nan
        return abs(self.extent - before) <= thresholds.TORUS_STEADY * self.extent

    def _attracts(self, x: Array, releases: int) -> bool:
        """Whether the motion is near a torus, and distances from it decay, by a near return."""
        flight = self.map.evaluate(x, releases=releases, coarse=True)
        if not flight.returned or not np.all(np.isfinite(flight.jacobian)):
            return False
        values, vectors = np.linalg.eig(flight.jacobian)
        growth = np.log(np.maximum(abs(values), 1e-300))
        slowest = -thresholds.TORUS_SLOWEST * flight.period
        parts = np.linalg.lstsq(vectors, (flight.end - x).astype(complex))[0]
        # a near return lies beside its point along the torus: this shift neither turns nor decays
        shifts = (values.imag == 0) & (values.real > 0) & (abs(growth) <= thresholds.TORUS_TURNED)
        along = int(np.argmax(np.where(shifts, abs(parts), -1.0)))
        others = np.flatnonzero((np.arange(len(values)) != along) | ~shifts | (growth <= slowest))
        if growth[others].max() > slowest:
            return False
        distance = vectors[:, others] @ (parts[others] / (1 - values[others]))
        return bool(np.linalg.norm(distance) <= thresholds.TORUS_DISTANCE * self.map.deflection)
