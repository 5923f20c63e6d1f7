"""Outcome of the static start, and the cycle that it follows.

Multipliers give the outcome where the start stays on its cycle. Elsewhere the start is followed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from xarray import Dataset

from disc_model.data.variables import STABLE_CYCLES, Outcome
from disc_model.parameters import Parameters
from disc_model.studies.quantities.outcome import come_to
from disc_model.studies.quantity import COME_TO, Motion, Row, found, quantity
from disc_model.units import Finite, Seconds, Tolerance

if TYPE_CHECKING:
    from disc_model.stability.cycle import FloquetResult
    from disc_model.stability.follower import NearCycle, OutcomeResult


@quantity(points_per_job=500, motion=Motion(25, COME_TO, come_to))
def regions(
    case: Parameters,
    horizon: Seconds,
    *,
    timed: tuple[dict[str, Finite], ...] = (),
    tol: Tolerance = 1e-10,
) -> Dataset:
    """Outcome of the static start, as in maps of many points, and the cycle that it follows.

    Slow departures from cycles are extrapolated, which halves the time; separations after them are not timed.

    Parameters
    ----------
    horizon : longest simulated time
    timed : cases, such as {N: 200, Omega: 20}, of which nothing is extrapolated
    tol : tolerance of simulations: error of event times after a second of motion

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15)
    >>> dm.sweep(dm.regions, case, Omega=[14, 15.1], horizon=60)["outcome"].values.tolist()
    ['stick_slip', 'separation']
    """
    from disc_model.stability.follower import NearCycle, cycle_of_static_start, find_outcome

    start = cycle_of_static_start(case)
    followed: NearCycle | None = None
    if isinstance(start, NearCycle) and start.follows_cycle:
        followed = start
    values: Row = {"method": "multipliers"}
    message = ""
    if followed and followed.cycle.stable:
        values["outcome"] = Outcome.STICK_SLIP
    else:
        compared_with: tuple[float, ...] = (horizon,)
        if any(place.items() <= case.numbers.items() for place in timed):
            compared_with = ()
        result = find_outcome(case, horizon, tol=tol, near=start, compared_with=compared_with)
        values |= _followed(result)
        message = result.message
        if followed is None or result.outcome is Outcome.STICK_SLIP:
            followed = result.near
    if followed is not None:
        cycle = followed.cycle
        values |= {"cycle": "followed", "growth_rate": cycle.growth_rate}
        values |= {"period": cycle.period, "releases": cycle.releases}
    else:
        values["cycle"] = _without_cycle(start, values["outcome"])
    return found("regions", values, message)


def _followed(result: OutcomeResult) -> Row:
    """The columns of a motion that was followed."""
    method = "multipliers"
    if result.extrapolated:
        method = "extrapolation"
    elif result.simulated:
        method = "simulation"
    return {
        "method": method,
        "status": result.status,
        "outcome": result.word,
        "simulated_time": result.simulated,
        "first_separation": result.timed_separation,
    }


def _without_cycle(start: FloquetResult | NearCycle, outcome: str) -> str:
    """What there is in place of a cycle that the static start follows, by what was found near it."""
    if outcome == Outcome.STEADY_SLIDING:
        return "steady_sliding"
    motion: str = getattr(start, "motion", "nearby_only")
    if motion in ("nearby_only", *STABLE_CYCLES, "unstable_sliding"):
        return motion
    return "no_cycle"
