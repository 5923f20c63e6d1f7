"""Steps of a line of critical speeds from one range of separation to another one."""

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.onsets import branches, rising_rows
from disc_model.figures.selection import parts_along
from disc_model.figures.types import Mask

NEEDED = ("critical_speed", "crossing", "crossing_kind")
"""Variables that say which range of separation a critical speed begins."""


def has_ranges(study: xr.Dataset, variable: str) -> bool:
    """Whether a variable is the critical speed of a scan with all of its crossings."""
    if variable != NEEDED[0] or not {*NEEDED} <= {*study}:
        return False
    return len({*study["crossing"].dims} - {*study[variable].dims}) == 1


def steps_between_ranges(study: xr.Dataset, by: str | None) -> dict[str, Mask]:
    """The steps of each line at which the critical speed goes to another range of separation, as
    figures over speed and preload join them."""
    parts = parts_along(study[[*NEEDED]], by)
    return {part.name: _between_ranges(part.data) for part in parts}


def _between_ranges(line: xr.Dataset) -> Mask:
    """The steps of one line between two known critical speeds that no range joins."""
    first = line["critical_speed"]
    dims = (*first.dims, ...)
    crossings = line["crossing"].transpose(*dims).values
    kinds = flag_names(line["crossing_kind"].transpose(*dims))
    onsets = rising_rows(first.values, crossings, kinds == "begins")
    ends = rising_rows(np.full(first.size, np.nan), crossings, kinds == "ends")
    known = np.isfinite(first.values)
    found = known[:-1] & known[1:]
    for link in branches(onsets, ends):
        here = first.values[link.load : link.load + 2]
        if (link.speed, link.ahead) == tuple(here):
            found[link.load] = False
    return found
