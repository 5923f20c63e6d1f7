"""Frequencies and growth rates of steady sliding and of the stick-slip cycle, for Campbell diagrams."""

import math
from typing import Any

import numpy as np

from disc_model.data.variables import Variable
from disc_model.stability.campbell import frequencies
from disc_model.stability.cycle import CycleStatus
from disc_model.studies.document import CampbellOptions
from disc_model.studies.grids.points import Coordinate, Point
from disc_model.studies.grids.quantities.floquet import STATUSES

KINDS = ("none", "disc", "slider")
_EACH = ("mode",)
COLUMNS = {
    "status": Variable("1", "what was found near the static start", STATUSES),
    "growth_rate": Variable("s-1", "growth rate of disturbances of the stick-slip cycle"),
    "stick_slip_frequency": Variable("Hz", "releases of stick per second on the stick-slip cycle, f_s"),
    "rotation_frequency": Variable("Hz", "turns of the drive per second, f_Omega"),
    "mode_kind": Variable("1", "what moves most: the disc, or the slider in the disc's plane", KINDS, dims=_EACH),
    "diameters": Variable("1", "nodal diameters of the modes with most of the energy", dims=_EACH, whole=True),
    "forward_wave_fraction": Variable("1", "share of their energy in waves that travel with the slider", dims=_EACH),
    "sliding_frequency": Variable("Hz", "frequency of steady sliding, in the slider's frame", dims=_EACH),
    "sliding_growth_rate": Variable("s-1", "growth rate of that mode of steady sliding", dims=_EACH),
    "cycle_frequency": Variable("Hz", "frequency of the cycle's multiplier that goes to the mode", dims=_EACH),
    "cycle_growth_rate": Variable("s-1", "growth rate of the cycle's multipliers that go to the mode", dims=_EACH),
    "mac": Variable("1", "how like the shapes of mode and multiplier are: squared cosine", dims=_EACH),
}
COORDINATES = {"mode": Coordinate("1", "number of the mode, lowest frequency first", lambda o: range(1, o.modes + 1))}


def compute_point(point: Point, options: CampbellOptions) -> tuple[dict[str, Any], str]:
    """Compute one point; modes are numbered by their frequency at this point, independently of its neighbours."""
    found = frequencies(point.parameters, tol=options.tol)
    cycle = found.cycle
    values: dict[str, Any] = {
        "status": cycle.status.value,
        "growth_rate": cycle.growth_rate,
        "stick_slip_frequency": cycle.releases / cycle.period if cycle.releases else math.nan,
        "rotation_frequency": point.parameters.Omega / (2 * math.pi),
        "mode_kind": np.where(found.diameters < 0, KINDS.index("slider"), KINDS.index("disc")),
        "diameters": np.maximum(found.diameters, 0),
        "forward_wave_fraction": found.forward,
        "sliding_frequency": found.frequency,
        "sliding_growth_rate": found.growth_rate,
        "cycle_frequency": found.cycle_frequency,
        "cycle_growth_rate": found.cycle_growth_rate,
        "mac": found.mac,
    }
    return values, "" if cycle.status is CycleStatus.OK else cycle.status.advice
