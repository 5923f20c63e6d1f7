"""Outcome of the static start over two parameters, and the cycle at every point, with what joins cycles of
neighbouring points.

Multipliers give the outcome where the start stays on its cycle, or grows too slowly for anything else.
Elsewhere the start is followed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from disc_model.arrays import Array
from disc_model.data.variables import OF_QUANTITIES, STABLE_CYCLES, Outcome
from disc_model.parameters import Parameters
from disc_model.studies.compute import failure, stack
from disc_model.studies.quantity import COME_TO, COME_TO_BY, NUMERICAL, Motion, found, quantity
from disc_model.units import Finite, Seconds, Tolerance

if TYPE_CHECKING:
    from disc_model.simulation.states import State
    from disc_model.stability.cycle import FloquetResult
    from disc_model.stability.follower import NearCycle, OutcomeResult

# distances of cycles at neighbouring points, relative to the deflection
SMOOTHLY = 0.002  # within which they are one
APART = 0.02  # beyond which one carried over from a neighbour may be another
MOST_CYCLES = 4  # known at a point; further ones cost too much


def _come_to(case: Parameters, *, horizon: float, tol: float, **_: Any) -> State:
    """The state that the motion has come to."""
    from disc_model.simulation.api import simulate
    from disc_model.stability.follower import find_outcome

    result = find_outcome(case, horizon, tol=tol)
    near = result.near
    if near is not None and near.cycle.stable and near.cycle.state is not None:
        return near.cycle.state
    # to the horizon, or to what the separation leads to
    end = horizon if result.state is None else result.state.time + 5.0
    run = simulate(case, end, tol=tol, initial_state=result.state)
    return run.raise_for_status().final_state


@quantity(plane=True, motion=Motion(4, COME_TO, COME_TO_BY, _come_to))
def regions(
    case: Parameters,
    *,
    axes: Mapping[str, Sequence[float]],
    horizon: Seconds,
    extrapolate: bool = True,
    timed: tuple[dict[str, Finite], ...] = (),
    tol: Tolerance = 1e-10,
) -> xr.Dataset:
    """Outcomes of the static start over a plane of two parameters, and its cycles.

    Parameters
    ----------
    axes : values of two numbers of the case; in a study they are its two axes of numbers
    horizon : longest simulated time
    extrapolate : whether slow departures from cycles are extrapolated, which halves the time; separations after them
        are not timed
    timed : places, such as {N: 200, Omega: 20}, at which nothing is extrapolated
    tol : tolerance of simulations: error of event times after a second of motion

    Examples
    --------
    >>> import disc_model as dm
    >>> axes = {"Omega": [14, 15.1], "N": [385]}
    >>> dm.regions(dm.Parameters(N=385, Omega=15), axes=axes, horizon=60)["outcome"].values.tolist()
    [['stick_slip'], ['separation']]
    """
    first, second = axes
    shape = (len(axes[first]), len(axes[second]))
    places = [*np.ndindex(*shape)]
    points: dict[tuple[int, ...], _Point] = {}
    results: dict[tuple[int, ...], xr.Dataset] = {}
    for i, j in places:
        try:
            at = {first: axes[first][i], second: axes[second][j]}
            is_timed = any(place.items() <= at.items() for place in timed)
            compared_with = (horizon,) if extrapolate and not is_timed else ()
            points[i, j] = _point(case.replace(**at), horizon, compared_with, tol)
        except NUMERICAL as error:
            results[i, j] = failure(error)
    others = _others(points, shape)
    for (i, j), point in points.items():
        row = {
            "status": "ok",
            "other_cycles": others[i, j],
            "branch_continues_first": _joined(point, points.get((i + 1, j))),
            "branch_continues_second": _joined(point, points.get((i, j + 1))),
            **_outcome_columns(point),
            **_cycle_columns(point),
        }
        results[i, j] = found("regions", row, point.result.message if point.result else "")
    sizes = dict(zip(axes, shape, strict=True))
    columns = OF_QUANTITIES["regions"]["columns"]
    plane = stack([results[place] for place in places], np.array(places), sizes, columns)
    return plane.assign_coords({name: [*values] for name, values in axes.items()})


@dataclass(frozen=True)
class _Point:
    """What is known of a point of a plane.

    Attributes
    ----------
    start : the cycle near the static start, or what `floquet` says if there is none
    trend : the outcome by the multipliers, "" if they leave it open
    result : the outcome that was computed, if they do
    """

    start: NearCycle | FloquetResult
    trend: str
    result: OutcomeResult | None

    @property
    def near(self) -> NearCycle | None:
        """The cycle near the static start."""
        from disc_model.stability.follower import NearCycle

        return self.start if isinstance(self.start, NearCycle) else None

    @property
    def followed(self) -> NearCycle | None:
        """The cycle that the static start follows, before any later one."""
        own = self.near if self.near and self.near.follows_cycle else None
        if self.result is None or (own and self.result.outcome is not Outcome.STICK_SLIP):
            return own
        return self.result.near


def _point(
    case: Parameters, horizon: float, compared_with: tuple[float, ...], tol: float
) -> _Point:
    """The cycle at a point, and the outcome."""
    from disc_model.stability.follower import NearCycle, cycle_of_static_start, find_outcome

    start = cycle_of_static_start(case)
    if isinstance(start, NearCycle) and start.follows_cycle:
        if start.cycle.stable:
            return _Point(start, Outcome.STICK_SLIP, None)
        if start.stays_linear_until(horizon):
            return _Point(start, Outcome.GROWING, None)
    return _Point(
        start, "", find_outcome(case, horizon, tol=tol, near=start, compared_with=compared_with)
    )


def _outcome_columns(point: _Point) -> dict[str, Any]:
    """The columns of a point's outcome, and how it is known."""
    result = point.result
    if result is None:
        return {"outcome": point.trend, "method": "multipliers"}
    method = "simulation" if result.simulated else "multipliers"
    return {
        "method": "extrapolation" if result.extrapolated else method,
        "status": result.status,
        "outcome": result.word,
        "simulated_time": result.simulated,
        "first_separation": result.timed_separation,
    }


def _cycle_columns(point: _Point) -> dict[str, Any]:
    """The columns of the cycle that a point's static start follows."""
    from disc_model.analysis.spectra import modes_at_rest

    followed = point.followed
    if followed is None:
        return {"cycle": _word_without_cycle(point)}
    cycle = followed.cycle
    bound = [frequency for frequency, _, moves in modes_at_rest(cycle.parameters) if moves]
    return {
        "cycle": "followed",
        "growth_rate": cycle.growth_rate,
        "period": cycle.period,
        "releases": cycle.releases,
        "period_ratio": cycle.period * min(bound),
    }


def _word_without_cycle(point: _Point) -> str:
    """What a static start does that follows no cycle."""
    from disc_model.stability.follower import NearCycle

    if point.result is not None and point.result.outcome is Outcome.STEADY_SLIDING:
        return "steady_sliding"
    if isinstance(point.start, NearCycle):
        return "nearby_only"
    of_search = (*STABLE_CYCLES, "unstable_sliding")
    return point.start.motion if point.start.motion in of_search else "no_cycle"


# ---- Neighbours


def _joined(point: _Point, ahead: _Point | None) -> str:
    """ "yes" if a point's cycle continues into the cycle of the next point, else "no"."""
    from disc_model.stability.follower import SAME_POINT
    from disc_model.stability.return_map import newton

    here = point.followed
    further = ahead.followed if ahead else None
    if here is None or further is None or here.x.shape != further.x.shape:
        return "no"
    if here.cycle.releases != further.cycle.releases:
        return "no"
    size = further.map.deflection  # the unit of points, which varies with the parameters
    x = here.x * size / here.map.deflection
    if np.linalg.norm(x - further.x) <= SMOOTHLY * size:
        return "yes"
    orbit = newton(further.map, x, releases=further.cycle.releases)
    if orbit is not None and np.linalg.norm(orbit.start - further.x) <= SAME_POINT * size:
        return "yes"
    return "no"


def _others(
    points: Mapping[tuple[int, ...], _Point], shape: tuple[int, int]
) -> dict[tuple[int, ...], int]:
    """The number of known cycles at each point besides the one nearest to the start, carried along
    rows both ways."""
    known = {place: [point.near.x] if point.near else [] for place, point in points.items()}
    for i in range(shape[0]):
        row = [(i, j) for j in range(shape[1]) if (i, j) in points]
        for before, place in (*pairwise(row), *pairwise(row[::-1])):
            start, last = points[place].near, points[before].near
            if start and last and start.x.shape == last.x.shape:
                _carry(known[before], last, known[place], start)
    return {place: max(0, len(cycles) - 1) for place, cycles in known.items()}


def _carry(
    carried: Sequence[Array], last: NearCycle, cycles: list[Array], start: NearCycle
) -> None:
    """Add, to the known cycles of a point, those of the point before that continue to it and
    are others."""
    from disc_model.stability.follower import SAME_POINT
    from disc_model.stability.return_map import newton

    size = start.map.deflection  # the unit of points, which varies with the parameters
    for cycle in carried:
        if len(cycles) >= MOST_CYCLES:
            return
        guess = size / last.map.deflection * cycle
        if _distance(guess, cycles) <= APART * size:  # not another one
            continue
        orbit = newton(start.map, guess, releases=last.cycle.releases)
        if orbit is not None and _distance(orbit.start, cycles) > SAME_POINT * size:
            cycles.append(orbit.start)


def _distance(x: Array, cycles: Sequence[Array]) -> float:
    """The distance of a point on the section from the nearest of some others."""
    return float(min(np.linalg.norm(cycle - x) for cycle in cycles))
