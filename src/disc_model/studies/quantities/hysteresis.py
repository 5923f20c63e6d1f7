"""Hysteresis: a slow sweep of the speed up and down, which continues the motion from speed to
speed."""

from dataclasses import asdict
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import PrivateAttr

from disc_model.analysis.classify import ANSWER
from disc_model.data.variables import Variable, value_with_unit
from disc_model.studies.quantity import (
    DIRECTION,
    STATUS,
    STATUSES,
    Coordinate,
    Point,
    Quantity,
    Range,
)
from disc_model.units import Seconds, Tolerance, Unit

_DIMS = ("direction", "sweep_Omega")


class Hysteresis(Quantity):
    """A sweep of the speed up from the static start and down again; each speed continues the motion
    of the last one."""

    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""
    scan: Annotated[Range, Unit("rad/s")]
    """speeds of the sweep"""
    dwell: Seconds
    """time at each speed, doubled until the motion has settled"""
    max_dwell: Seconds = 480.0
    """longest time at a speed"""
    evaluation_time: Seconds = 5.0
    """length of the last stretch at a speed, which is described"""

    _parameter: str = PrivateAttr(default="Omega")

    _rules = (
        (
            lambda o: o.evaluation_time <= o.dwell,
            "evaluation_time={0.evaluation_time:g} must be <= dwell={0.dwell:g}",
        ),
        (
            lambda o: o.max_dwell >= o.dwell,
            "max_dwell={0.max_dwell:g} must be >= dwell={0.dwell:g}",
        ),
    )
    points_per_job: ClassVar = 3
    scans: ClassVar = ("Omega",)
    COLUMNS: ClassVar = {
        "status": STATUS,
        "sweep_status": STATUS._replace(dims=_DIMS),
        "sweep_settled": ANSWER._replace(dims=_DIMS),
        "stay": Variable(
            "s", "length of the stay at a speed; the stretch that is described follows", dims=_DIMS
        ),
        "separation_rate": Variable(
            "s-1", "separations per second at the end of the stay at a speed", dims=_DIMS
        ),
        "u_min": Variable(
            "m",
            "lowest position of the slider at the end of the stay at a speed, from static equilibrium",
            dims=_DIMS,
        ),
        "u_max": Variable(
            "m",
            "highest position of the slider at the end of the stay at a speed, from static equilibrium",
            dims=_DIMS,
        ),
        "range": Variable(
            "m", "range of the slider's height at the end of the stay at a speed", dims=_DIMS
        ),
        "P_min": Variable("N", "least contact force at the end of the stay at a speed", dims=_DIMS),
        "P_max": Variable(
            "N", "greatest contact force at the end of the stay at a speed", dims=_DIMS
        ),
        "stick_fraction": Variable("1", "share of the time spent sticking", dims=_DIMS),
        "slip_fraction": Variable("1", "share of the time spent slipping", dims=_DIMS),
        "separation_fraction": Variable("1", "share of the time spent separated", dims=_DIMS),
        "onset_speed": Variable(
            "rad s-1",
            "speed at which separation first is found on the way up, nan if at none or at the lowest",
        ),
        "offset_speed": Variable(
            "rad s-1",
            "lowest speed to which it persists without a gap on the way down, nan if it still does at the lowest",
        ),
    }
    COORDINATES: ClassVar = {
        "direction": DIRECTION,
        "sweep_Omega": Coordinate(
            "rad s-1", "speed of the drive point, in the sweep", lambda o: o.scan.values
        ),
    }

    def go_along(self, parameter: str) -> None:
        """Sweep another number of the case than the speed, whose values `scan` then has."""
        self._parameter = parameter

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        from disc_model.stability.attractors import sweep

        speeds = self.scan.values
        status = "ok"
        message = ""
        values: dict[str, Any] = {}
        for name, column in self.COLUMNS.items():
            if column.dims:
                values[name] = column.empty((2, len(speeds)))
        steps = sweep(
            point.parameters,
            self._parameter,
            speeds,
            self.dwell,
            self.max_dwell,
            self.evaluation_time,
            self.tol,
        )
        for index, result, late, reached in steps:
            if late is None:
                status = result.status.value
                message = f"{value_with_unit(self._parameter, speeds[index[1]])}: {result.message}"
            values["sweep_status"][index] = STATUSES.index(status)
            values["sweep_settled"][index] = ANSWER.flags.index(reached.settling.answer)
            values["stay"][index] = reached.stay
            stretch = {**asdict(late), "range": late.range} if late else {}
            for name in values.keys() & stretch.keys():
                values[name][index] = stretch[name]
        values.update(self._edges(values))
        return {**values, "status": status}, message

    def _edges(self, values: dict[str, Any]) -> dict[str, float]:
        """Speeds at which separation sets in on the way up, and to which it persists on the way
        down, as far as they are known: each lies beside a speed at which contact is kept."""
        speeds = self.scan.values
        edges = {}
        done = values["sweep_status"] == STATUSES.index("ok")
        rising, falling = values["separation_rate"] > 0
        if rising.any() and not rising[0]:
            edges["onset_speed"] = speeds[rising.argmax()]
        if falling[-1]:
            quiet = np.flatnonzero(~falling)
            if quiet.size and done[1, quiet[-1]]:
                edges["offset_speed"] = speeds[quiet[-1] + 1]
        return edges
