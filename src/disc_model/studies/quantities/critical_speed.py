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
from pydantic import AfterValidator, BeforeValidator, Field
from xarray import Dataset

from disc_model.data.variables import value_with_unit
from disc_model.parameters import Parameters
from disc_model.studies.quantity import (
    BETWEEN,
    Range,
    Row,
    Speeds,
    found,
    listed,
    quantity,
    values_between,
)
from disc_model.units import Seconds, Speed, Tolerance, Unit

if TYPE_CHECKING:
    from disc_model.stability.follower import OutcomeResult

MOST_CROSSINGS = 12
Horizons = Annotated[
    tuple[Seconds, ...],
    BeforeValidator(
        lambda given: [given] if np.ndim(given) == 0 else given,
        json_schema_input_type=list[Seconds] | Seconds,
    ),
    AfterValidator(lambda horizons: tuple(sorted(set(horizons)))),
    Field(min_length=1, validate_default=True),
    Unit("s"),
]
"""A horizon, or several."""


def _is_multiple(options: Any) -> bool:
    """Whether the step of the scan is a multiple of the precision."""
    ratio = options.step / options.precision
    return round(ratio) > 0 and math.isclose(ratio, round(ratio), rel_tol=1e-6)


@quantity(
    points_per_job=10,
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
    bounds: Speeds = (5.0, 30.0),
    horizon: Horizons = 1000.0,  # type: ignore[assignment]
    *,
    step: Speed = 1.0,
    precision: Speed = 0.1,
    tol: Tolerance = 1e-10,
) -> Dataset:
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
        `at_lower_bound` is true.

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
    scanned = range(0, len(lattice), ratio)
    motions: dict[int, OutcomeResult] = {}

    def look(places: Iterable[int]) -> None:
        """Follow motions from the static start up to the longest horizon."""
        for i in places:
            there = case.replace(Omega=lattice[i])
            result = find_outcome(there, horizon[-1], tol=tol, compared_with=horizon)
            # return maps would take megabytes each for a disc of many modes
            motions[i] = replace(result, near=None)

    look(scanned)
    for time in horizon:
        # every interval over which separation within the horizon begins or ends is halved, down to the lattice
        while middles := [(a + b) // 2 for a, b in _changes(_lost(motions, time)) if b - a > 1]:
            look(middles)
    wrong = {i: result for i, result in motions.items() if result.status != "ok"}
    remarks = [f"{value_with_unit('Omega', lattice[i])}: {x.message}" for i, x in wrong.items()]
    rows = [_crossings(_lost(motions, time), lattice) for time in horizon]
    values: Row = {
        "status": next((result.status for result in wrong.values()), "ok"),
        "scan_outcome": [motions[i].word for i in scanned],
        "scan_first_separation": [motions[i].timed_separation for i in scanned],
        "scan_status": [motions[i].status for i in scanned],
        "simulations": len(motions),
        "simulated_time": sum(result.simulated for result in motions.values()),
        **listed(rows),
    }
    own = {"horizon": horizon, "crossing_number": range(MOST_CROSSINGS)}
    answer = found("critical_speed", values, *remarks, **own, scan_Omega=lattice[::ratio])
    return answer.assign(at_lower_bound=answer["critical_speed"] <= bounds[0])


def _lost(motions: Mapping[int, OutcomeResult], horizon: float) -> dict[int, bool | None]:
    """Whether motions along the lattice have lost contact within a horizon; None where that is unknown."""
    lost: dict[int, bool | None] = {}
    for i, result in sorted(motions.items()):
        lost[i] = result.first_separation <= horizon
        if math.isnan(result.first_separation) and result.status != "ok":
            lost[i] = None
    return lost


def _changes(lost: Mapping[int, bool | None]) -> list[tuple[int, int]]:
    """Pairs of neighbours on the lattice of which only one has lost contact; one that is unknown is in none."""
    return [(a, b) for a, b in pairwise(lost) if {lost[a], lost[b]} == {False, True}]


def _crossings(lost: Mapping[int, bool | None], lattice: Sequence[float]) -> Row:
    """Columns of a horizon. An unknown speed hides those above it."""
    changes = _changes(lost)
    first = next((i for i in lost if lost[i] is not False), -1)
    row: Row = {
        "n_crossings": len(changes),
        "crossing": [lattice[b] for _, b in changes],
        "crossing_kind": ["begins" if lost[b] else "ends" for _, b in changes],
        "critical_speed": math.nan,
    }
    if lost.get(first):
        row["critical_speed"] = lattice[first]
    return row
