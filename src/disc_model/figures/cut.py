"""The upper edge of a panel of frequencies that is cut: that some go on above it."""

from collections.abc import Sequence
from typing import Any

import xarray as xr

from disc_model.display import counted
from disc_model.figures.drawing import GREY, sample, wide
from disc_model.figures.types import Artist, Axes


def modes_above(frequency: xr.DataArray, highest: float) -> int:
    """The number of modes that have a frequency above the highest shown, Hz."""
    along = [dim for dim in frequency.dims if dim != "mode"]
    return int((frequency > highest).any(along).sum())


def modes_left_out(study: xr.Dataset) -> int:
    """The number of modes for which a study has no room."""
    if "n_modes" not in study:
        return 0
    return max(int(study["n_modes"].max()) - study.sizes["mode"], 0)


def modes_cut(study: xr.Dataset, frequency: str, highest: float) -> int:
    """The number of modes above the highest frequency shown (Hz), with those for which a study has no
    room, which are above all others."""
    above = modes_above(study[frequency], highest)
    return above + modes_left_out(study) if above else 0


def entries_of_left_out(studies: Sequence[xr.Dataset]) -> list[Artist]:
    """The entry of a legend for modes without room, if there are any: how many of how many."""
    left_out = max(modes_left_out(study) for study in studies)
    if not left_out:
        return []
    every = max(int(study["n_modes"].max()) for study in studies)
    return [sample(label=f"{counted(left_out, 'mode')} of {every} not computed", linestyle="")]


def mark_cut(ax: Axes, highest: float) -> None:
    """Draw the upper edge of a panel as a cut."""
    ax.axhline(highest, clip_on=False, zorder=3, **_look())


def entry_of_cut(count: int, highest: float) -> Artist:
    """The entry of a legend for a cut: how many modes have frequencies above it."""
    return sample(label=f"cut at {highest:g} Hz: {counted(count, 'mode')} above", **_look())


def _look() -> dict[str, Any]:
    """Look of the edge."""
    return {"color": GREY, "linewidth": wide(1.8), "linestyle": (0, (4, 1, 1, 1))}
