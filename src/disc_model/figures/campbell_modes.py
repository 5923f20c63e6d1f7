"""The lines of the modes of steady sliding in a Campbell diagram."""

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.campbell_looks import growing_look
from disc_model.figures.campbell_peaks import growing_modes
from disc_model.figures.drawing import BLACK, large, say_beside, wide
from disc_model.figures.names import named_modes
from disc_model.figures.types import Axes

NAMES_APART = 0.045  # of the axis, least distance of the names of modes


def draw_modes(ax: Axes, study: xr.Dataset, highest: float) -> None:
    """Draw the frequencies of steady sliding's modes, thick and in a colour where they grow, with
    names at the right ends of those that are shown."""
    frequency = study["sliding_frequency"]
    ax.plot(study["Omega"], frequency, color=BLACK, linewidth=wide(0.9))
    grows = growing_modes(study)
    for mode in np.flatnonzero(grows.any("Omega")):
        thick = frequency.where(grows).isel(mode=mode)
        ax.plot(study["Omega"], thick, **growing_look())
    ends = study.isel(Omega=-1)
    of_disc = np.where(flag_names(ends["mode_kind"]) == "disc", ends["diameters"].values, -1)
    heights = ends["sliding_frequency"].where(ends["sliding_frequency"] <= highest).values
    for part in named_modes(of_disc, heights, NAMES_APART * highest):
        height = float(heights[part.modes].mean())
        say_beside(ax, height, part.name, 3, fontsize=large(7))
