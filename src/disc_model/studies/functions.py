"""What studies compute at a point, as functions of one case."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from operator import methodcaller
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.described import described
from disc_model.data.swept_speeds import SPEED, doubtful_contact, swept_speeds
from disc_model.errors import renamed, require, with_known_names
from disc_model.parameters import Parameters
from disc_model.studies.of_case import compute_quantity
from disc_model.studies.swept_along import named_along, scan_along, unit_along, value_along
from disc_model.units import in_si, is_number

PRECISION = 0.1
"""Width to which crossings are bisected unless another is asked for, rad/s."""


def _scan(ends: Any, step: Any) -> Any:
    """The range of a scan as an option of a quantity, which says what is wrong with it."""
    require(
        (
            np.shape(ends) == (2,),
            "bounds",
            ends,
            "must be two numbers in rad/s, the lowest and the highest speed",
        )
    )
    return {"start": ends[0], "stop": ends[1], "step": step}


@with_known_names
def outcome(
    case: Parameters,
    horizon: float | str = 1000.0,
    *,
    start: Mapping[str, float] | None = None,
    evaluation_time: float = 1.0,
    after_separation: float = 5.0,
    early_end: bool = True,
    extrapolate: bool = False,
    tol: float = 1e-10,
) -> xr.Dataset:
    """Long-term behaviour within a horizon, such as "stick_slip" or "separation", with ranges and phases
    late in the run.

    Parameters
    ----------
    case : the case
    horizon : s
    start : perturbations of the static start by name: u (m), u_velocity (m/s), f (rad/s); `initial_state` makes the
        state that they lead to
    evaluation_time : s, length of the last stretch, over which ranges and shares of the phases are taken
    after_separation : s, simulated after the first separation, so that the stretch shows the motion it leads to
    early_end : whether the simulation ends once a stable cycle or steady sliding is shown to be reached
    extrapolate : whether slow departures from cycles are extrapolated, which halves the time; the time of a separation
        after them, unless it is near the horizon, is known to about 1 % only, and not given
    tol : as in `simulate`

    Returns
    -------
    xarray.Dataset
        `outcome`, `first_separation` (s), and the stretch: P_min, P_max (N), u_min, u_max (m), stick_fraction, ...
        Of stable cycles in contact, "stick_slip" are that of `floquet`, and one whose release differs from the first
        release of the static start by at most a tenth of the static deflection; "other_cycle" are all others

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> reached = dm.outcome(dm.Parameters(N=385, Omega=15.1), 100)
    >>> print(reached["outcome"].item(), f"{reached['first_separation'].item():.1f} s")
    separation 54.4 s
    """
    options = {
        "horizon": horizon,
        "evaluation_time": evaluation_time,
        "after_separation": after_separation,
        "early_end": early_end,
        "extrapolate": extrapolate,
        "tol": tol,
    }
    return compute_quantity("outcome", case, options, start)


@renamed(scan="bounds")
@with_known_names
def critical_speed(  # noqa: PLR0913
    case: Parameters,
    bounds: tuple[float, float] = (5.0, 30.0),
    horizon: float | Sequence[float] = 1000.0,
    *,
    step: float = 1.0,
    precision: float | None = None,
    max_crossings: int = 12,
    early_end: bool = True,
    extrapolate: bool = True,
    tol: float = 1e-10,
    progress: bool = False,
) -> xr.Dataset:
    """The lowest speed of a scan with separation within a horizon, and all speeds where separation
    begins or ends.

    Separation in a range of speeds narrower than `step` can be overlooked.

    Parameters
    ----------
    case : the case; its own speed is not used
    bounds : rad/s, the lowest and the highest speed
    horizon : s, or a list of several, each with a critical speed of its own, along a dimension `horizon` of the result
    step : rad/s, of the scan
    precision : rad/s, to which crossings are bisected; `step` must be a multiple; if left out, 0.1 or the next smaller
        part of `step`
    max_crossings : largest number of crossings that are kept
    extrapolate : whether slow departures from cycles are extrapolated, which halves the time; separations after them
        are compared with the horizon, but have no time
    early_end, tol : as in `outcome`
    progress : whether a bar on standard error shows how many speeds of the scan are done; the bisection follows

    Returns
    -------
    xarray.Dataset
        `critical_speed` (rad/s, nan if none was found in steps of the scan) and crossings, by horizon where a list is
        given; outcomes and first separations along the scan. Contact was lost at the critical speed, and kept at the
        next lower one computed, which is lower by `precision`; where it was lost at the lowest speed already,
        `at_lower_bound` is true. The attribute `options` states precision, scan and horizons, and `message` which
        horizons have no critical speed, or one at the lower bound.

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
    options: dict[str, Any] = {
        "horizons": np.atleast_1d(horizon).tolist(),
        "scan": _scan(bounds, step),
        "precision": _part_of(step) if precision is None else precision,
        "max_crossings": max_crossings,
        "early_end": early_end,
        "extrapolate": extrapolate,
        "tol": tol,
    }
    found = compute_quantity("critical_speed", case, options, progress=progress)
    found = _with_reason(_with_bound(found))
    if np.ndim(horizon) == 0:
        return found.isel(horizon=0, drop=True)
    return found


def _part_of(step: Any) -> float:
    """The usual precision of a scan in steps: of their whole parts the largest up to 0.1 rad/s."""
    in_rad = in_si(step, "rad/s", [], ())
    is_step = is_number(in_rad) and 0 < in_rad < math.inf
    if not is_step:  # which is refused
        return PRECISION
    return float(in_rad / math.ceil(in_rad / PRECISION - 1e-9))


def _with_bound(speeds: xr.Dataset) -> xr.Dataset:
    """Results of a scan with whether each critical speed is the lowest one of the scan."""
    lowest = float(speeds["scan_Omega"].min())
    at_bound = speeds["critical_speed"] <= lowest
    return described(speeds.assign(at_lower_bound=at_bound), "critical_speed")


def _with_reason(speeds: xr.Dataset) -> xr.Dataset:
    """Results of a scan whose message says which horizons have no critical speed, or one at the lower
    bound, unless it says what went wrong."""
    if speeds.attrs["message"]:
        return speeds
    scan = speeds["scan_Omega"].values
    said = []
    if horizons := _horizons_text(speeds, speeds["critical_speed"].isnull()):
        speed = f"{scan.size} speeds from {scan[0]:g} to {scan[-1]:g} rad/s"
        said.append(f"no separation within {horizons} s at {speed}")
    if horizons := _horizons_text(speeds, speeds["at_lower_bound"]):
        text = f"contact is already lost within {horizons} s at the lower bound, "
        said.append(f"{text}{scan[0]:g} rad/s")
    return speeds.assign_attrs(message="; ".join(said))


def _horizons_text(speeds: xr.Dataset, chosen: xr.DataArray) -> str:
    """The chosen ones of the horizons of a scan; "" of none."""
    return ", ".join(f"{horizon:g}" for horizon in speeds["horizon"].values[chosen.values])


@with_known_names
def basins(  # noqa: PLR0913
    case: Parameters,
    energies: Sequence[float] = (0.0,),
    n_starts: int = 1,
    *,
    start: Mapping[str, float] | None = None,
    horizon: float | str = 200.0,
    seed: int = 1,
    attractor_tol: float = 0.1,
    n_bisection_directions: int = 1,
    precision: float = 0.05,
    confidence: float = 0.95,
    max_attractors: int = 12,
    tol: float = 1e-10,
    progress: bool = False,
) -> xr.Dataset:
    """Attractors of a case, the share of starts that comes to each, and the least energy found that
    leads to separation.

    This critical energy is an upper bound: it depends on the directions that are tried, and is lower with more
    `energies`, `n_starts` or `n_bisection_directions`. Which directions these are depends on the seed and on the
    number of starts at lower energies.

    Parameters
    ----------
    case : the case
    energies : J, of perturbations of the start in random directions, ascending
    n_starts : number of starts at each energy
    start : as in `outcome`
    horizon : s, longest simulated time of a motion
    seed : whole number that determines the directions
    attractor_tol : relative difference of ranges at which a motion counts as having come to a known attractor; 0 to
        follow each to the horizon
    n_bisection_directions : number of directions in which the critical energy is bisected
    precision : relative precision of the critical energy
    confidence : level of the confidence intervals of fractions
    max_attractors : number of attractors that the dataset has room for
    tol : as in `simulate`
    progress : whether a bar on standard error shows how many starts are done; the bisection follows

    Returns
    -------
    xarray.Dataset
        `basin_fraction` by class of attractor with its confidence interval, `critical_energy` (J), and the attractors.
        Of each start `kind` says what it comes to, and `lost_contact` whether contact was lost on the way, also where
        the outcome is undecided: "yes", "no", or "not_yet" if the motion was followed only until it was known to come
        to an attractor on which contact is lost. Undecided starts count as separating at the upper ends of intervals,
        as not separating at the lower ones, and `separating_fraction` is of the other starts; the attribute `message`
        counts the starts that are undecided within the horizon

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> found = dm.basins(dm.Parameters(N=385, Omega=14), [1e-4, 0.1], 3, horizon=60)
    >>> found["kind"].values.tolist()
    [['stick_slip', 'stick_slip', 'stick_slip'], ['separating', 'separating', 'separating']]
    >>> axes = dm.plot_sweep(found)
    """
    options: dict[str, Any] = {
        "energies": np.atleast_1d(energies).tolist(),
        "n_starts": n_starts,
        "horizon": horizon,
        "seed": seed,
        "attractor_tol": attractor_tol,
        "n_bisection_directions": n_bisection_directions,
        "precision": precision,
        "confidence": confidence,
        "max_attractors": max_attractors,
        "tol": tol,
    }
    return compute_quantity("basins", case, options, start, progress=progress)


@renamed(scan="bounds")
@with_known_names
def hysteresis(
    case: Parameters,
    bounds: tuple[float, float],
    dwell: float | str,
    *,
    name: str = "Omega",
    step: float | str = 1.0,
    max_dwell: float | str = 480.0,
    evaluation_time: float = 5.0,
    tol: float = 1e-10,
) -> xr.Dataset:
    """Sweep the speed or another number of a case up and down, continuing the same motion, and describe it at
    each value.

    Parameters
    ----------
    case : the case; its own value of what is swept is not used
    bounds : the lowest and the highest value, of the speed in rad/s
    dwell : s at each value; doubled until the motion has settled
    name : what is swept: the speed, or another number of the case that leaves the shapes of the modes as they are,
        such as ``N``, ``mu_s`` or ``k_p``. The height over static equilibrium goes on where a value changes this
    step : between values, in the unit of what is swept
    max_dwell : s, longest stay at a value
    evaluation_time : s, the last stretch of a stay, which is described
    tol : as in `simulate`

    Returns
    -------
    xarray.Dataset
        `onset_speed`, `offset_speed` (rad/s): the first speed with separation on the way up, and the lowest one to
        which it persists on the way down. They are nan where the bounds do not show them, such as where contact is
        still lost at the lower bound; the attribute `message` says why, and where a motion in contact had not
        settled (`sweep_settled`): the onset may then be lower, with a longer `max_dwell`. `separation_rate` (1/s),
        `stay` (s), which is the length of the stay, and others by direction and speed. Of another number than the
        speed, such as N, they are `onset` and `offset` in its unit, and its values are `sweep_N`

    Raises
    ------
    ParameterError
        If an argument breaks a rule; the message names the argument, its value and the rule.

    Examples
    --------
    >>> import disc_model as dm
    >>> sweep = dm.hysteresis(dm.Parameters(N=385, Omega=14), (14, 16), dwell=20, max_dwell=80)
    >>> sweep["onset_speed"].item(), sweep["separation_rate"].dims
    (16.0, ('direction', 'sweep_Omega'))
    """
    is_speed = isinstance(name, str) and name == SPEED
    scan = _scan(bounds, step) if is_speed else scan_along(case, name, bounds, step)
    options = {
        "scan": scan,
        "dwell": dwell,
        "max_dwell": max_dwell,
        "evaluation_time": evaluation_time,
        "tol": tol,
    }
    if is_speed:
        return _with_reasons(compute_quantity("hysteresis", case, options))
    prepare = methodcaller("go_along", name)
    found = _with_reasons(compute_quantity("hysteresis", case, options, prepare=prepare), name)
    return named_along(found, name)


def _with_reasons(sweep: xr.Dataset, name: str = SPEED) -> xr.Dataset:
    """A sweep up and down whose message says why it has no onset or no end of separation, and where
    contact may yet be lost, unless it says what went wrong."""
    if sweep.attrs["message"]:
        return sweep
    values = sweep["sweep_Omega"].values
    swept = "speeds" if name == SPEED else f"values of {name}"
    lowest = value_along(name, f"{values[0]:g}")
    highest = value_along(name, f"{values[-1]:g}")
    if not (sweep["separation_rate"] > 0).any():
        span = f"from {values[0]:g} to {values[-1]:g}{unit_along(name)}"
        reason = f"contact is kept at all {values.size} {swept} {span}"
        return sweep.assign_attrs(message="; ".join([reason, *_doubts_of_contact(sweep, name)]))

    speeds = swept_speeds(sweep)
    reasons = []
    if speeds.onset_at_bound:
        reasons.append(f"contact is lost on the way up from the lower bound on, {lowest}")
    elif speeds.onset.isnull():
        reasons.append(f"contact is kept on the way up to {highest}")
    if speeds.end_at_bound:
        reasons.append(f"contact is still lost on the way down at the lower bound, {lowest}")
    elif speeds.end.isnull():
        reasons.append(f"contact is kept at {highest}, where the way down begins")
    if speeds.onset_at_bound or speeds.end_at_bound:
        reasons.append("bounds further down may show where it is kept")
    reasons += _doubts_of_contact(sweep, name)
    return sweep.assign_attrs(message="; ".join(reasons))


def _doubts_of_contact(sweep: xr.Dataset, name: str) -> list[str]:
    """Where a motion in contact had not settled when its stay ended, in words."""
    doubtful = doubtful_contact(sweep)
    doubts = []
    for direction in ("up", "down"):
        speeds = sweep["sweep_Omega"].values[doubtful.sel(direction=direction).values]
        if speeds.size:
            at = ", ".join(f"{speed:g}" for speed in speeds[:3])
            more = f" and {speeds.size - 3} more" if speeds.size > 3 else ""
            doubts.append(f"at {value_along(name, at + more)} on the way {direction}")
    if not doubts:
        return []
    where = " and ".join(doubts)
    return [f"{where} the motion in contact has not settled and may yet separate: raise max_dwell"]
