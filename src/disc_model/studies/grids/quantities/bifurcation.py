"""What the motion settles to, sampled once a turn of the drive."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from disc_model.data.variables import SCALARS, SERIES, Variable
from disc_model.parameters import Parameters
from disc_model.simulation.result import PHASES
from disc_model.stability.bifurcation import STATUS_NAMES, bifurcation_samples
from disc_model.studies.grids.quantities.bifurcation_options import BifurcationOptions
from disc_model.studies.grids.quantities.preparation import prepared
from disc_model.studies.grids.quantities.table import STATUS, STATUSES, Column, Table, tabulate

_SAMPLED = ("psi", "psi_velocity", "P", "u", "w_point")
TABLE = {
    "status": Column(STATUS),
    **{name: Column(SERIES[name], ("sample",)) for name in _SAMPLED},
    "phase": Column(Variable("1", "phase of the motion at the sample", ("none", *PHASES)), ("sample",)),
    "first_separation": Column(SCALARS["first_separation"]),
    "separations": Column(Variable("1", "number of separations, transient included"), whole=True),
    "stick_fraction": Column(Variable("1", "share of the time spent sticking, transient included")),
}

OPTIONS = BifurcationOptions


def coordinates(options: BifurcationOptions) -> dict[str, tuple[Any, Variable]]:
    """Numbers of the samples."""
    return {"sample": (np.arange(options.samples), Variable("1", "number of the turn after the transient"))}


def compute(points: Sequence[Parameters], options: BifurcationOptions) -> Table:
    """Each point for itself, from the published start or the prepared one."""
    return tabulate(lambda p: _one(p, options), points, TABLE, {"sample": options.samples})


def _one(p: Parameters, options: BifurcationOptions) -> tuple[dict[str, Any], str]:
    data = bifurcation_samples(
        p,
        "Omega",
        [p.Omega],
        transient=options.transient,
        samples=options.samples,
        initial_state=prepared(p, options),
        theta=options.theta,
        tol=options.tol,
    ).isel(Omega=0)
    found = STATUS_NAMES[int(data["status"])]
    status = found if found in STATUSES else "ok"
    values: dict[str, Any] = {name: data[name].values for name in TABLE if name not in ("status", "phase")}
    values |= {"status": status, "phase": data["phase"].values + 1}
    return values, "" if status == "ok" else f"the simulation ended early: {status}"
