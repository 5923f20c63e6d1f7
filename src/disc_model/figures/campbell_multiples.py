"""Multiples of the stick-slip frequency that a reader asks for in a Campbell diagram."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.campbell_crossings import SYMBOLS, is_of_slips, meeting_of, places_of
from disc_model.figures.campbell_looks import CROSSINGS, Crossing, crossing_look, multiple_look
from disc_model.figures.campbell_peaks import Column, followed_frequency, jumps_of, marked_at_peaks
from disc_model.figures.drawing import large, sample
from disc_model.figures.names import Names
from disc_model.figures.selection import opened
from disc_model.figures.types import Array, Artist, Axes, Mask

ABOVE_MODES = 2.5  # zorder of multiples, which may lie on the thick line of a mode
PLACES = 40  # along the line of a multiple, on which its name may stand
AT_LINE = tuple((across, up) for across in (-1, 1) for up in (0, 2, -2, 4, -4))
"""Offsets in points of names from such a place: on the line, above and below it, before and behind."""
BEHIND_NAME = {"facecolor": "white", "edgecolor": "none", "pad": 0.3}
"""Look of the box behind a name, in which its line is open."""


def draw_multiples(ax: Axes, column: Column, multiples: Sequence[float], highest: float) -> None:
    """Draw multiples of the stick-slip frequency over the speed, and marks where modes cross them, up to
    the highest frequency shown (Hz)."""
    study = column.study
    for multiple in multiples:
        draw_multiple(ax, study, multiple, ABOVE_MODES)
    for crossing, there in _by_mark(column, multiples, highest).items():
        speeds = study["crossing_Omega"].values[there]
        frequencies = study["crossing_frequency"].values[there]
        ax.plot(speeds, frequencies, **crossing_look(crossing))


def draw_multiple(ax: Axes, study: xr.Dataset, multiple: float, zorder: float) -> None:
    """Draw a multiple of the stick-slip frequency over the speed, with gaps where it jumps."""
    line = multiple * followed_frequency(study)
    pieces = opened(study["Omega"].values, line.values, jumps_of(study))
    ax.plot(*pieces, zorder=zorder, **multiple_look())


def shows_multiples(study: xr.Dataset, multiples: Sequence[float], highest: float) -> bool:
    """Whether one of some multiples of the stick-slip frequency has a part up to the highest frequency
    shown (Hz)."""
    if not multiples:
        return False
    return bool((min(multiples) * followed_frequency(study) <= highest).any())


def name_multiples(
    names: Names, column: Column, multiples: Sequence[float], highest: float
) -> None:
    """Write the names of multiples at their lines, as far as they are shown, from the last speed on,
    where there is room, and nearer to these than to lines of other multiples."""
    releases = followed_frequency(column.study)
    drawn = [*multiples, *_multiples_at_peaks(column, highest)]
    for multiple in multiples:
        line = multiple * releases
        shown = np.flatnonzero(line.values <= highest)
        if not shown.size:
            continue
        places = shown[np.linspace(shown.size - 1, 0, PLACES).astype(int)]
        points = [(float(line["Omega"][at]), float(line[at])) for at in places]
        others = [other for other in drawn if other != multiple]
        rivals = _points_of_lines(releases, others)
        look: dict[str, Any] = {"fontsize": large(6), "bbox": BEHIND_NAME}
        name = f"{multiple:g} {SYMBOLS[0]}"
        names.add_along(name, points, AT_LINE, rivals, over_lines=True, **look)


def _multiples_at_peaks(column: Column, highest: float) -> list[float]:
    """Multiples of the stick-slip frequency that have a line since a peak of growth is at a crossing of
    them up to the highest frequency shown (Hz)."""
    crossings = [peak.crossing for peak in column.peaks if peak.crossing is not None]
    found = []
    for crossing in crossings:
        if is_of_slips(crossing) and meeting_of(crossing)[1] <= highest:
            found.append(float(crossing["crossing_multiple"]))
    return found


def _points_of_lines(releases: xr.DataArray, multiples: Sequence[float]) -> Array:
    """Points of the lines of multiples of the stick-slip frequency, shape (n, 2)."""
    known = releases.dropna("Omega")
    points = [np.empty((0, 2))]
    for multiple in multiples:
        points.append(np.column_stack([known["Omega"], multiple * known]))
    return np.concatenate(points)


def places_of_marks(column: Column, multiples: Sequence[float], highest: float) -> Array:
    """Speeds and frequencies of crossings that have a mark, also that of a peak, shape (n, 2)."""
    study = column.study
    marked = marked_at_peaks(column) | marked_at_multiples(study, multiples)
    places = places_of(study)
    return places[marked & (places[:, 1] <= highest)]


def entries_of_crossings(
    columns: Sequence[Column], multiples: Sequence[float], highest: float
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


def marked_at_multiples(study: xr.Dataset, multiples: Sequence[float]) -> Mask:
    """Crossings of multiples that a reader asks for."""
    if not multiples or "crossing_effect" not in study:
        return np.zeros(len(places_of(study)), dtype=bool)
    of_slips = flag_names(study["crossing_line"]) == "stick_slip"
    return of_slips & np.isin(study["crossing_multiple"].values, multiples)


def _by_mark(column: Column, multiples: Sequence[float], highest: float) -> dict[Crossing, Mask]:
    """Crossings of multiples that are shown and at no peak, which has its own mark, by their marks."""
    study = column.study
    marked = marked_at_multiples(study, multiples) & ~marked_at_peaks(column)
    if not marked.any():
        return {}
    shown = marked & (study["crossing_frequency"].values <= highest)
    effects = flag_names(study["crossing_effect"])
    found = {}
    for crossing in CROSSINGS:
        there = shown & np.isin(effects, crossing.effects)
        if there.any():
            found[crossing] = there
    return found
