"""Speeds at which separation begins and ends on sweeps of the speed, and where a sweep does not
show them, because contact is lost at its lowest speed."""

from typing import NamedTuple

import xarray as xr

from disc_model.data.variables import flag_names

SPEED = "Omega"
"""The number along which sweeps go unless another one is asked for."""


class SweptSpeeds(NamedTuple):
    """Speeds of a study of sweeps (rad/s), nan where there are none, by its further axes.

    onset, end : at which separation begins on the way up and ends on the way down; the lowest speed
        where contact is lost there already, or still
    onset_at_bound, end_at_bound : bool, whether contact is, so that the speed is the given one or
        a lower one
    """

    onset: xr.DataArray
    end: xr.DataArray
    onset_at_bound: xr.DataArray
    end_at_bound: xr.DataArray


def swept_speeds(sweep: xr.Dataset) -> SweptSpeeds:
    """The speeds of a study of the quantity `hysteresis`, or the values of another number that it
    sweeps, with its lower bound for those that are there or below."""
    apart = sweep["separation_rate"] > 0
    rising = apart.sel(direction="up", drop=True)
    falling = apart.sel(direction="down", drop=True)
    by_speed = "onset_speed" in sweep
    onset, end = edges_along(SPEED if by_speed else "")
    along = next(str(dim) for dim in rising.dims if str(dim).startswith("sweep_"))
    speeds = sweep[along]
    lowest = speeds.min(along)
    begins_at_bound = rising.isel({along: 0}, drop=True)
    persists_to_bound = falling.all(along)
    return SweptSpeeds(
        onset=sweep[onset].where(~begins_at_bound, lowest),
        end=sweep[end].where(~persists_to_bound, lowest),
        onset_at_bound=begins_at_bound,
        end_at_bound=persists_to_bound,
    )


def edges_along(name: str) -> tuple[str, str]:
    """The names of the values at which separation begins and ends along sweeps of a number."""
    if name == SPEED:
        return "onset_speed", "offset_speed"
    return "onset", "offset"


def doubtful_contact(sweep: xr.Dataset) -> xr.DataArray:
    """Stays at whose end contact was kept by a motion that had not settled, bool: it may yet be lost."""
    settled = sweep["sweep_settled"]
    unsettled = settled.copy(data=flag_names(settled) != "settled")
    return (sweep["separation_rate"] == 0) & unsettled
