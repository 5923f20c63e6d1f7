"""Critical speeds: all speeds at which separation within a horizon begins or ends, since there may
be several.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import xarray as xr
from pydantic import AfterValidator, BeforeValidator, Field

from disc_model.data.variables import value_with_unit
from disc_model.parameters import Parameters
from disc_model.studies.quantity import BETWEEN, Range, found, listed, quantity, values_between
from disc_model.units import Finite, Seconds, Speed, Tolerance, Unit

if TYPE_CHECKING:
    from disc_model.stability.follower import OutcomeResult

MOST_CROSSINGS = 12
Horizons = Annotated[
    tuple[Seconds, ...],
    BeforeValidator(
        lambda given: given if isinstance(given, Sequence) else np.atleast_1d(given).tolist(),
        json_schema_input_type=list[Seconds] | Seconds,
    ),
    AfterValidator(lambda horizons: tuple(sorted(set(horizons)))),
    Field(min_length=1, validate_default=True),
]
"""A horizon, or several."""


def _is_multiple(options: Any) -> bool:
    """Whether the step of the scan is a multiple of the precision."""
    ratio = options.step / options.precision
    return round(ratio) > 0 and math.isclose(ratio, round(ratio), rel_tol=1e-6)


@quantity(
    points_per_job=5,
    own=("Omega",),
    rules=(
        *BETWEEN,
        (
            _is_multiple,
            "step={0.step:.6g} rad/s must be a multiple of precision={0.precision:.6g} rad/s",
        ),
    ),
)
def critical_speed(
    case: Parameters,
    bounds: Annotated[tuple[Finite, Finite], Unit("rad/s")] = (5.0, 30.0),
    horizon: Horizons = 1000.0,  # type: ignore[assignment]
    *,
    step: Speed = 1.0,
    precision: Speed = 0.1,
    tol: Tolerance = 1e-10,
) -> xr.Dataset:
    """The lowest speed of a scan with separation within a horizon, and all speeds where separation begins or
    ends, by bisection.

    Separation in a range of speeds narrower than `step` can be overlooked. Slow departures from cycles are
    extrapolated, which halves the time; separations after them are not timed.

    Parameters
    ----------
    bounds : lowest and highest speed of the scan
    horizon : time within which separation must occur, or several, each with a critical speed of its own
    step : of the scan
    precision : width to which crossings are bisected, of which `step` must be a multiple
    tol : tolerance of simulations: error of event times after a second of motion

    Returns
    -------
    xarray.Dataset
        `critical_speed` (rad/s, nan if none was found in steps of the scan) and crossings, by horizon where a list is
        given; outcomes and first separations along the scan. Contact was lost at the critical speed, and kept at the
        next lower one computed, which is lower by `precision`; where it was lost at the lowest speed already,
        `at_lower_bound` is true. `message` states which horizons have no critical speed, or one at the lower bound.

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> speeds = dm.critical_speed(dm.Parameters(N=385, Omega=15), (15, 16), 100, step=0.5)
    >>> float(speeds["critical_speed"])
    15.1
    """
    from disc_model.stability.follower import find_outcome

    ratio = round(step / precision)
    count = len(values_between(bounds, step))
    # all speeds that may be computed, a precision apart
    lattice = Range(start=bounds[0], stop=bounds[1], count=1 + (count - 1) * ratio).values
    motions: dict[int, OutcomeResult] = {}

    def look(places: Iterable[int]) -> dict[int, float]:
        """Follow motions from the static start up to the longest horizon; returns all first separations."""
        for i in places:
            there = case.replace(Omega=lattice[i])
            result = find_outcome(there, horizon[-1], tol=tol, compared_with=horizon)
            # return maps would take megabytes each for a disc of many modes
            motions[i] = replace(result, near=None)
        return {i: _first_separation(motions[i]) for i in sorted(motions)}

    scanned = range(0, len(lattice), ratio)
    lost = look(scanned)
    for time in horizon:
        # every interval over which separation within the horizon begins or ends is halved, down to the lattice
        while middles := [(a + b) // 2 for a, b, _ in _changes(lost, time) if b - a > 1]:
            lost = look(middles)
    remarks = []
    for i, result in motions.items():
        if result.status != "ok":
            remarks.append(f"{value_with_unit('Omega', lattice[i])}: {result.message}")
    rows = []
    without: list[str] = []
    at_bound: list[str] = []
    for time in horizon:
        # the lowest speed that separates; an unknown speed hides those above it
        first = next((i for i in lost if not lost[i] > time), None)
        lowest = math.nan if first is None or math.isnan(lost[first]) else lattice[first]
        if math.isnan(lowest):
            without.append(f"{time:g}")
        elif first == 0:
            at_bound.append(f"{time:g}")
        changes = _changes(lost, time)
        row = {
            "critical_speed": lowest,
            "n_crossings": len(changes),
            "crossing": [lattice[b] for _, b, _ in changes],
            "crossing_kind": [kind for _, _, kind in changes],
        }
        rows.append(row)
    if without:
        scan = f"at {count} speeds from {bounds[0]:g} to {bounds[1]:g} rad/s"
        remarks.append(f"no separation within {', '.join(without)} s {scan}")
    if at_bound:
        bound = f"at the lower bound, {bounds[0]:g} rad/s"
        remarks.append(f"contact is already lost within {', '.join(at_bound)} s {bound}")
    values: dict[str, Any] = {
        "status": next((x.status for x in motions.values() if x.status != "ok"), "ok"),
        "scan_outcome": [motions[i].word for i in scanned],
        "scan_first_separation": [motions[i].timed_separation for i in scanned],
        "scan_status": [motions[i].status for i in scanned],
        "simulations": len(motions),
        "simulated_time": sum(result.simulated for result in motions.values()),
        **listed(rows),
    }
    own = {"horizon": horizon, "crossing_number": range(MOST_CROSSINGS)}
    message = "; ".join(remarks)
    answer = found("critical_speed", values, message, **own, scan_Omega=lattice[::ratio])
    return answer.assign(at_lower_bound=answer["critical_speed"] <= bounds[0])


def _first_separation(result: OutcomeResult) -> float:
    """Time of the first separation, s: infinite if there is none, nan if that is not known."""
    if math.isnan(result.first_separation) and result.status == "ok":
        return math.inf
    return result.first_separation


def _changes(lost: Mapping[int, float], horizon: float) -> list[tuple[int, int, str]]:
    """Pairs of neighbours on the lattice of which only one separates within the horizon, and whether it begins
    or ends there, from first separations (s); one that is unknown is in none."""
    changes = []
    for a, b in pairwise(lost):
        decided = not math.isnan(lost[a] + lost[b])
        if decided and (lost[a] <= horizon) != (lost[b] <= horizon):
            changes.append((a, b, "begins" if lost[b] <= horizon else "ends"))
    return changes
