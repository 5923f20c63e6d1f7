"""The largest Lyapunov exponents of the motion, across all its events."""

from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from disc_model.data.variables import OF_QUANTITIES
from disc_model.errors import SimulationError
from disc_model.simulation.case import Start
from disc_model.studies.quantity import Coordinate, Point, Quantity, State
from disc_model.units import Count, Seconds, Tolerance


class Lyapunov(Start, Quantity):
    """The largest Lyapunov exponents of the motion, without the one along it, which is zero."""

    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""
    transient: Seconds
    """time left out at the beginning"""
    duration: Seconds
    """time over which rates are averaged"""
    exponents: Annotated[Count, Field(ge=1, le=7)] = 2
    """number of exponents, the largest ones"""
    interval: Seconds = 0.05
    """time between orthonormalisations; exponents below -400/s need a shorter one"""
    points_per_job: ClassVar = 60
    motions: ClassVar = 8
    motion: ClassVar = "After the transient."
    COLUMNS: ClassVar = OF_QUANTITIES["lyapunov"]["columns"]
    COORDINATES: ClassVar = {"exponent_number": Coordinate(lambda o: range(o.exponents))}

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        from disc_model.simulation.result import STATUS_OF
        from disc_model.stability.lyapunov import lyapunov_exponents

        try:
            start = self.state_at(point)
        except SimulationError as error:
            return {"status": STATUS_OF[type(error)].value}, str(error)
        how: dict[str, Any] = {
            "count": self.exponents,
            "interval": self.interval,
            "leave_out_trivial": True,
        }
        result = lyapunov_exponents(
            point.parameters, self.duration, initial_state=start, tol=self.tol, **how
        )
        known = np.isfinite(result.exponents)
        values = {
            "status": result.status.value, "exponent": result.exponents, "exponent_error": result.errors,
            "converged": np.where(known, 1 + result.converged, 0), "trivial_exponent": result.trivial_exponent,
            "averaging_time": result.duration, "separations": result.separations,
        }  # fmt: skip
        message = "" if result.status.complete else result.status.advice
        return values, message

    def state_at(self, point: Point) -> State:
        from disc_model.simulation.starts import state_after

        return state_after(point.parameters, point.start, self.transient, self.tol)
