"""Branches of cycles against one parameter, beside a sweep. Each cycle that the sweep reaches, and
the cycle near the static start, is continued in both directions, unless a known branch passes
there.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from xarray import Dataset

from disc_model.data.variables import value_with_unit
from disc_model.parameters import Parameters
from disc_model.studies.quantities.hysteresis import DIRECTIONS, STAYS, Stays, by_place
from disc_model.studies.quantity import (
    BETWEEN,
    NUMERICAL,
    Bounds,
    Free,
    Row,
    Step,
    found,
    listed,
    quantity,
    values_between,
)
from disc_model.units import Finite, Seconds, Tolerance, Unit

if TYPE_CHECKING:
    from disc_model.stability.continuation import Branch
    from disc_model.stability.cycle import FloquetResult

EVALUATED = 2.0  # s, the last stretch at a value, over which the range is taken
LONGEST = 0.05  # arclength of the longest step along a branch
MOST_POINTS = 300  # of a branch, in each direction, special points included
MOST_BRANCHES = 12
MOST_RELEASES = 4  # of a cycle that is followed
SAME = np.array([[2e-4], [0.4]])
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
    bounds: Bounds,
    step: Step,
    sweep_from: Annotated[Finite | None, Unit(of="name")] = None,
    dwell: Seconds,
    max_dwell: Seconds = 480.0,
    tol: Tolerance = 1e-10,
) -> Dataset:
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

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15)
    >>> dm.branches(case, bounds=(14, 15), step=0.5, dwell=5, max_dwell=5)["n_branches"].item()
    1
    """
    from disc_model.stability.attractors import sweep
    from disc_model.stability.cycle import find_cycle
    from disc_model.stability.sliding import steady_sliding

    values = values_between(bounds, step)
    swept: Stays = {}
    family = Family(name, (values[0], values[-1]))
    remarks = []
    lowest = 0 if sweep_from is None else int(np.searchsorted(values, sweep_from))
    stays = sweep(case, name, values, dwell, max_dwell, EVALUATED, tol, lowest)
    for (way, i), result, late, reached in stays:
        if late is None:
            remarks.append(f"{value_with_unit(name, values[i])}: {result.message}")
            break
        swept[way, i] = {
            "sweep_range": late.range,
            "sweep_separation_rate": late.separation_rate,
            "sweep_settled": reached.answer,
        }
        if way == 0 or i < lowest:
            near_start = find_cycle(result.parameters)
            if near_start.state is not None:
                family.follow(near_start)
        if reached.near is not None and reached.near.cycle.releases <= MOST_RELEASES:
            cycle = reached.near.cycle
            family.follow(cycle, guess=cycle.state, releases=cycle.releases)
    found_values: Row = {
        **listed(family.rows),
        **by_place(swept, len(values)),
        "n_branches": len(family.rows),
        "n_continuation_failures": family.failures,
        "sliding_growth_rate": [
            steady_sliding(case.replace(**{name: x})).growth_rate for x in values
        ],
    }
    if remarks:
        found_values["status"] = "failed"
    own: Row = {"branch": range(MOST_BRANCHES), "branch_point": range(2 * MOST_POINTS)}
    own |= {"direction": DIRECTIONS, "sweep_value": values}
    return found("branches", found_values, *remarks, **own)


@dataclass
class Family:
    """Branches along one number of the case.

    name, ends : of the number, and between which values
    rows : columns of each stretch of a branch
    failures : number of cycles that could not be continued
    """

    name: str
    ends: tuple[float, float]
    rows: list[Row] = field(default_factory=list)
    failures: int = 0

    def follow(self, cycle: FloquetResult, **how: Any) -> None:
        """Continue a cycle in both directions, unless a known branch passes there."""
        from disc_model.stability.continuation import StepControl, continue_cycle
        from disc_model.stability.segments import extremes_of_cycle

        case = cycle.parameters
        assert cycle.state is not None
        low, high = extremes_of_cycle(case, cycle.state, cycle.period)
        value = case.numbers[self.name]
        if any(_passes(row, value, cycle.period, high - low) for row in self.rows):
            return
        # leaves room for special points between those computed: as a step turns by 26 degrees at most, at least six
        # lie from fold to fold; with other bifurcations there is one among nine to eighteen points
        steps = StepControl(longest=LONGEST, max_points=5 * MOST_POINTS // 6)
        try:
            branch = continue_cycle(case, self.name, self.ends, steps=steps, **how)
        except NUMERICAL:
            self.failures += 1
        else:
            self.rows += _stretches(branch, cycle.releases)


def _stretches(branch: Branch, releases: int) -> list[Row]:
    """The stretches of a branch with one number of separations in a period, a row for each. A stretch begins
    at the last point of the one before, to which it is joined."""
    columns = {
        "value": branch.values,
        "period": branch.period,
        "growth_rate": branch.growth_rate,
        "range": branch.range,
    }
    separations = branch.separations
    rows = []
    ends = [0, *(np.flatnonzero(np.diff(separations)) + 1), len(separations)]
    for first, end in pairwise(ends):
        points = slice(max(first - 1, 0), end)
        row: Row = {key: column[points] for key, column in columns.items()}
        row |= {"releases": releases, "separations": int(separations[first])}
        if len(row["value"]) > 1:
            rows.append(row)
    return rows


def _passes(row: Row, value: float, period: float, size: float) -> bool:
    """Whether a branch passes a value of the parameter with about this period and this range of the
    slider's height."""
    beyond = row["value"] - value
    at = np.flatnonzero(beyond[:-1] * beyond[1:] <= 0)
    widths = np.diff(beyond)[at]
    shares = -beyond[at] / np.where(widths == 0, 1.0, widths)
    logarithms = np.log([row["period"], row["range"]])
    there = logarithms[:, at] + shares * np.diff(logarithms)[:, at]
    apart = np.abs(there - np.log([[period], [size]]))
    return bool(np.all(apart <= SAME, axis=0).any())
