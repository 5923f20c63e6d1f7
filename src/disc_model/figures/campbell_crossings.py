"""What a Campbell diagram says of the crossings of its study."""

import math
from collections.abc import Sequence

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.display import counted
from disc_model.figures.drawing import sample
from disc_model.figures.types import Array, Artist, Mask

SYMBOLS = ("$f_s$", "$f_Ω$")
"""Of the frequencies whose multiples modes meet: of stick-slip, and of the drive."""
MANY_TIMES = 10  # from which ratio of the steps that crossings need two are named
UNKNOWN = ("unresolved", "beyond_scan")
"""Effects of crossings at which it is not known what growth rates do."""


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


def entries_of_counts(studies: Sequence[xr.Dataset], unmarked: int) -> list[Artist]:
    """The entry of a legend that counts crossings: so many without a mark, and those at which it is not
    known what growth rates do, with the remedy: smaller steps, or a wider scan."""
    every = sum(int(_are_there(study).sum()) for study in studies)
    unresolved = _count_of(studies, "unresolved")
    beyond = _count_of(studies, "beyond_scan")
    said = []
    if unmarked:
        said.append(f"{_share_of(unmarked, every)} not marked")
    if unresolved:
        said.append(f"{_share_of(unresolved, every)} {_steps_needed(studies, unresolved)}")
    if beyond:
        said.append(f"{_share_of(beyond, every)} {_needs(beyond)} a wider scan")
    if not said:
        return []
    lines = ",\n".join(said)
    return [sample(label=f"{counted(every, 'crossing')}: {lines}", linestyle="")]


def _share_of(count: int, every: int) -> str:
    """How many of all crossings, as a word where these are all of several."""
    return "all" if count == every > 1 else str(count)


def _needs(count: int) -> str:
    """The verb of so many crossings."""
    return "needs" if count == 1 else "need"


def _steps_needed(studies: Sequence[xr.Dataset], count: int) -> str:
    """What the legend says of unresolved crossings: the steps that resolve them, rounded down, for all
    and for the first one where these differ much; nothing of steps that are as small already."""
    steps = [step for study in studies for step in _steps_of(study)]
    if not steps:
        return "unresolved"
    least = f"{rounded_down(min(steps)):g}"
    if max(steps) < MANY_TIMES * min(steps):
        return f"{_needs(count)} steps of {least} rad/s"
    return f"{_needs(count)} steps of\n{least} to {rounded_down(max(steps)):g} rad/s"


def _steps_of(study: xr.Dataset) -> Array:
    """Steps by which unresolved crossings are resolved, as far as they are smaller than those of the study."""
    if "crossing_step" not in study:
        return np.zeros(0)
    steps = study["crossing_step"].values[_has_effect(study, "unresolved")]
    widest = np.diff(study["Omega"].values).max()
    return steps[steps < widest]


def rounded_down(value: float) -> float:
    """A positive number with one significant digit, not above the value."""
    unit = 10.0 ** math.floor(math.log10(value))
    return math.floor(value / unit) * unit


def _count_of(studies: Sequence[xr.Dataset], effect: str) -> int:
    """The number of crossings of an effect."""
    return sum(int(_has_effect(study, effect).sum()) for study in studies)


def _has_effect(study: xr.Dataset, effect: str) -> Mask:
    """Places of the table of crossings that have one of this effect."""
    there = _are_there(study)
    if "crossing_effect" not in study:
        return np.zeros_like(there)
    return there & (flag_names(study["crossing_effect"]) == effect)


def _are_there(study: xr.Dataset) -> Mask:
    """Places of the table of crossings that have one."""
    if "crossing_Omega" not in study:
        return np.zeros(0, dtype=bool)
    return np.isfinite(study["crossing_Omega"].values)
