"""What the motion settles to, sampled once a turn of the drive."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from disc_model.data.variables import PHASES, SCALARS, SERIES, Variable
from disc_model.parameters import Parameters
from disc_model.simulation.api import after, prepared
from disc_model.simulation.result import State
from disc_model.stability.bifurcation import STATUS_NAMES, bifurcation_samples
from disc_model.studies.grids.run import STATUS, STATUSES, Column

if TYPE_CHECKING:
    from disc_model.studies.grids.quantities.schema import BifurcationOptions

_SAMPLED = ("psi", "psi_velocity", "P", "u", "w_point")
COLUMNS = {
    "status": Column(STATUS),
    **{name: Column(SERIES[name], ("sample",)) for name in _SAMPLED},
    "phase": Column(Variable("1", "phase of the motion at the sample", ("none", *PHASES)), ("sample",)),
    "first_separation": Column(SCALARS["first_separation"]),
    "separations": Column(Variable("1", "number of separations, transient included"), whole=True),
    "stick_fraction": Column(Variable("1", "share of the time spent sticking, transient included")),
}


def coordinates(options: BifurcationOptions) -> dict[str, tuple[Any, Variable]]:
    """Numbers of the samples."""
    return {"sample": (np.arange(options.samples), Variable("1", "number of the turn after the transient"))}


def at(p: Parameters, options: BifurcationOptions) -> tuple[dict[str, Any], str]:
    """From the published start or the prepared one."""
    data = bifurcation_samples(
        p,
        "Omega",
        [p.Omega],
        transient=options.transient,
        samples=options.samples,
        initial_state=prepared(p, options, options.tol),
        theta=options.theta,
        tol=options.tol,
    ).isel(Omega=0)
    found = STATUS_NAMES[int(data["status"])]
    status = found if found in STATUSES else "ok"
    values: dict[str, Any] = {name: data[name].values for name in COLUMNS if name not in ("status", "phase")}
    values |= {"status": status, "phase": data["phase"].values + 1}
    return values, "" if status == "ok" else f"the simulation ended early: {status}"


def state_at(p: Parameters, options: BifurcationOptions) -> State:
    """Where the transient ends; raises `SimulationError` if the motion did not get there."""
    return after(p, options, options.transient, options.tol)
