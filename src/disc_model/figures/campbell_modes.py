"""The lines of the modes of steady sliding in a Campbell diagram."""

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.campbell_looks import growing_look
from disc_model.figures.campbell_peaks import growing_modes
from disc_model.figures.drawing import BLACK, large, wide
from disc_model.figures.end_names import EndNames, most_names
from disc_model.figures.growing_parts import growing_part
from disc_model.figures.names import Named, named_modes
from disc_model.figures.types import Array, Axes

NAMES_APART = 0.045  # of the axis, distance of modes up to which they share a name
FURTHER = 1.2  # ratio by which this distance grows until all names have room


def draw_modes(ax: Axes, study: xr.Dataset, highest: float) -> None:
    """Draw the frequencies of steady sliding's modes, thick and in a colour where they grow, with
    names at the right ends of those that are shown."""
    frequency = study["sliding_frequency"]
    ax.plot(study["Omega"], frequency, color=BLACK, linewidth=wide(0.9))
    for mode in np.flatnonzero(growing_modes(study).any("Omega")):
        _draw_growing(ax, study.isel(mode=mode))
    ends = study.isel(Omega=-1)
    of_disc = np.where(flag_names(ends["mode_kind"]) == "disc", ends["diameters"].values, -1)
    heights = ends["sliding_frequency"].where(ends["sliding_frequency"] <= highest).values
    size = large(7)
    names = EndNames(ax, size)
    for part in _names_with_room(of_disc, heights, highest, most_names(ax, size)):
        names.add(part.name, float(heights[part.modes].mean()))


def _draw_growing(ax: Axes, mode: xr.Dataset) -> None:
    """Draw the frequency of a mode where it grows, with dots at the computed speeds."""
    speeds = mode["Omega"].values
    frequency = mode["sliding_frequency"]
    look = growing_look()
    part = growing_part(speeds, mode["sliding_growth_rate"].values, frequency.values)
    ax.plot(*part, **look | {"marker": ""})
    ax.plot(speeds, frequency.where(growing_modes(mode)), **look | {"linestyle": ""})


def _names_with_room(diameters: Array, heights: Array, highest: float, most: int) -> list[Named]:
    """The names of modes that end at these heights, at most so many."""
    apart = NAMES_APART * highest
    parts = [*named_modes(diameters, heights, apart)]
    while len(parts) > most:
        apart *= FURTHER
        parts = [*named_modes(diameters, heights, apart)]
    return parts
