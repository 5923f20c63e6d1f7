"""Hysteresis: a slow sweep of the speed up and down, which continues the motion from speed to
speed."""

from dataclasses import asdict
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import PrivateAttr

from disc_model.data.variables import OF_QUANTITIES, WORDS, value_with_unit
from disc_model.studies.quantity import DIRECTION, Coordinate, Point, Quantity, Range
from disc_model.units import Seconds, Tolerance, Unit


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
    COLUMNS: ClassVar = OF_QUANTITIES["hysteresis"]["columns"]
    COORDINATES: ClassVar = {
        "direction": DIRECTION,
        "sweep_Omega": Coordinate(lambda o: o.scan.values),
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
        answers = self.COLUMNS["sweep_settled"].flags
        for index, result, late, reached in steps:
            if late is None:
                status = result.status.value
                message = f"{value_with_unit(self._parameter, speeds[index[1]])}: {result.message}"
            values["sweep_status"][index] = WORDS["point_statuses"].index(status)
            values["sweep_settled"][index] = answers.index(reached.settling.answer)
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
        done = values["sweep_status"] == WORDS["point_statuses"].index("ok")
        rising, falling = values["separation_rate"] > 0
        if rising.any() and not rising[0]:
            edges["onset_speed"] = speeds[rising.argmax()]
        if falling[-1]:
            quiet = np.flatnonzero(~falling)
            if quiet.size and done[1, quiet[-1]]:
                edges["offset_speed"] = speeds[quiet[-1] + 1]
        return edges
