"""Branches of cycles against one parameter, beside a sweep. Each cycle that the sweep reaches, and
the cycle near the static start, is continued in both directions, unless a known branch passes
there.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import xarray as xr

from disc_model.arrays import Array
from disc_model.data.variables import OF_QUANTITIES, value_with_unit
from disc_model.display import counted
from disc_model.parameters import Parameters
from disc_model.studies.quantities.hysteresis import DIRECTIONS, STAYS
from disc_model.studies.quantity import (
    BETWEEN,
    NUMERICAL,
    Free,
    found,
    listed,
    quantity,
    values_between,
)
from disc_model.units import Finite, Positive, Seconds, Tolerance, Unit

if TYPE_CHECKING:
    from disc_model.stability.continuation import Branch
    from disc_model.stability.cycle import FloquetResult

EVALUATED = 2.0  # s, the last stretch at a value, over which the range is taken
LONGEST = 0.05  # arclength of the longest step along a branch
MOST_POINTS = 300  # of a branch, in each direction, special points included
MOST_BRANCHES = 12
MOST_RELEASES = 4  # of a cycle that is followed
SAME = np.array([2e-4, 0.4])
"""Greatest differences of the logarithms of period and range for two cycles of one branch at one value. Periods
distinguish branches; ranges between points of a steep branch are known roughly."""


@quantity(
    points_per_job=2,
    own=("name",),
    rules=(
        *BETWEEN,
        *STAYS,
        (
            lambda o: o.sweep_from is None or o.sweep_from <= o.bounds[1],
            "sweep_from={0.sweep_from:g} must be <= the greatest value, {0.bounds[1]:g}",
        ),
    ),
)
def branches(
    case: Parameters,
    *,
    name: Free = "Omega",
    bounds: Annotated[tuple[Finite, Finite], Unit(of="name")],
    step: Annotated[Positive, Unit(of="name")],
    sweep_from: Annotated[Finite | None, Unit(of="name")] = None,
    dwell: Seconds,
    max_dwell: Seconds = 480.0,
    tol: Tolerance = 1e-10,
) -> xr.Dataset:
    """Branches of stable and unstable cycles against one parameter, by continuation, and a sweep up and down.

    Parameters
    ----------
    name : number of the case along which cycles are followed
    bounds : its least and greatest value
    step : between values of the sweep
    sweep_from : value at which the rising sweep begins; the least one if not given
    dwell : time at each value, doubled until the motion has settled
    max_dwell : longest time at a value
    tol : tolerance of simulations: error of event times after a second of motion

    Returns
    -------
    xarray.Dataset
        The variables of a study of this quantity, with words as words; attributes are the case (`parameters`), the
        `options`, and in `message` what went wrong or is missing

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15)
    >>> dm.branches(case, bounds=(14, 15), step=0.5, dwell=5, max_dwell=5)["n_branches"].item()
    1
    """
    from disc_model.stability.attractors import sweep
    from disc_model.stability.continuation import StepControl, continue_cycle
    from disc_model.stability.cycle import find_cycle
    from disc_model.stability.segments import extremes_of_cycle
    from disc_model.stability.sliding import steady_sliding

    values = values_between(bounds, step)
    columns = OF_QUANTITIES["branches"]["columns"]
    swept = {}
    for variable in ("sweep_range", "sweep_separation_rate", "sweep_settled"):
        swept[variable] = columns[variable].empty((2, len(values)))
    # leaves room for special points between those computed: as a step turns by 26 degrees at most, at least six
    # lie from fold to fold; with other bifurcations there is one among nine to eighteen points
    steps = StepControl(longest=LONGEST, max_points=5 * MOST_POINTS // 6, beyond=True)
    rows: list[dict[str, Any]] = []
    failures = 0
    left_out = 0

    def follow(cycle: FloquetResult, **how: Any) -> None:
        """Continue a cycle in both directions, unless a known branch passes there."""
        nonlocal failures, left_out
        assert cycle.state is not None
        low, high = extremes_of_cycle(cycle.parameters, cycle.state, cycle.period)
        value = cycle.parameters.numbers[name]
        if any(_passes(row, value, cycle.period, high - low) for row in rows):
            return
        if len(rows) >= MOST_BRANCHES:
            left_out += 1
            return
        ends = (values[0], values[-1])
        try:
            branch = continue_cycle(cycle.parameters, name, ends, steps=steps, **how)
        except NUMERICAL:
            failures += 1
        else:
            rows.extend(_stretches(branch, cycle.releases))

    remarks = []
    lowest = 0 if sweep_from is None else int(np.searchsorted(values, sweep_from))
    stays = sweep(case, name, values, dwell, max_dwell, EVALUATED, tol, lowest)
    for (way, i), result, late, reached in stays:
        if late is None:
            remarks.append(f"{value_with_unit(name, values[i])}: {result.message}")
            break
        swept["sweep_range"][way, i] = late.range
        swept["sweep_separation_rate"][way, i] = late.separation_rate
        answer = reached.settling.answer
        swept["sweep_settled"][way, i] = columns["sweep_settled"].flags.index(answer)
        if way == 0 or i < lowest:
            near_start = find_cycle(result.parameters)
            if near_start.state is not None:
                follow(near_start)
        if reached.near is not None and reached.near.cycle.releases <= MOST_RELEASES:
            cycle = reached.near.cycle
            follow(cycle, guess=cycle.state, releases=cycle.releases)
    found_values: dict[str, Any] = {
        **listed(rows),
        **swept,
        "status": "failed" if remarks else "ok",
        "n_branches": len(rows),
        "n_continuation_failures": failures,
        "sliding_growth_rate": [
            steady_sliding(case.replace(**{name: x})).growth_rate for x in values
        ],
    }
    if left_out:
        remarks.append(
            f"{counted(left_out, 'cycle')} of further branches, for which there is no room"
        )
    own: dict[str, Any] = {"branch": range(MOST_BRANCHES), "branch_point": range(2 * MOST_POINTS)}
    message = "; ".join(remarks)
    own |= {"direction": DIRECTIONS, "sweep_value": values}
    return found("branches", found_values, message, **own)


def _stretches(branch: Branch, releases: int) -> list[dict[str, Any]]:
    """A branch with the special points at which its stability may change among its points: a row for each
    stretch with one number of separations in a period. A stretch begins at the last point of the one before,
    to which it is joined."""
    columns = {
        "value": branch.refined(branch.name),
        "period": branch.refined("period"),
        "growth_rate": branch.refined("growth_rate"),
        "range": branch.refined("range"),
    }
    # no special point but a grazing lies where the number of separations changes
    separations = branch.refined("separations")
    rows = []
    ends = [0, *(np.flatnonzero(np.diff(separations)) + 1), len(separations)]
    for first, end in pairwise(ends):
        points = slice(max(first - 1, 0), end)
        row: dict[str, Any] = {key: column[points] for key, column in columns.items()}
        row |= {"releases": releases, "separations": int(separations[first])}
        if len(row["value"]) > 1:
            rows.append(row)
    return rows


def _passes(row: dict[str, Any], value: float, period: float, size: float) -> bool:
    """Whether a branch passes a value of the parameter with about this period and this range of the
    slider's height."""
    beyond: Array = row["value"] - value
    logarithms = np.log([row["period"], row["range"]])
    for i in np.flatnonzero(beyond[:-1] * beyond[1:] <= 0):
        width = beyond[i + 1] - beyond[i]
        share = -beyond[i] / width if width != 0 else 0.0
        there = logarithms[:, i] + share * (logarithms[:, i + 1] - logarithms[:, i])
        if np.all(np.abs(there - np.log([period, size])) <= SAME):
            return True
    return False
