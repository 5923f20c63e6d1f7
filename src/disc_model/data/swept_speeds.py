"""Speeds at which separation begins and ends on sweeps of the speed, and where a sweep does not
show them, because contact is lost at its lowest speed."""

from typing import NamedTuple

import xarray as xr

from disc_model.data.variables import flag_names


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
    """Return the speeds of a study of the quantity `hysteresis`, with its lower bound for speeds
    that are there or below."""
    apart = sweep["separation_rate"] > 0
    rising = apart.sel(direction="up", drop=True)
    falling = apart.sel(direction="down", drop=True)
    speeds = sweep["sweep_Omega"]
    along = str(speeds.dims[-1])  # another one than the speed where sweeps have different speeds
    begins_at_bound = rising.isel({along: 0}, drop=True)
    persists_to_bound = (falling | speeds.isnull()).all(along)
    lowest = speeds.min(along)
    onset = sweep["onset_speed"].where(~begins_at_bound, lowest)
    doubtful = doubtful_contact(sweep)
    before_onset = (speeds < onset) | onset.isnull()
    doubtful_up = doubtful.sel(direction="up", drop=True) & before_onset
    first_kept = speeds.where(~falling).max(along)
    doubtful_down = doubtful.sel(direction="down", drop=True) & (speeds == first_kept)
    return SweptSpeeds(
        onset=onset,
        end=sweep["offset_speed"].where(~persists_to_bound, lowest),
        onset_at_bound=begins_at_bound,
        end_at_bound=persists_to_bound,
        onset_unsettled=doubtful_up.any(along),
        end_unsettled=doubtful_down.any(along),
    )


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
