"""Speeds at which separation begins and ends on sweeps of the speed."""

from typing import NamedTuple

import xarray as xr


class SweptSpeeds(NamedTuple):
    """Speeds of a study of sweeps (rad/s), nan where there are none, by its further axes: those at which
    separation begins on the way up and ends on the way down, the lowest speed where contact is lost there
    already, or still."""

    onset: xr.DataArray
    end: xr.DataArray


def swept_speeds(sweep: xr.Dataset) -> SweptSpeeds:
    """The speeds of a study of the quantity `hysteresis`."""
    apart = sweep["separation_rate"] > 0
    rising = apart.sel(direction="up", drop=True)
    falling = apart.sel(direction="down", drop=True)
    speeds = sweep["sweep_Omega"]
    along = str(speeds.dims[-1])  # another one than the speed where sweeps have different speeds
    lowest = speeds.min(along)
    begins_at_bound = rising.isel({along: 0}, drop=True)
    persists_to_bound = (falling | speeds.isnull()).all(along)
    return SweptSpeeds(
        onset=sweep["onset_speed"].where(~begins_at_bound, lowest),
        end=sweep["offset_speed"].where(~persists_to_bound, lowest),
    )
