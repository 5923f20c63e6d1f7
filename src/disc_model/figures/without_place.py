"""Points of lines that have no place along the axis, as rows of a table with an empty cell."""

import numpy as np
import xarray as xr

from disc_model.data.variables import typeset
from disc_model.figures import legend_samples
from disc_model.figures.types import Axes
from disc_model.figures.words import named

NOTE = f"{legend_samples.NOTE}: without a place"
"""What matplotlib calls the entry of a legend that says it."""


def say_without_place(ax: Axes, coordinate: xr.DataArray) -> list[str]:
    """Say in the legend how many points of a line are not drawn, since they have no value along the
    horizontal axis. Returns what the legend says of this on these axes."""
    missing = 0
    if coordinate.dtype.kind == "f":
        missing = int(np.isnan(coordinate.values).sum())
    words = f"not drawn: {missing} of {coordinate.size} without {typeset(named(coordinate).name)}"
    if missing and words not in _notes_on(ax):
        ax.plot([], [], linestyle="", label=words, gid=NOTE)
    return _notes_on(ax)


def _notes_on(ax: Axes) -> list[str]:
    """What the legend says of points without a place on axes."""
    return [str(line.get_label()) for line in ax.lines if line.get_gid() == NOTE]
