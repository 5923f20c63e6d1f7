"""The largest Lyapunov exponents of the motion, across all its events."""

from typing import Any

import numpy as np

from disc_model.data.variables import Variable
from disc_model.errors import SimulationError
from disc_model.simulation.api import state_after
from disc_model.simulation.result import STATUS_OF
from disc_model.simulation.states import State
from disc_model.stability.lyapunov import lyapunov_exponents
from disc_model.studies.document import LyapunovOptions
from disc_model.studies.grids.points import STATUS, Coordinate, Point

CONVERGED = ("unknown", "no", "yes")
_EACH = ("exponent_number",)
COLUMNS = {
    "status": STATUS,
    "exponent": Variable(
        "s-1", "Lyapunov exponent, the one along the motion left out; -inf where changes vanish", dims=_EACH
    ),
    "exponent_error": Variable(
        "s-1", "the larger of its standard error and the difference between both halves", dims=_EACH
    ),
    "converged": Variable("1", "whether both halves give it, to a twentieth or 0.002 /s", CONVERGED, dims=_EACH),
    "trivial_exponent": Variable("s-1", "exponent along the motion: 0 but for what the time is too short for"),
    "averaging_time": Variable("s", "time over which the rates are averaged"),
    "separations": Variable("1", "number of separations in that time", whole=True),
}
COORDINATES = {
    "exponent_number": Coordinate("1", "number of the exponent, largest first", lambda o: range(o.exponents))
}


def compute_point(point: Point, options: LyapunovOptions) -> tuple[dict[str, Any], str]:
    """Compute the exponents after the transient."""
    try:
        start = state_at(point, options)
    except SimulationError as error:
        return {"status": STATUS_OF[type(error)].value}, str(error)
    found = lyapunov_exponents(
        point.parameters,
        options.duration,
        count=options.exponents,
        interval=options.interval,
        initial_state=start,
        tol=options.tol,
        leave_out_trivial=True,
    )
    known = np.isfinite(found.exponents)
    values = {
        "status": found.status.value,
        "exponent": found.exponents,
        "exponent_error": found.errors,
        "converged": np.where(known, 1 + found.converged, 0),
        "trivial_exponent": found.trivial_exponent,
        "averaging_time": found.duration,
        "separations": found.separations,
    }
    return values, "" if found.status.complete else found.status.advice


def state_at(point: Point, options: LyapunovOptions) -> State:
    """State at the end of the transient; raises `SimulationError` if the motion does not reach it."""
    return state_after(point.parameters, point.start, options.transient, options.tol)
