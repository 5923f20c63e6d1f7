"""Branches of cycles against one parameter: stable and unstable, in contact and separating, beside a sweep.

The sweep up and down starts at each value from the motion at the last one. Each cycle that the sweep reaches, and the
cycle near the static start, is continued in both directions, unless a known branch passes there.
"""

import math
from typing import Any

import numpy as np

from disc_model.analysis.settling import ANSWER
from disc_model.data.variables import Variable
from disc_model.parameters import Parameters
from disc_model.simulation.states import State
from disc_model.stability.attractor.classification import sweep
from disc_model.stability.attractor.outcome import final_segment
from disc_model.stability.branch import StepControl
from disc_model.stability.continuation import continue_cycle
from disc_model.stability.cycle import FloquetResult, find_cycle
from disc_model.stability.return_map import ReturnMap
from disc_model.stability.sliding import steady_sliding
from disc_model.studies.document import BranchesOptions
from disc_model.studies.grids.points import DIRECTION, NUMERICAL, STATUS, Coordinate, Point, listed

_ONE, _EACH, _SWEEP = ("branch",), ("branch", "branch_point"), ("direction", "sweep_value")
COLUMNS = {
    "status": STATUS,
    "n_branches": Variable("1", "number of branches found", whole=True),
    "n_continuation_failures": Variable("1", "number of cycles that could not be followed", whole=True),
    "releases": Variable("1", "releases of stick in a period of the branch", dims=_ONE, whole=True),
    "separations": Variable("1", "separations in a period of the branch", dims=_ONE, whole=True),
    "value": Variable("", "parameter along the branch, SI units", dims=_EACH),
    "period": Variable("s", "period of the cycle", dims=_EACH),
    "range": Variable("m", "range of the slider's height over a period", dims=_EACH),
    "growth_rate": Variable("s-1", "growth rate of disturbances of the cycle", dims=_EACH),
    "sweep_range": Variable("m", "range of the slider's height at the end of the stay at a value", dims=_SWEEP),
    "sweep_separation_rate": Variable("s-1", "separations per second at the end of the stay at a value", dims=_SWEEP),
    "sweep_settled": ANSWER._replace(dims=_SWEEP),
    "sliding_growth_rate": Variable("s-1", "growth rate of disturbances of steady sliding", dims=_SWEEP[1:]),
}
COORDINATES = {
    "direction": DIRECTION,
    "sweep_value": Coordinate("", "{0.parameter} in the sweep, SI units", lambda o: o.scan.values),
    "branch": Coordinate("1", "number of the branch", lambda o: range(o.max_branches)),
    "branch_point": Coordinate("1", "number of the point along the branch", lambda o: range(2 * o.max_points)),
}
SAME = np.array([2e-4, 0.4])
"""Greatest differences of the logarithms of period and range for two cycles of one branch at one value. Periods
distinguish branches; ranges between points of a steep branch are known roughly."""


def compute_point(point: Point, options: BranchesOptions) -> tuple[dict[str, Any], str]:
    """Compute the sweep and the branches; the point's own value of the parameter is not used."""
    values, unfollowed = options.scan.values, []
    rows: list[dict[str, Any]] = []
    swept = {name: column.empty((2, len(values))) for name, column in COLUMNS.items() if column.dims == _SWEEP}
    message = ""

    def follow(cycle: FloquetResult, reached: bool) -> None:
        assert cycle.state is not None
        value = getattr(cycle.parameters, options.parameter)
        size = _range(cycle.parameters, cycle.state, cycle.period)
        if len(rows) < options.max_branches and not any(_passes(row, value, cycle.period, size) for row in rows):
            try:
                rows.append(_branch(cycle, reached, options))
            except NUMERICAL as error:
                unfollowed.append(str(error))

    dwell, longest, evaluated = options.dwell, options.max_dwell, options.evaluation_time
    for (way, i), result, late, reached in sweep(
        point.parameters, options.parameter, values, dwell, longest, evaluated, options.tol
    ):
        if late is None:
            message = f"{options.parameter}={values[i]:g}: {result.message}"
            break
        swept["sweep_range"][way, i], swept["sweep_separation_rate"][way, i] = late.range, late.separation_rate
        swept["sweep_settled"][way, i] = ANSWER.flags.index(reached.settling.answer)
        if way == 0 and (own := find_cycle(result.parameters)).state is not None:
            follow(own, False)
        if reached.near is not None and reached.near.cycle.releases <= options.releases:
            follow(reached.near.cycle, True)
    sliding = [steady_sliding(point.parameters.replace(**{options.parameter: v})).growth_rate for v in values]
    counts = {"n_branches": len(rows), "n_continuation_failures": len(unfollowed)}
    known = {"status": "failed" if message else "ok", "sliding_growth_rate": sliding}
    return listed(rows) | swept | counts | known, message


def _branch(cycle: FloquetResult, reached: bool, options: BranchesOptions) -> dict[str, Any]:
    """Continue a cycle in both directions by arclength: the one near the static start, or one that a motion reached."""
    p, name = cycle.parameters, options.parameter
    bounds = options.scan.values[0], options.scan.values[-1]
    near = cycle.state if reached else None
    steps = StepControl(longest=options.max_step, max_points=options.max_points)
    down, up = (
        continue_cycle(p, name, bounds, direction=way, steps=steps, guess=near, releases=cycle.releases if near else 1)
        for way in (-1, 1)
    )
    values, points, period, growth_rate = (
        np.concatenate([getattr(down, column)[::-1], getattr(up, column)[1:]])
        for column in ("values", "points", "period", "growth_rate")
    )
    row = {"value": values[:, 0], "period": period, "growth_rate": growth_rate}
    own = ReturnMap(p)
    ranges = []
    for value, x, time in zip(row["value"], points, period, strict=True):
        case = p.replace(**{name: float(value)})
        map_ = ReturnMap(case)
        ranges.append(_range(case, map_.state(x / own.scale * map_.scale), time))
    return row | {"range": np.array(ranges), "releases": cycle.releases, "separations": cycle.separations}


def _range(p: Parameters, state: State, period: float) -> float:
    """Range of the slider's height over a period, m; nan if it cannot be simulated."""
    _, stretch = final_segment(p, state, period, period, 1e-10)
    return math.nan if stretch is None else stretch.range


def _passes(row: dict[str, Any], value: float, *of: float) -> bool:
    """Whether a branch passes a value of the parameter with about this period and this range of the slider's height."""
    x, y = row["value"], np.log([row["period"], row["range"]])
    for i in np.flatnonzero((x[:-1] - value) * (x[1:] - value) <= 0):
        share = (value - x[i]) / (x[i + 1] - x[i]) if x[i + 1] != x[i] else 0.0
        if np.all(np.abs(y[:, i] + share * (y[:, i + 1] - y[:, i]) - np.log(of)) <= SAME):
            return True
    return False
