"""Speeds at which separation begins and ends on sweeps of the speed, and where a sweep does not
show them, because contact is lost at its lowest speed."""

from typing import NamedTuple

import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.mode_units import column_of
from disc_model.parameters import RATIOS, Parameters

SPEED = "Omega"
"""The number along which sweeps go unless another one is asked for."""
ONSETS = ("onset_speed", "onset")
"""Names of the value at which separation begins: of the speed, and of another number,"""
ENDS = ("offset_speed", "offset")
"""and of that at which it ends, in the same order."""


class SweptSpeeds(NamedTuple):
    """Speeds of a study of sweeps (rad/s), nan where there are none, by its further axes.

    onset, end : at which separation begins on the way up and ends on the way down; the lowest speed
        where contact is lost there already, or still
    onset_at_bound, end_at_bound : bool, whether contact is, so that the speed is the given one or
        a lower one
    onset_unsettled, end_unsettled : bool, whether the speed, or that there is none, rests on a stay
        in contact that ended before the motion had settled: a longer one may give another speed
    """

    onset: xr.DataArray
    end: xr.DataArray
    onset_at_bound: xr.DataArray
    end_at_bound: xr.DataArray
    onset_unsettled: xr.DataArray
    end_unsettled: xr.DataArray


def swept_speeds(sweep: xr.Dataset) -> SweptSpeeds:
    """Return the speeds of a study of the quantity `hysteresis`, or the values of another number that it
    sweeps, with its lower bound for those that are there or below."""
    apart = sweep["separation_rate"] > 0
    rising = apart.sel(direction="up", drop=True)
    falling = apart.sel(direction="down", drop=True)
    name = number_swept(sweep)
    onset, end = edges_along(name)
    speeds = sweep[f"sweep_{name}"]
    along = str(speeds.dims[-1])  # another one than the speed where sweeps have different speeds
    begins_at_bound = rising.isel({along: 0}, drop=True)
    persists_to_bound = (falling | speeds.isnull()).all(along)
    lowest = speeds.min(along)
    begins = sweep[onset].where(~begins_at_bound, lowest)
    doubtful = doubtful_contact(sweep)
    before_onset = (speeds < begins) | begins.isnull()
    doubtful_up = doubtful.sel(direction="up", drop=True) & before_onset
    first_kept = speeds.where(~falling).max(along)
    doubtful_down = doubtful.sel(direction="down", drop=True) & (speeds == first_kept)
    return SweptSpeeds(
        onset=begins,
        end=sweep[end].where(~persists_to_bound, lowest),
        onset_at_bound=begins_at_bound,
        end_at_bound=persists_to_bound,
        onset_unsettled=doubtful_up.any(along),
        end_unsettled=doubtful_down.any(along),
    )


def edges_along(name: str) -> tuple[str, str]:
    """The names of the values at which separation begins and ends along sweeps of a number."""
    place = 0 if name == SPEED else 1
    return ONSETS[place], ENDS[place]


def number_swept(study: xr.Dataset) -> str:
    """The number of the case along which sweeps up and down of a study go; "" if it has none."""
    for variable in map(str, study.variables):
        name = variable.removeprefix("sweep_")
        is_number = name in (*Parameters.model_fields, *RATIOS) or column_of(name)
        if name != variable and is_number:
            return name
    return ""


def doubtful_contact(sweep: xr.Dataset) -> xr.DataArray:
    """Stays at whose end contact was kept by a motion that had not settled, bool: it may yet be lost.
    None where a sweep does not say what has settled."""
    kept = sweep["separation_rate"] == 0
    if "sweep_settled" not in sweep:
        return xr.zeros_like(kept)
    return kept & ~has_settled(sweep)


def has_settled(sweep: xr.Dataset) -> xr.DataArray:
    """Whether it is shown that the motion of each stay of a sweep had settled at its end, bool."""
    settled = sweep["sweep_settled"]
    return settled.copy(data=flag_names(settled) == "settled")
