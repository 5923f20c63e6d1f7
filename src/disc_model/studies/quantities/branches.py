"""Branches of cycles against one parameter, beside a sweep. Each cycle that the sweep reaches, and
the cycle near the static start, is continued in both directions, unless a known branch passes
there.
"""

import math
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from disc_model.analysis.classify import ANSWER
from disc_model.data.variables import Variable
from disc_model.parameters import Parameters
from disc_model.studies import quantity
from disc_model.studies.costs import UnitCosts
from disc_model.studies.quantity import (
    STATUS,
    Coordinate,
    Free,
    Point,
    Quantity,
    Range,
    State,
    along,
)
from disc_model.units import Count, Finite, Positive, Seconds, Tolerance, Unit

_SWEEP = ("direction", "sweep_value")
_one, _each, _swept = along("branch"), along("branch", "branch_point"), along(*_SWEEP)


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
    max_points: Annotated[Count, Field(ge=2, le=10_000)] = 200
    """most points of a branch, in each direction"""
    max_branches: Annotated[Count, Field(ge=1, le=1000)] = 12
    """room for that many branches"""
    tol: Tolerance = 1e-10
    """tolerance of simulations: error of event times after a second of motion"""

    _rules = (
        (lambda o: o.evaluation_time <= o.dwell, "evaluation_time must be <= dwell"),
        (
            lambda o: o.sweep_from is None or o.sweep_from <= o.scan.stop,
            "sweep_from must be <= the scan's last value",
        ),
    )
    scans: ClassVar = ("parameter",)
    COLUMNS: ClassVar = {
        "status": STATUS,
        "n_branches": Variable("1", "number of branches found", whole=True),
        "n_continuation_failures": Variable(
            "1", "number of cycles that could not be followed", whole=True
        ),
        "releases": _one("1", "releases of stick in a period of the branch", whole=True),
        "separations": _one("1", "separations in a period of the branch", whole=True),
        "value": _each("", "parameter along the branch, SI units"),
        "period": _each("s", "period of the cycle"),
        "range": _each("m", "range of the slider's height over a period"),
        "growth_rate": _each("s-1", "growth rate of disturbances of the cycle"),
        "sweep_range": _swept(
            "m", "range of the slider's height at the end of the stay at a value"
        ),
        "sweep_separation_rate": _swept(
            "s-1", "separations per second at the end of the stay at a value"
        ),
        "sweep_settled": ANSWER._replace(dims=_SWEEP),
        "sliding_growth_rate": Variable(
            "s-1", "growth rate of disturbances of steady sliding", dims=_SWEEP[1:]
        ),
    }
    COORDINATES: ClassVar = {
        "direction": quantity.DIRECTION,
        "sweep_value": Coordinate(
            "", "{0.parameter} in the sweep, SI units", lambda o: o.scan.values
        ),
        "branch": Coordinate("1", "number of the branch", lambda o: range(o.max_branches)),
        "branch_point": Coordinate(
            "1", "number of the point along the branch", lambda o: range(2 * o.max_points)
        ),
    }

    def cost(self, unit: UnitCosts) -> float:
        """The sweep, whose stays are doubled once or twice, and some ten branches."""
        sweep = 6 * unit.second * (self.scan.intervals + 1) * self.dwell
        return sweep + 10 * unit.cycle * self.max_points

    def compute_point(self, point: Point) -> tuple[dict[str, Any], str]:
        from disc_model.stability.attractors import sweep
        from disc_model.stability.cycle import find_cycle
        from disc_model.stability.sliding import steady_sliding

        values, message, failures = self.scan.values, "", 0
        rows: list[dict[str, Any]] = []
        swept = {
            name: column.empty((2, len(values)))
            for name, column in self.COLUMNS.items()
            if column.dims == _SWEEP
        }

        def follow(cycle: quantity.FloquetResult, reached: bool) -> None:
            nonlocal failures
            assert cycle.state is not None
            value = cycle.parameters.numbers[self.parameter]
            size = _range(cycle.parameters, cycle.state, cycle.period)
            if len(rows) < self.max_branches and not any(
                _passes(row, value, cycle.period, size) for row in rows
            ):
                try:
                    rows.append(_branch(cycle, reached, self))
                except quantity.NUMERICAL:
                    failures += 1

        lowest = 0 if self.sweep_from is None else int(np.searchsorted(values, self.sweep_from))
        how = self.dwell, self.max_dwell, self.evaluation_time, self.tol, lowest
        for (way, i), result, late, reached in sweep(
            point.parameters, self.parameter, values, *how
        ):
            if late is None:
                message = f"{self.parameter}={values[i]:g}: {result.message}"
                break
            swept["sweep_range"][way, i], swept["sweep_separation_rate"][way, i] = (
                late.range,
                late.separation_rate,
            )
            swept["sweep_settled"][way, i] = ANSWER.flags.index(reached.settling.answer)
            if (way == 0 or i < lowest) and (
                near_start := find_cycle(result.parameters)
            ).state is not None:
                follow(near_start, False)
            if reached.near is not None and reached.near.cycle.releases <= self.releases:
                follow(reached.near.cycle, True)
        sliding = [
            steady_sliding(point.parameters.replace(**{self.parameter: v})).growth_rate
            for v in values
        ]
        counts = {"n_branches": len(rows), "n_continuation_failures": failures}
        known = {"status": "failed" if message else "ok", "sliding_growth_rate": sliding}
        return quantity.listed(rows) | swept | counts | known, message


SAME = np.array([2e-4, 0.4])
"""Greatest differences of the logarithms of period and range for two cycles of one branch at one value. Periods
distinguish branches; ranges between points of a steep branch are known roughly."""


def _branch(cycle: quantity.FloquetResult, reached: bool, options: Branches) -> dict[str, Any]:
    """Continue a cycle in both directions by arclength: the one near the static start, or one that
    a motion reached."""
    from disc_model.stability.continuation import StepControl, continue_cycle
    from disc_model.stability.return_map import ReturnMap

    p, name = cycle.parameters, options.parameter
    bounds = options.scan.values[0], options.scan.values[-1]
    near = cycle.state if reached else None
    steps = StepControl(longest=options.max_step, max_points=options.max_points, beyond=True)
    branch = continue_cycle(
        p, name, bounds, steps=steps, guess=near, releases=cycle.releases if near else 1
    )
    row = {"value": branch.values[:, 0], "period": branch.period, "growth_rate": branch.growth_rate}
    return_map = ReturnMap(p)
    ranges = []
    for value, x, time in zip(row["value"], branch.points, branch.period, strict=True):
        case = p.replace(**{name: float(value)})
        map_ = ReturnMap(case)
        ranges.append(_range(case, map_.state(x / return_map.scale * map_.scale), time))
    return row | {
        "range": np.array(ranges),
        "releases": cycle.releases,
        "separations": cycle.separations,
    }


def _range(p: Parameters, state: State, period: float) -> float:
    """Range of the slider's height over a period, m; nan if it cannot be simulated."""
    from disc_model.stability.outcome import final_segment

    _, stretch = final_segment(p, state, period, period, 1e-10)
    return math.nan if stretch is None else stretch.range


def _passes(row: dict[str, Any], value: float, *of: float) -> bool:
    """Whether a branch passes a value of the parameter with about this period and this range of the
    slider's height."""
    x, y = row["value"], np.log([row["period"], row["range"]])
    for i in np.flatnonzero((x[:-1] - value) * (x[1:] - value) <= 0):
        share = (value - x[i]) / (x[i + 1] - x[i]) if x[i + 1] != x[i] else 0.0
        if np.all(np.abs(y[:, i] + share * (y[:, i + 1] - y[:, i]) - np.log(of)) <= SAME):
            return True
    return False
