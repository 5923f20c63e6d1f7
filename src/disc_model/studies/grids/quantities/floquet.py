"""The stick-slip cycle near the static start and its stability, from Floquet multipliers instead of simulation."""

import math
from typing import Any

from disc_model.data.variables import Variable
from disc_model.simulation.states import State
from disc_model.stability.cycle import CycleStatus, floquet
from disc_model.studies.document import FloquetOptions
from disc_model.studies.grids.points import Point

STATUSES = (*(status.value for status in CycleStatus), "failed")
COLUMNS = {
    "status": Variable("1", "what was found near the static start", STATUSES),
    "growth_rate": Variable("s-1", "growth rate of disturbances of the stick-slip cycle"),
    "period": Variable("s", "period of the stick-slip cycle"),
    "stick_fraction": Variable("1", "share of the period spent sticking"),
    "multiplier_re": Variable("1", "real part of the leading multiplier"),
    "multiplier_im": Variable("1", "imaginary part of the leading multiplier"),
    "sliding_growth_rate": Variable("s-1", "growth rate of disturbances of steady sliding"),
}


def compute_point(point: Point, options: FloquetOptions) -> tuple[dict[str, Any], str]:
    """Compute the cycle of this point, without a neighbour's cycle as initial guess."""
    cycle = floquet(point.parameters, tol=options.tol)
    leading = complex(cycle.multipliers[0]) if cycle.status is CycleStatus.OK else complex(math.nan, math.nan)
    values = {
        "status": cycle.status.value,
        "growth_rate": cycle.growth_rate,
        "period": cycle.period,
        "stick_fraction": cycle.stick_fraction,
        "multiplier_re": leading.real,
        "multiplier_im": leading.imag,
        "sliding_growth_rate": cycle.sliding.growth_rate,
    }
    return values, "" if cycle.status is CycleStatus.OK else cycle.status.advice


def state_at(point: Point, options: FloquetOptions) -> State:
    """A state on the cycle, stable or not; raises `CycleError` if there is none."""
    state = floquet(point.parameters, tol=options.tol).raise_for_status().state
    assert state is not None
    return state
