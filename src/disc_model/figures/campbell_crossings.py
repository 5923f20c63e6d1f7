"""What a Campbell diagram says of the crossings of its study."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.display import counted
from disc_model.figures.drawing import sample
from disc_model.figures.types import Artist

SYMBOLS = ("$f_s$", "$f_Ω$")
"""Of the frequencies whose multiples modes meet: of stick-slip, and of the drive."""


def meeting_of(crossing: xr.Dataset) -> tuple[float, float]:
    """Speed and frequency at which a mode meets a multiple, rad/s and Hz."""
    return float(crossing["crossing_Omega"]), float(crossing["crossing_frequency"])


def multiple_text(crossing: xr.Dataset) -> str:
    """The multiple of a frequency that a mode meets."""
    return f"{float(crossing['crossing_multiple']):g} {symbol_of_line(crossing)}"


def symbol_of_line(crossing: xr.Dataset) -> str:
    """The symbol of the frequency of which a mode meets a multiple."""
    by_slips = flag_names(crossing["crossing_line"]) == "stick_slip"
    return SYMBOLS[0 if by_slips else 1]


def entries_of_unresolved(studies: Sequence[xr.Dataset]) -> list[Artist]:
    """The entry of a legend for crossings at which it is not known what growth rates do, if there are
    any; where these are most of them, the steps are too wide."""
    every = sum(int(_are_there(study).sum()) for study in studies)
    unresolved = sum(unresolved_crossings(study) for study in studies)
    if not unresolved:
        return []
    label = f"{counted(unresolved, 'crossing')} unresolved"
    if unresolved < every:
        label = f"{unresolved} of {counted(every, 'crossing')} unresolved"
    if 2 * unresolved > every:
        label = f"{label}: smaller steps"
    return [sample(label=label, linestyle="")]


def unresolved_crossings(study: xr.Dataset) -> int:
    """The number of crossings at which it is not known what growth rates do."""
    if "crossing_effect" not in study:
        return 0
    return int((_are_there(study) & (flag_names(study["crossing_effect"]) == "unresolved")).sum())


def _are_there(study: xr.Dataset) -> np.ndarray:
    """Places of the table of crossings that have one."""
    if "crossing_Omega" not in study:
        return np.zeros(0, dtype=bool)
    return np.isfinite(study["crossing_Omega"].values)
