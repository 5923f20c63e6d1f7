"""Hysteresis: a slow sweep of the speed up and down, which continues the motion from speed to speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np
import xarray as xr

from disc_model.data.variables import value_with_unit
from disc_model.display import counted
from disc_model.parameters import Parameters
from disc_model.studies.quantity import BETWEEN, Row, Rules, Speeds, found, quantity, values_between
from disc_model.units import Seconds, Speed, Tolerance

DIRECTIONS = ("up", "down")
STAYS: Rules = (
    (lambda o: o.max_dwell >= o.dwell, "max_dwell={0.max_dwell:g} must be >= dwell={0.dwell:g}"),
)
"""Rules of the times of stays at values."""
WITHIN = (
    lambda o: o.evaluation_time <= o.dwell,
    "evaluation_time={0.evaluation_time:g} must be <= dwell={0.dwell:g}",
)
Stays = dict[tuple[int, int], Row]
"""Columns of stays at values, by direction (0 up, 1 down) and the index of the value."""


@quantity(points_per_job=3, own=("Omega",), rules=(*BETWEEN, *STAYS, WITHIN))
def hysteresis(
    case: Parameters,
    bounds: Speeds,
    dwell: Seconds,
    *,
    step: Speed = 1.0,
    max_dwell: Seconds = 480.0,
    evaluation_time: Seconds = 5.0,
    tol: Tolerance = 1e-10,
) -> xr.Dataset:
    """Sweep the speed up from the static start and down again, continuing the same motion, and describe it at each
    value.

    Parameters
    ----------
    bounds : least and greatest value
    dwell : time at each value, doubled until the motion has settled
    step : between values
    max_dwell : longest time at a value
    evaluation_time : length of the last stretch at a value, which is described
    tol : tolerance of simulations: error of event times after a second of motion

    Returns
    -------
    xarray.Dataset
        `onset_speed`, `offset_speed` (rad/s): the first speed with separation on the way up, and the lowest one to
        which it persists on the way down. They are nan where the bounds do not show them, as where separation begins at
        the lowest speed; `message` says whether motions in contact had not settled (`sweep_settled`): the onset may
        then be lower. `separation_rate` (1/s), `stay` (s) and others by direction and speed.

    Examples
    --------
    >>> import disc_model as dm
    >>> sweep = dm.hysteresis(dm.Parameters(N=385, Omega=14), (14, 16), dwell=20, max_dwell=80)
    >>> sweep["onset_speed"].item(), sweep["separation_rate"].dims
    (16.0, ('direction', 'sweep_Omega'))
    """
    from disc_model.stability.attractors import sweep

    swept = values_between(bounds, step)
    stays: Stays = {}
    status = "ok"
    remarks = []
    for place, result, late, reached in sweep(
        case, "Omega", swept, dwell, max_dwell, evaluation_time, tol
    ):
        stays[place] = {"sweep_settled": reached.answer, "stay": reached.stay}
        stays[place]["separation_rate"] = np.nan
        if late is None:
            status = result.status.value
            remarks.append(f"{value_with_unit('Omega', swept[place[1]])}: {result.message}")
        else:
            stays[place] |= {**asdict(late), "range": late.range}
        stays[place]["sweep_status"] = status
    values = by_place(stays, len(swept))
    rates = np.array(values["separation_rate"], dtype=float)
    onset, offset = _edges(swept, rates)
    values |= {"status": status, "onset_speed": onset, "offset_speed": offset}
    settled = np.array(values["sweep_settled"]) == "settled"
    if doubtful := int(((rates == 0) & ~settled).sum()):
        after = f"after {counted(doubtful, 'stay')}"
        remarks.append(f"{after} the motion in contact had not settled: raise max_dwell")
    return found("hysteresis", values, *remarks, direction=DIRECTIONS, sweep_Omega=swept)


def by_place(stays: Stays, count: int) -> Row:
    """Columns of stays by direction and value; None where the sweep did not come."""
    names = dict.fromkeys(name for stay in stays.values() for name in stay)
    return {
        name: [[stays.get((way, i), {}).get(name) for i in range(count)] for way in (0, 1)]
        for name in names
    }


def _edges(swept: Sequence[float], rates: np.ndarray) -> tuple[float, float]:
    """Values at which separation sets in on the way up, and to which it persists on the way down, nan where
    they are not known: each lies beside a value at which contact is kept."""
    rising, falling = rates > 0
    onset = offset = np.nan
    if rising.any() and not rising[0]:
        onset = swept[rising.argmax()]
    quiet = np.flatnonzero(~falling)
    if falling[-1] and quiet.size and not np.isnan(rates[1, quiet[-1]]):
        offset = swept[quiet[-1] + 1]
    return onset, offset


def swept_speeds(sweep: xr.Dataset) -> tuple[xr.DataArray, xr.DataArray]:
    """Speeds (rad/s) of a study at which separation begins on the way up and ends on the way down; the lowest
    one where contact is lost there already, or still."""
    apart = sweep["separation_rate"] > 0
    lowest = sweep["sweep_Omega"].min()
    at_once = apart.sel(direction="up", drop=True).isel(sweep_Omega=0, drop=True)
    always = apart.sel(direction="down", drop=True).all("sweep_Omega")
    return sweep["onset_speed"].where(~at_once, lowest), sweep["offset_speed"].where(
        ~always, lowest
    )
