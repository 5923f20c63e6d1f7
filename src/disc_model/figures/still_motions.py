"""Motions that have died away: what is left of them is drawn as a flat line, or as one point."""

import json
from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.least_span import MARGIN
from disc_model.figures.types import Array, Axes

STILL = 1e-6
"""Span of a variable over its size below which it stands still."""


def size_of(variable: str, case: xr.DataTree) -> float:
    """The size of a variable that is small where a motion stands still, by the drive of its case, in SI
    units; 0 of one whose own values tell it, such as a force."""
    if not variable.endswith("_velocity"):
        return 0.0
    values: dict[str, Any] = json.loads(case.attrs.get("parameters", "{}"))
    speed = abs(values.get("Omega") or 0.0)
    if variable == "psi_velocity":
        return speed
    radius = values.get("r_0")
    return 0.0 if radius is None else speed * radius


def ends_shown(values: Array, size: float) -> tuple[float, float]:
    """The least and the greatest of values that an axis shows: more than their own where they hardly
    differ, in comparison with their own size or another one that is greater."""
    low = float(np.nanmin(values))
    high = float(np.nanmax(values))
    size = max(abs(low), abs(high), size)
    if high - low > STILL * size:
        return low, high
    middle = (low + high) / 2
    return middle - MARGIN * size, middle + MARGIN * size


def is_still(values: Array, size: float) -> bool:
    """Whether values hardly differ in comparison with a size."""
    low, high = ends_shown(values, size)
    return bool(low < np.nanmin(values) or low == high)


def show_ends(ax: Axes, across: Array, upward: Array) -> None:
    """Let axes whose limits follow what is drawn show these ends as well."""
    ax.update_datalim(np.column_stack([across, upward]))
    ax.autoscale_view()
