"""Speeds at which separation begins and ends on sweeps of the speed, and where a sweep does not
show them, because contact is lost at its lowest speed."""

from typing import NamedTuple

import xarray as xr


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
    """Return the speeds of a study of the quantity `hysteresis`, with its lower bound for speeds
    that are there or below."""
    apart = sweep["separation_rate"] > 0
    rising = apart.sel(direction="up", drop=True)
    falling = apart.sel(direction="down", drop=True)
    begins_at_bound = rising.isel(sweep_Omega=0, drop=True)
    persists_to_bound = falling.all("sweep_Omega")
    lowest = float(sweep["sweep_Omega"].min())
    return SweptSpeeds(
        onset=sweep["onset_speed"].where(~begins_at_bound, lowest),
        end=sweep["offset_speed"].where(~persists_to_bound, lowest),
        onset_at_bound=begins_at_bound,
        end_at_bound=persists_to_bound,
    )
