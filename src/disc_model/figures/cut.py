"""The upper edge of a panel of frequencies that is cut: that some go on above it."""

from typing import Any

import xarray as xr

from disc_model.display import counted
from disc_model.figures.drawing import GREY, sample, wide
from disc_model.figures.types import Artist, Axes


def modes_above(frequency: xr.DataArray, highest: float) -> int:
    """The number of modes that have a frequency above the highest shown, Hz."""
    along = [dim for dim in frequency.dims if dim != "mode"]
    return int((frequency > highest).any(along).sum())


def mark_cut(ax: Axes, highest: float) -> None:
    """Draw the upper edge of a panel as a cut."""
    ax.axhline(highest, clip_on=False, zorder=3, **_look())


def entry_of_cut(count: int, highest: float) -> Artist:
    """The entry of a legend for a cut: how many modes have frequencies above it."""
    return sample(label=f"cut at {highest:g} Hz: {counted(count, 'mode')} above", **_look())


def _look() -> dict[str, Any]:
    """Look of the edge."""
    return {"color": GREY, "linewidth": wide(1.8), "linestyle": (0, (4, 1, 1, 1))}
