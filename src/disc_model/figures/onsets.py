"""Onsets of separation over speed and preload, and how those at neighbouring loads belong together.
Nothing here draws.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.types import Array, Mask


class Link(NamedTuple):
    """Two crossings at neighbouring loads that are joined: index of the lower load, the speed
    there, and the next."""

    load: int
    speed: float
    ahead: float


def speeds_of(study: xr.Dataset, horizon: float, kind: str = "begins") -> list[Array]:
    """Rising speeds, rad/s, at which separation begins (or the scan begins with it), or ends, for
    each load."""
    of_horizon = study.sel(horizon=horizon).transpose("N", ..., "crossing_number")
    kinds = flag_names(of_horizon["crossing_kind"])
    first = of_horizon["critical_speed"].where(kind == "begins")
    return rising_rows(first.values, of_horizon["crossing"].values, kinds == kind)


def rising_rows(first: Array, crossings: Array, chosen: Mask) -> list[Array]:
    """Rising speeds of each point: its first one, and the chosen ones of its crossings, (points, most)."""
    speeds = np.where(chosen, crossings, np.nan)
    rows = np.column_stack([first, speeds])
    return [np.unique(row[np.isfinite(row)]) for row in rows]


def branches(speeds: Sequence[Array], ends: Sequence[Iterable[float]]) -> list[Link]:
    """Nearest crossings at neighbouring loads, if no end is between."""
    links = []
    for i, (current, ahead) in enumerate(pairwise(speeds)):
        if not (current.size and ahead.size):
            continue
        for j, k in np.argwhere(_nearest(current, ahead)):
            link = Link(i, float(current[j]), float(ahead[k]))
            higher = ends[i + (link.speed > link.ahead)]
            if not any((end - link.speed) * (end - link.ahead) < 0 for end in higher):
                links.append(link)
    return links


def _nearest(current: Array, ahead: Array) -> Mask:
    """Pairs of speeds that are nearest to each other; as they are rounded, two may be as near."""
    apart = np.abs(current[:, None] - ahead[None, :])
    from_ahead = np.isclose(apart, apart.min(0), rtol=1e-9)
    from_current = np.isclose(apart, apart.min(1)[:, None], rtol=1e-9)
    return from_ahead & from_current
