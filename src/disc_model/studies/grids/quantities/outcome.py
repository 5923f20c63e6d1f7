"""What becomes of the published start within a horizon: it stays quiet, it grows, or contact is lost."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from disc_model.data.variables import SCALARS, Column
from disc_model.parameters import Parameters
from disc_model.simulation.api import prepared
from disc_model.simulation.result import Result, State
from disc_model.stability.settling import Followed, Late, follow, late_stretch
from disc_model.studies.grids.points import STATUS

if TYPE_CHECKING:
    from disc_model.studies.grids.quantities.schema import OutcomeOptions

OUTCOMES = ("unknown", "stable", "unstable", "separation")
COLUMNS = {
    "status": Column(*STATUS),
    "outcome": Column("1", "what becomes of the published start; unstable: growth without separation", OUTCOMES),
    "first_separation": Column(*SCALARS["first_separation"]),
    "settled": Column("s", "time at which the motion was left because it had settled, nan if it was not"),
    "time_reached": Column(*SCALARS["time_reached"]),
    "distance": Column("1", "relative distance from the stick-slip cycle where the motion was left for it"),
    "difference": Column("1", "relative difference of successive cycles at the last probe"),
    "difference_rate": Column("s-1", "growth rate of that difference over the last probes"),
    "P_min": Column("N", "least contact force over the late stretch"),
    "P_max": Column("N", "greatest contact force over the late stretch"),
    "u_min": Column("m", "lowest position of the slider over the late stretch, from static equilibrium"),
    "u_max": Column("m", "highest position of the slider over the late stretch, from static equilibrium"),
    "share_stick": Column("1", "share of the late stretch spent sticking"),
    "share_slip": Column("1", "share of the late stretch spent slipping"),
    "share_separation": Column("1", "share of the late stretch spent separated"),
    "separation_rate": Column("s-1", "separations per second over the late stretch"),
}


def at(p: Parameters, options: OutcomeOptions) -> tuple[dict[str, Any], str]:
    """The late stretch of a point that separates lies ``after_separation`` later."""
    followed, result, late = _late(p, options)
    separated = followed.result.status.value == "stopped"
    values = {
        "status": "ok" if result.status.complete else result.status.value,
        "outcome": _outcome(followed),
        "first_separation": followed.first_separation,
        "time_reached": result.final_state.time if separated else followed.simulated,
        "difference_rate": followed.settling.rate,
    }
    if followed.settling.differences:
        values["difference"] = followed.settling.differences[-1]
    if followed.orbit is not None:
        values["distance"] = followed.settling.distance
    if followed.settled:
        values["settled"] = followed.simulated
    if late is not None:
        values |= asdict(late)
    return values, "" if result.status.complete else result.message


def state_at(p: Parameters, options: OutcomeOptions) -> State:
    """Where the late stretch ends; raises `SimulationError` if the motion did not get there."""
    _, result, _ = _late(p, options)
    return result.raise_for_status().final_state


def _late(p: Parameters, options: OutcomeOptions) -> tuple[Followed, Result, Late | None]:
    """The motion as it was followed, the last run of it, and its late stretch, None if it did not get there."""
    followed = follow(
        p,
        options.horizon,
        tol=options.tol,
        settled=options.settled,
        near=options.near,
        late=options.late,
        initial_state=prepared(p, options, options.tol),
    )
    result, late = followed.result, followed.late
    if result.status.value == "stopped":
        result, late = late_stretch(p, result.final_state, options.after_separation, options.late, options.tol)
    elif followed.settled and followed.orbit is not None:
        # what the motion tends to is known exactly
        result, late = late_stretch(p, followed.orbit, options.late, options.late, options.tol)
    return followed, result, late


def _outcome(followed: Followed) -> str:
    if followed.result.status.value == "stopped":
        return "separation"
    if not followed.result.status.complete:
        return "unknown"
    return "stable" if followed.orbit is not None or not followed.settling.growing else "unstable"
