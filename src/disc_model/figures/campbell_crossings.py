"""The crossings of a Campbell diagram: where they are, and of which multiple."""

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.types import Array

SYMBOLS = ("$f_s$", "$f_Ω$")
"""Of the frequencies whose multiples modes meet: of stick-slip, and of the drive."""


def meeting_of(crossing: xr.Dataset) -> tuple[float, float]:
    """Speed and frequency at which a mode meets a multiple, rad/s and Hz."""
    return float(crossing["crossing_Omega"]), float(crossing["crossing_frequency"])


def places_of(study: xr.Dataset) -> Array:
    """Speeds and frequencies of all crossings, rad/s and Hz, shape (n, 2)."""
    return np.column_stack([study["crossing_Omega"], study["crossing_frequency"]])


def multiple_text(crossing: xr.Dataset) -> str:
    """The multiple of a frequency that a mode meets."""
    return f"{float(crossing['crossing_multiple']):g} {symbol_of_line(crossing)}"


def is_of_slips(crossing: xr.Dataset) -> bool:
    """Whether a mode meets a multiple of the stick-slip frequency, and not of that of the drive."""
    return bool(flag_names(crossing["crossing_line"]) == "stick_slip")


def symbol_of_line(crossing: xr.Dataset) -> str:
    """The symbol of the frequency of which a mode meets a multiple."""
    return SYMBOLS[0 if is_of_slips(crossing) else 1]
