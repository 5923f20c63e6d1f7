"""Places of a list that has room for more than was found: its counts are 0 there, which is no number
of anything."""

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names

TOLD_BY = {"attractor": "attractor_kind", "crossing": "crossing_line"}
"""The flag that is "none" at places of a dimension beyond what was found."""


def without_padding(study: xr.Dataset) -> xr.Dataset:
    """A study whose counts are missing at places beyond what was found, as its other numbers are."""
    replaced = {}
    for dim, flag in TOLD_BY.items():
        if flag in study and dim in study[flag].dims:
            beyond = study[flag].copy(data=flag_names(study[flag]) == "none")
            replaced.update(_missing_where(beyond, study))
    return study.assign(replaced)


def _missing_where(beyond: xr.DataArray, study: xr.Dataset) -> dict[str, xr.DataArray]:
    """The counts of a study along the dimensions of a mask, missing where it holds."""
    found = {}
    for name, counts in study.data_vars.items():
        is_count = counts.dtype.kind in "iu" and "flag_meanings" not in counts.attrs
        if is_count and counts.dims == beyond.dims:
            values = np.where(beyond.values, np.nan, counts.values)
            found[str(name)] = counts.copy(data=values)
    return found
