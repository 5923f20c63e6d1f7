"""Multiples of the stick-slip frequency that a reader asks for in a Campbell diagram."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.campbell_crossings import SYMBOLS, UNKNOWN, meeting_of
from disc_model.figures.campbell_looks import CROSSINGS, Crossing, crossing_look, multiple_look
from disc_model.figures.campbell_peaks import Column, followed_frequency, jumps_of
from disc_model.figures.drawing import halo, large, sample
from disc_model.figures.selection import opened
from disc_model.figures.types import Array, Artist, Axes, Indices, Mask

ABOVE_MODES = 2.5  # zorder of multiples, which may lie on the thick line of a mode
NAMES_APART = 0.12  # distance of the places of two names, over the range of speeds
NAMES_BESIDE = 3  # such places of neighbouring lines
MOST_PLACES = 7  # such places that a name may have
CLEAR = 0.04  # of the axis, least distance of a name from modes


def draw_multiples(ax: Axes, column: Column, multiples: Sequence[int], highest: float) -> None:
    """Draw multiples of the stick-slip frequency over the speed, with their names, and marks where
    modes cross them, up to the highest frequency shown (Hz)."""
    study = column.study
    releases = followed_frequency(study)
    for place, multiple in enumerate(multiples):
        line = multiple * releases
        draw_multiple(ax, study, multiple, ABOVE_MODES)
        _name_line(ax, study, line, f"{multiple} {SYMBOLS[0]}", place, highest)
    for crossing, there in _by_mark(column, multiples, highest).items():
        speeds = study["crossing_Omega"].values[there]
        frequencies = study["crossing_frequency"].values[there]
        ax.plot(speeds, frequencies, **crossing_look(crossing))


def draw_multiple(ax: Axes, study: xr.Dataset, multiple: float, zorder: float) -> None:
    """Draw a multiple of the stick-slip frequency over the speed, with gaps where it jumps."""
    line = multiple * followed_frequency(study)
    pieces = opened(study["Omega"].values, line.values, jumps_of(study))
    ax.plot(*pieces, zorder=zorder, **multiple_look())


def _name_line(
    ax: Axes, study: xr.Dataset, line: xr.DataArray, name: str, place: int, highest: float
) -> None:
    """Write the name of a multiple on its line, near the last speed at which it is shown, and clear of
    modes and of the marks on them if it can; names of lines that may be near each other stand at
    different places."""
    shown = np.flatnonzero(line.values <= highest)
    if not shown.size:
        return
    speeds = line["Omega"].values[shown]
    modes = study["sliding_frequency"]
    clearance = abs(modes - line).min("mode").values / highest
    at = _clear_place(shown, speeds, clearance, place % NAMES_BESIDE)
    anchor = (float(line["Omega"][at]), float(line[at]))
    look: dict[str, Any] = {"ha": "right", "va": "center", "fontsize": large(6)}
    ax.annotate(name, anchor, (-2, 0), textcoords="offset points", path_effects=halo(), **look)


def _clear_place(shown: Indices, speeds: Array, clearance: Array, first: int) -> int:
    """The place of a name among those of a line that are shown: the first one back from the end that is
    clear of modes, or else the clearest.

    first : how many places from the end are left to other names
    """
    backs = NAMES_APART * np.ptp(speeds) * np.arange(first, MOST_PLACES)
    nearest = [int(np.abs(speeds - (speeds.max() - back)).argmin()) for back in backs]
    places = shown[nearest]
    clear = places[clearance[places] > CLEAR]
    if clear.size:
        return int(clear[0])
    return int(places[clearance[places].argmax()])


def entries_of_crossings(
    columns: Sequence[Column], multiples: Sequence[int], highest: float
) -> list[Artist]:
    """Entries of a legend for crossings of multiples that a reader asks for, by their marks."""
    found = set[Crossing]()
    for column in columns:
        found |= {*_by_mark(column, multiples, highest)}
    handles: list[Artist] = []
    for crossing in CROSSINGS:
        if crossing in found:
            handles.append(sample(label=f"crossing: {crossing.meaning}", **crossing_look(crossing)))
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
    known = ~np.isin(flag_names(study["crossing_effect"]), UNKNOWN)
    unmarked = known & (study["crossing_frequency"].values <= highest) & ~_at_peaks(column)
    for marked in _by_mark(column, multiples, highest).values():
        unmarked &= ~marked
    return int(unmarked.sum())


def _at_peaks(column: Column) -> Mask:
    """Crossings at peaks of growth, which have the mark of their peak."""
    speeds = column.study["crossing_Omega"].values
    frequencies = column.study["crossing_frequency"].values
    found = np.zeros(speeds.shape, dtype=bool)
    for peak in column.peaks:
        if peak.crossing is not None:
            speed, frequency = meeting_of(peak.crossing)
            found |= (speeds == speed) & (frequencies == frequency)
    return found


def _by_mark(column: Column, multiples: Sequence[int], highest: float) -> dict[Crossing, Mask]:
    """Crossings of multiples that are shown and at no peak, by their marks."""
    study = column.study
    if not multiples or "crossing_effect" not in study:
        return {}
    of_slips = flag_names(study["crossing_line"]) == "stick_slip"
    asked_for = np.isin(study["crossing_multiple"].values, multiples)
    shown = of_slips & asked_for & (study["crossing_frequency"].values <= highest)
    shown &= ~_at_peaks(column)
    effects = flag_names(study["crossing_effect"])
    found = {}
    for crossing in CROSSINGS:
        there = shown & np.isin(effects, crossing.effects)
        if there.any():
            found[crossing] = there
    return found
