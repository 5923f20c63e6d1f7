"""Starts whose outcome is not known, on which shares and critical energies of basins rest. Nothing here
draws."""

import xarray as xr

from disc_model.data.variables import UNKNOWN_OUTCOMES, flag_names

OF_STARTS = (
    "separating_fraction",
    "separating_fraction_low",
    "separating_fraction_high",
    "critical_energy",
    "critical_energy_lower",
    "critical_energy_sampled",
)
"""Variables that rest on what all starts of a point come to."""


def with_starts_of(
    study: xr.Dataset, variable: str, outcomes: tuple[str, ...] = UNKNOWN_OUTCOMES
) -> xr.DataArray | None:
    """Points at which some starts have one of several outcomes; None of variables that do not rest on
    all starts."""
    if variable not in OF_STARTS or not {"kind", variable} <= {*study}:
        return None
    kinds = study["kind"].copy(data=flag_names(study["kind"]))
    of_starts = [dim for dim in kinds.dims if dim not in study[variable].dims]
    return kinds.isin(outcomes).any(of_starts)


def rest_on_unknown(study: xr.Dataset, variable: str) -> xr.DataArray | None:
    """Points whose value rests on starts some of which are of unknown outcome; None of variables that do
    not rest on all starts."""
    unknown = with_starts_of(study, variable)
    return None if unknown is None else unknown & study[variable].notnull()


def class_of_starts(study: xr.Dataset, variable: str) -> xr.DataArray | None:
    """The outcome, of those that are not known, that some starts of each point have, "" without one;
    None of variables that do not rest on all starts."""
    undecided = with_starts_of(study, variable, ("undecided",))
    failed = with_starts_of(study, variable, ("failed",))
    if undecided is None or failed is None:
        return None
    words = xr.where(failed, "failed", "")
    return xr.where(undecided, "undecided", words)
