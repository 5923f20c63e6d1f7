"""Hysteresis: a slow sweep of the speed up and down, which continues the motion from speed to speed."""

from dataclasses import asdict
from typing import Any

import numpy as np

from disc_model.analysis.settling import ANSWER
from disc_model.data.variables import Variable
from disc_model.stability.attractor.classification import sweep
from disc_model.studies.document import HysteresisOptions
from disc_model.studies.grids.points import DIRECTION, STATUS, STATUSES, Coordinate, Point

_DIMS = ("direction", "sweep_Omega")
COLUMNS = {
    "status": STATUS,
    "sweep_status": STATUS._replace(dims=_DIMS),
    "sweep_settled": ANSWER._replace(dims=_DIMS),
    "separation_rate": Variable("s-1", "separations per second at the end of the stay at a speed", dims=_DIMS),
    "P_min": Variable("N", "least contact force at the end of the stay at a speed", dims=_DIMS),
    "P_max": Variable("N", "greatest contact force at the end of the stay at a speed", dims=_DIMS),
    "stick_fraction": Variable("1", "share of the time spent sticking", dims=_DIMS),
    "slip_fraction": Variable("1", "share of the time spent slipping", dims=_DIMS),
    "separation_fraction": Variable("1", "share of the time spent separated", dims=_DIMS),
    "onset_speed": Variable("rad s-1", "speed at which separation first is found on the way up"),
    "offset_speed": Variable("rad s-1", "lowest speed to which it persists without a gap on the way down"),
}
COORDINATES = {
    "direction": DIRECTION,
    "sweep_Omega": Coordinate("rad s-1", "speed of the drive point, in the sweep", lambda o: o.scan.values),
}


def compute_point(point: Point, options: HysteresisOptions) -> tuple[dict[str, Any], str]:
    """Sweep the speed up and down; the point's own Omega is not used."""
    speeds = options.scan.values
    shape = 2, len(speeds)
    values: dict[str, Any] = {name: column.empty(shape) for name, column in COLUMNS.items() if column.dims}
    status, message = "ok", ""
    dwell, longest, evaluated = options.dwell, options.max_dwell, options.evaluation_time
    for place, result, late, reached in sweep(
        point.parameters, "Omega", speeds, dwell, longest, evaluated, options.tol
    ):
        if late is None:
            status, message = result.status.value, f"Omega={speeds[place[1]]:g}: {result.message}"
        values["sweep_status"][place] = STATUSES.index(status)
        values["sweep_settled"][place] = ANSWER.flags.index(reached.settling.answer)
        for name, number in asdict(late).items() if late else ():
            if name in values:
                values[name][place] = number
    done = values["sweep_status"] == STATUSES.index("ok")
    values |= _ends(np.array(speeds), values["separation_rate"] > 0, done) | {"status": status}
    return values, message


def _ends(speeds: np.ndarray, separates: np.ndarray, done: np.ndarray) -> dict[str, float]:
    """Speeds at which separation begins on the way up and ends on the way down, if the sweep reached them."""
    found: dict[str, float] = {}
    if separates[0].any():
        found["onset_speed"] = float(speeds[separates[0].argmax()])
    if separates[1, -1]:
        quiet = np.flatnonzero(~separates[1])
        if not quiet.size or done[1, quiet[-1]]:
            found["offset_speed"] = float(speeds[quiet[-1] + 1 if quiet.size else 0])
    return found
