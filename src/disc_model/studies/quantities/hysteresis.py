"""Hysteresis: a slow sweep of the speed or of another number up and down, which continues the motion from
value to value."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict
from typing import Annotated, Any

import numpy as np
import xarray as xr

from disc_model.data.coded import words
from disc_model.data.variables import (
    OF_QUANTITIES,
    WORDS,
    attributes_of_number,
    unit_of_parameter,
    value_with_unit,
)
from disc_model.errors import require
from disc_model.parameters import Parameters
from disc_model.studies.quantities.swept_speeds import (
    SPEED,
    doubtful_contact,
    edges_along,
    swept_speeds,
)
from disc_model.studies.quantity import BETWEEN, Free, Rules, found, quantity, values_between
from disc_model.units import Finite, Positive, Seconds, Tolerance, Unit

DIRECTIONS = ("up", "down")
STAYS: Rules = (
    (
        lambda o: o.evaluation_time <= o.dwell,
        "evaluation_time={0.evaluation_time:g} must be <= dwell={0.dwell:g}",
    ),
    (lambda o: o.max_dwell >= o.dwell, "max_dwell={0.max_dwell:g} must be >= dwell={0.dwell:g}"),
)
"""Rules of the times of stays at values."""


@quantity(points_per_job=3, own=("name",), rules=(*BETWEEN, *STAYS))
def hysteresis(
    case: Parameters,
    bounds: Annotated[tuple[Finite, Finite], Unit(of="name")],
    dwell: Seconds,
    *,
    name: Free = SPEED,
    step: Annotated[Positive, Unit(of="name")] = 1.0,
    max_dwell: Seconds = 480.0,
    evaluation_time: Seconds = 5.0,
    tol: Tolerance = 1e-10,
) -> xr.Dataset:
    """Sweep the speed or another number of a case up from the static start and down again, continuing the same
    motion, and describe it at each value.

    Parameters
    ----------
    bounds : least and greatest value
    dwell : time at each value, doubled until the motion has settled
    name : number of the case that is swept, which leaves the shapes of the modes as they are
    step : between values
    max_dwell : longest time at a value
    evaluation_time : length of the last stretch at a value, which is described
    tol : tolerance of simulations: error of event times after a second of motion

    Returns
    -------
    xarray.Dataset
        `onset_speed`, `offset_speed` (rad/s): the first speed with separation on the way up, and the lowest one to
        which it persists on the way down. They are nan where the bounds do not show them, such as where contact is
        still lost at the lower bound; `message` says why, and where a motion in contact had not settled
        (`sweep_settled`): the onset may then be lower, with a longer `max_dwell`. `separation_rate` (1/s), `stay` (s)
        and others by direction and speed. Of another number, such as N, they are `onset` and `offset` in its unit,
        and its values are `sweep_N`

    Examples
    --------
    >>> import disc_model as dm
    >>> sweep = dm.hysteresis(dm.Parameters(N=385, Omega=14), (14, 16), dwell=20, max_dwell=80)
    >>> sweep["onset_speed"].item(), sweep["separation_rate"].dims
    (16.0, ('direction', 'sweep_Omega'))
    """
    from disc_model.stability.attractors import sweep

    swept = values_between(bounds, step)
    _require_same_shapes(case, name, bounds)
    status = "ok"
    failure = ""
    values: dict[str, Any] = {}
    for variable, column in OF_QUANTITIES["hysteresis"]["columns"].items():
        if column.dims:
            values[variable] = column.empty((2, len(swept)))
    answers = OF_QUANTITIES["hysteresis"]["columns"]["sweep_settled"].flags
    steps = sweep(case, name, swept, dwell, max_dwell, evaluation_time, tol)
    for index, result, late, reached in steps:
        if late is None:
            status = result.status.value
            failure = f"{value_with_unit(name, swept[index[1]])}: {result.message}"
        values["sweep_status"][index] = WORDS["point_statuses"].index(status)
        values["sweep_settled"][index] = answers.index(reached.settling.answer)
        values["stay"][index] = reached.stay
        stretch = {**asdict(late), "range": late.range} if late else {}
        for variable in values.keys() & stretch.keys():
            values[variable][index] = stretch[variable]
    values |= {"status": status, **_edges(swept, values)}
    every = found("hysteresis", values, direction=DIRECTIONS, sweep_Omega=swept)
    if name != SPEED:
        edges = dict(zip(edges_along(SPEED), edges_along(name), strict=True))
        every = every.rename({"sweep_Omega": f"sweep_{name}", **edges})
        every[f"sweep_{name}"].attrs = {**attributes_of_number(name), "parameter": name}
    return every.assign(message=failure or "; ".join(_reasons(words(every), name)))


def _require_same_shapes(case: Parameters, name: str, bounds: Sequence[float]) -> None:
    """Raise `ParameterError` where values have other modes, in which no motion goes on."""
    from disc_model.simulation.states import mode_arrays

    low, high = (mode_arrays(case.replace(**{name: end})).psi for end in bounds)
    same = low.shape == high.shape and np.allclose(low, high, rtol=1e-9)
    require((same, "name", name, "must be a number that does not change the shapes of the modes"))


def _edges(swept: Sequence[float], values: dict[str, Any]) -> dict[str, float]:
    """Values at which separation sets in on the way up, and to which it persists on the way down, as far
    as they are known: each lies beside a value at which contact is kept."""
    edges = {}
    done = values["sweep_status"] == WORDS["point_statuses"].index("ok")
    rising, falling = values["separation_rate"] > 0
    if rising.any() and not rising[0]:
        edges["onset_speed"] = swept[rising.argmax()]
    if falling[-1]:
        quiet = np.flatnonzero(~falling)
        if quiet.size and done[1, quiet[-1]]:
            edges["offset_speed"] = swept[quiet[-1] + 1]
    return edges


def _reasons(sweep: xr.Dataset, name: str) -> Iterable[str]:
    """Why a sweep up and down has no onset or no end of separation, and where contact may yet be lost."""
    values = sweep[f"sweep_{name}"].values
    unit = f" {unit_of_parameter(name)}".rstrip()
    before = "" if name == SPEED else f"{name} = "
    lowest = f"{before}{values[0]:g}{unit}"
    highest = f"{before}{values[-1]:g}{unit}"
    speeds = swept_speeds(sweep)
    if not (sweep["separation_rate"] > 0).any():
        several = "speeds" if name == SPEED else f"values of {name}"
        span = f"from {values[0]:g} to {values[-1]:g}{unit}"
        yield f"contact is kept at all {values.size} {several} {span}"
    else:
        if speeds.onset_at_bound:
            yield f"contact is lost on the way up from the lower bound on, {lowest}"
        elif speeds.onset.isnull():
            yield f"contact is kept on the way up to {highest}"
        if speeds.end_at_bound:
            yield f"contact is still lost on the way down at the lower bound, {lowest}"
        elif speeds.end.isnull():
            yield f"contact is kept at {highest}, where the way down begins"
        if speeds.onset_at_bound or speeds.end_at_bound:
            yield "bounds further down may show where it is kept"
    doubts = []
    for direction in DIRECTIONS:
        doubtful = values[doubtful_contact(sweep).sel(direction=direction).values]
        if doubtful.size:
            at = ", ".join(f"{value:g}" for value in doubtful[:3])
            more = f" and {doubtful.size - 3} more" if doubtful.size > 3 else ""
            doubts.append(f"at {before}{at}{more}{unit} on the way {direction}")
    if doubts:
        where = " and ".join(doubts)
        yield f"{where} the motion in contact has not settled and may yet separate: raise max_dwell"
