"""Branches of cycles against one parameter, beside a sweep. Each cycle that the sweep reaches, and
the cycle near the static start, is continued in both directions, unless a known branch passes
there.
"""

from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from pydantic import Field

from disc_model.data.variables import OF_QUANTITIES, value_with_unit
from disc_model.display import counted
from disc_model.studies.quantity import (
    DIRECTION,
    NUMERICAL,
    Coordinate,
    FloquetResult,
    Free,
    Point,
    Quantity,
    Range,
    listed,
)
from disc_model.units import Count, Finite, Positive, Seconds, Tolerance, Unit

_SWEEP = ("direction", "sweep_value")


class Branches(Quantity):
    """Branches of stable and unstable cycles against one parameter, by continuation, and a sweep up
    and down."""

    parameter: Free = "Omega"
    """number of the case along which cycles are followed"""
    scan: Annotated[Range, Unit(of="parameter")]
    """values of the sweep; cycles are followed between the first and the last"""
    sweep_from: Annotated[Finite | None, Unit(of="parameter")] = None
    """value at which the rising sweep begins; the first one if not given"""
    dwell: Seconds
    """time at each value, doubled until the motion has settled"""
    max_dwell: Seconds = 480.0
    """longest time at a value"""
    evaluation_time: Seconds = 2.0
    """length of the last stretch at a value, over which the range is taken"""
    releases: Annotated[Count, Field(ge=1, le=100)] = 4
    """greatest number of releases of a cycle that is followed"""
    max_step: Positive = 0.05
    """arclength of the longest step along a branch"""
    max_points: Annotated[Count, Field(ge=2, le=10_000)] = 300
    """most points of a branch, in each direction, special points included"""
    max_branches: Annotated[Count, Field(ge=1, le=1000)] = 12
    """room for that many branches"""
    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""

    _rules = (
        (
            lambda o: o.evaluation_time <= o.dwell,
            "evaluation_time={0.evaluation_time:g} must be <= dwell={0.dwell:g}",
        ),
        (
            lambda o: o.max_dwell >= o.dwell,
            "max_dwell={0.max_dwell:g} must be >= dwell={0.dwell:g}",
        ),
        (
            lambda o: o.sweep_from is None or o.sweep_from <= o.scan.stop,
            "sweep_from={0.sweep_from:g} must be <= the scan's last value, {0.scan.stop:g}",
        ),
    )
    points_per_job: ClassVar = 2
    scans: ClassVar = ("parameter",)
    COLUMNS: ClassVar = OF_QUANTITIES["branches"]["columns"]
    COORDINATES: ClassVar = {
        "direction": DIRECTION,
        "sweep_value": Coordinate(lambda o: o.scan.values),
        "branch": Coordinate(lambda o: range(o.max_branches), "max_branches"),
        "branch_point": Coordinate(lambda o: range(2 * o.max_points)),
    }

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        from disc_model.stability.attractors import sweep
        from disc_model.stability.cycle import find_cycle
        from disc_model.stability.sliding import steady_sliding

        values = self.scan.values
        message = ""
        swept = {
            name: column.empty((2, len(values)))
            for name, column in self.COLUMNS.items()
            if column.dims == _SWEEP
        }
        answers = self.COLUMNS["sweep_settled"].flags
        found = _Found(self)
        lowest = 0
        if self.sweep_from is not None:
            lowest = int(np.searchsorted(values, self.sweep_from))
        how = self.dwell, self.max_dwell, self.evaluation_time, self.tol, lowest
        for (way, i), result, late, reached in sweep(
            point.parameters, self.parameter, values, *how
        ):
            if late is None:
                message = f"{value_with_unit(self.parameter, values[i])}: {result.message}"
                break
            swept["sweep_range"][way, i] = late.range
            swept["sweep_separation_rate"][way, i] = late.separation_rate
            swept["sweep_settled"][way, i] = answers.index(reached.settling.answer)
            if way == 0 or i < lowest:
                near_start = find_cycle(result.parameters)
                if near_start.state is not None:
                    found.follow(near_start, reached=False)
            if reached.near is not None and reached.near.cycle.releases <= self.releases:
                found.follow(reached.near.cycle, reached=True)
        sliding = [
            steady_sliding(point.parameters.replace(**{self.parameter: v})).growth_rate
            for v in values
        ]
        columns: dict[str, Any] = listed(found.rows)
        columns.update(swept)
        columns["n_branches"] = len(found.rows)
        columns["n_continuation_failures"] = found.failures
        columns["status"] = "failed" if message else "ok"
        columns["sliding_growth_rate"] = sliding
        return columns, "; ".join(filter(None, [message, found.message]))


SAME = np.array([2e-4, 0.4])
"""Greatest differences of the logarithms of period and range for two cycles of one branch at one value. Periods
distinguish branches; ranges between points of a steep branch are known roughly."""


class _Found:
    """The branches found so far, as rows of columns, and the numbers of cycles that could not be
    followed, and of those that were not, as there is no room for further branches."""

    def __init__(self, options: Branches) -> None:
        self.options = options
        self.rows: list[dict[str, Any]] = []
        self.failures = 0
        self.left_out = 0

    @property
    def message(self) -> str:
        """What was left out, in words; "" for nothing."""
        if not self.left_out:
            return ""
        cycles = counted(self.left_out, "cycle")
        return f"{cycles} of further branches, for which there is no room: raise max_branches"

    def follow(self, cycle: FloquetResult, *, reached: bool) -> None:
        """Continue a cycle in both directions, unless a known branch passes there: the one near the
        static start, or one that a motion reached."""
        from disc_model.stability.segments import extremes_of_cycle

        assert cycle.state is not None
        value = cycle.parameters.numbers[self.options.parameter]
        size = extremes_of_cycle(cycle.parameters, cycle.state, cycle.period).range
        known = any(_passes(row, value, cycle.period, size) for row in self.rows)
        if known:
            return
        if len(self.rows) >= self.options.max_branches:
            self.left_out += 1
            return
        try:
            rows = _branch(cycle, reached, self.options)
        except NUMERICAL:
            self.failures += 1
            return
        self.rows += rows


def _branch(cycle: FloquetResult, reached: bool, options: Branches) -> list[dict[str, Any]]:
    """The branch of a cycle, by continuation in both directions, with the special points at which
    its stability may change among its points: a row for each stretch with one number of separations
    in a period."""
    from disc_model.stability.continuation import StepControl, continue_cycle

    name = options.parameter
    steps = StepControl(longest=options.max_step, max_points=_most_points(options), beyond=True)
    branch = continue_cycle(
        cycle.parameters,
        name,
        (options.scan.values[0], options.scan.values[-1]),
        steps=steps,
        guess=cycle.state if reached else None,
        releases=cycle.releases if reached else 1,
    )
    # no special point but a grazing lies where the number of separations changes
    after = np.array([special.after for special in branch.changes], dtype=int)
    separations = np.insert(branch.separations, after + 1, branch.separations[after])
    columns = (
        branch.refined("values")[:, 0],
        branch.refined("period"),
        branch.refined_growth_rate(),
        branch.refined("range"),
        separations,
    )
    points = [_BranchPoint(*row) for row in zip(*map(np.ndarray.tolist, columns), strict=True)]
    return [_row(stretch, cycle.releases) for stretch in _stretches(points)]


class _BranchPoint(NamedTuple):
    """A cycle of a branch: the parameter's value, period (s), growth rate (1/s; 0 where stability
    changes), range of the slider's height (m), and number of separations in a period."""

    value: float
    period: float
    growth_rate: float
    range: float
    separations: int


def _most_points(options: Branches) -> int:
    """Largest number of computed points in each direction, which leaves room for the special points
    between them: as a step turns by 26 degrees at most, at least six lie from fold to fold; with
    period doublings and Neimark-Sacker bifurcations there is one among nine to eighteen points."""
    return max(2, 5 * options.max_points // 6)


def _stretches(points: list[_BranchPoint]) -> list[list[_BranchPoint]]:
    """Neighbouring points with one number of separations; the last of a stretch is repeated as the
    first of the next one, to which it is joined."""
    stretches = [[points[0]]]
    for point in points[1:]:
        if point.separations != stretches[-1][-1].separations:
            stretches.append([stretches[-1][-1]._replace(separations=point.separations)])
        stretches[-1].append(point)
    return [stretch for stretch in stretches if len(stretch) > 1]


def _row(stretch: list[_BranchPoint], releases: int) -> dict[str, Any]:
    """The columns of a stretch of a branch."""
    return {
        "value": np.array([point.value for point in stretch]),
        "period": np.array([point.period for point in stretch]),
        "growth_rate": np.array([point.growth_rate for point in stretch]),
        "range": np.array([point.range for point in stretch]),
        "releases": releases,
        "separations": stretch[0].separations,
    }


def _passes(row: dict[str, Any], value: float, period: float, size: float) -> bool:
    """Whether a branch passes a value of the parameter with about this period and this range of the
    slider's height."""
    values = row["value"]
    logarithms = np.log([row["period"], row["range"]])
    known = np.log([period, size])
    beyond = values - value
    for i in np.flatnonzero(beyond[:-1] * beyond[1:] <= 0):
        width = values[i + 1] - values[i]
        share = 0.0
        if width != 0:
            share = -beyond[i] / width
        rise = logarithms[:, i + 1] - logarithms[:, i]
        there = logarithms[:, i] + share * rise
        if np.all(np.abs(there - known) <= SAME):
            return True
    return False
