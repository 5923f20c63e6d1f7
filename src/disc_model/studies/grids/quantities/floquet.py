"""The stick-slip cycle near the published start and its stability, by multipliers instead of simulation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from disc_model.data.variables import Variable
from disc_model.parameters import Parameters
from disc_model.stability.cycle import CycleStatus
from disc_model.stability.floquet_batch import STATUS_NAMES, solve
from disc_model.studies.grids.quantities.floquet_options import FloquetOptions
from disc_model.studies.grids.quantities.table import Column, Table, tabulate

STATUSES = (*STATUS_NAMES, "failed")
TABLE = {
    "status": Column(Variable("1", "what was found near the published start", STATUSES)),
    "growth_rate": Column(Variable("s-1", "growth rate of disturbances of the stick-slip cycle")),
    "period": Column(Variable("s", "period of the stick-slip cycle")),
    "stick_fraction": Column(Variable("1", "share of the period spent sticking")),
    "multiplier_re": Column(Variable("1", "real part of the leading multiplier")),
    "multiplier_im": Column(Variable("1", "imaginary part of the leading multiplier")),
    "sliding_growth_rate": Column(Variable("s-1", "growth rate of disturbances of steady sliding")),
}

OPTIONS = FloquetOptions


def coordinates(options: FloquetOptions) -> dict[str, Any]:
    """No dimensions beyond the grid's."""
    return {}


def compute(points: Sequence[Parameters], options: FloquetOptions) -> Table:
    """The cycle of each point, each for itself: no point is started from its neighbour."""
    return tabulate(lambda p: _one(p, options), points, TABLE, {})


def _one(p: Parameters, options: FloquetOptions) -> tuple[dict[str, Any], str]:
    values: dict[str, Any] = {name: array[0] for name, array in solve([p], options.tol).items()}
    found = STATUS_NAMES[int(values["status"])]
    message = "" if found == CycleStatus.OK.value else CycleStatus(found).advice
    return values | {"status": found}, message
