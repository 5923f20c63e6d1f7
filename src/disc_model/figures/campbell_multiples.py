"""Multiples of the stick-slip frequency that a reader asks for in a Campbell diagram."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.campbell_crossings import SYMBOLS, UNKNOWN, meeting_of
from disc_model.figures.campbell_looks import CROSSINGS, crossing_look, multiple_look
from disc_model.figures.campbell_peaks import Column, followed_frequency
from disc_model.figures.drawing import halo, large, sample
from disc_model.figures.types import Artist, Axes, Mask

ABOVE_MODES = 2.5  # zorder of multiples, which may lie on the thick line of a mode
NAMES_APART = 0.12  # distance of the places of two names, over the range of speeds
NAMES_BESIDE = 3  # such places


def draw_multiples(ax: Axes, study: xr.Dataset, multiples: Sequence[int], highest: float) -> None:
    """Draw multiples of the stick-slip frequency over the speed, with their names, and marks where
    modes cross them, up to the highest frequency shown (Hz)."""
    releases = followed_frequency(study)
    for place, multiple in enumerate(multiples):
        line = multiple * releases
        ax.plot(study["Omega"], line, zorder=ABOVE_MODES, **multiple_look())
        _name_line(ax, line, f"{multiple} {SYMBOLS[0]}", place, highest)
    for effect, at_effect in _by_effect(study, multiples, highest).items():
        speeds = study["crossing_Omega"].values[at_effect]
        frequencies = study["crossing_frequency"].values[at_effect]
        ax.plot(speeds, frequencies, **crossing_look(effect))


def _name_line(ax: Axes, line: xr.DataArray, name: str, place: int, highest: float) -> None:
    """Write the name of a multiple on its line, near the last speed at which it is shown; names of lines
    that may be near each other stand at different places."""
    shown = np.flatnonzero(line.values <= highest)
    if not shown.size:
        return
    speeds = line["Omega"].values[shown]
    back = NAMES_APART * (place % NAMES_BESIDE) * np.ptp(speeds)
    at = shown[np.abs(speeds - (speeds.max() - back)).argmin()]
    anchor = (float(line["Omega"][at]), float(line[at]))
    look: dict[str, Any] = {"ha": "right", "va": "center", "fontsize": large(6)}
    ax.annotate(name, anchor, (-2, 0), textcoords="offset points", path_effects=halo(), **look)


def entries_of_crossings(
    studies: Sequence[xr.Dataset], multiples: Sequence[int], highest: float
) -> list[Artist]:
    """Entries of a legend for crossings of multiples that a reader asks for, by their effects."""
    effects = set[str]()
    for study in studies:
        effects |= {*_by_effect(study, multiples, highest)}
    handles: list[Artist] = []
    for effect, (_, meaning) in CROSSINGS.items():
        if effect in effects:
            handles.append(sample(label=f"crossing: {meaning}", **crossing_look(effect)))
    return handles


def unmarked_crossings(columns: Sequence[Column], multiples: Sequence[int], highest: float) -> int:
    """The number of crossings of known effect up to the highest frequency shown (Hz) that the picture does
    not mark."""
    return sum(_unmarked_crossings(column, multiples, highest) for column in columns)


def _unmarked_crossings(column: Column, multiples: Sequence[int], highest: float) -> int:
    """The number of crossings of known effect up to the highest frequency shown (Hz) that are neither at a
    peak nor of a multiple that a reader asks for."""
    study = column.study
    if "crossing_effect" not in study:
        return 0
    speeds = study["crossing_Omega"].values
    frequencies = study["crossing_frequency"].values
    known = ~np.isin(flag_names(study["crossing_effect"]), UNKNOWN)
    unmarked = known & (frequencies <= highest)
    for marked in _by_effect(study, multiples, highest).values():
        unmarked &= ~marked
    for peak in column.peaks:
        if peak.crossing is not None:
            speed, frequency = meeting_of(peak.crossing)
            unmarked &= (speeds != speed) | (frequencies != frequency)
    return int(unmarked.sum())


def _by_effect(study: xr.Dataset, multiples: Sequence[int], highest: float) -> dict[str, Mask]:
    """Crossings of multiples that are shown, by what growth rates do there."""
    if not multiples or "crossing_effect" not in study:
        return {}
    of_slips = flag_names(study["crossing_line"]) == "stick_slip"
    asked_for = np.isin(study["crossing_multiple"].values, multiples)
    shown = of_slips & asked_for & (study["crossing_frequency"].values <= highest)
    effects = flag_names(study["crossing_effect"])
    found = {}
    for effect in CROSSINGS:
        at_effect = shown & (effects == effect)
        if at_effect.any():
            found[effect] = at_effect
    return found
