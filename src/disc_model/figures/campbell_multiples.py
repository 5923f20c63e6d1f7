"""Multiples of the stick-slip frequency that a reader asks for in a Campbell diagram."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.campbell_crossings import SYMBOLS
from disc_model.figures.campbell_looks import CROSSINGS, crossing_look, multiple_look
from disc_model.figures.campbell_peaks import followed_frequency
from disc_model.figures.drawing import large, sample
from disc_model.figures.names import Names
from disc_model.figures.types import Array, Artist, Axes, Mask

ABOVE_MODES = 2.5  # zorder of multiples, which may lie on the thick line of a mode
PLACES = 40  # along the line of a multiple, on which its name may stand
AT_LINE = ((-1, 0), (-1, 2), (-1, -2), (-1, 4), (-1, -4))
"""Offsets in points of names from such a place: on the line, above and below it."""
BEHIND_NAME = {"facecolor": "white", "edgecolor": "none", "pad": 0.3}
"""Look of the box behind a name, in which its line is open."""


def draw_multiples(ax: Axes, study: xr.Dataset, multiples: Sequence[float], highest: float) -> None:
    """Draw multiples of the stick-slip frequency over the speed, and marks where modes cross them, up to
    the highest frequency shown (Hz)."""
    releases = followed_frequency(study)
    for multiple in multiples:
        line = multiple * releases
        ax.plot(study["Omega"], line, zorder=ABOVE_MODES, **multiple_look())
    for effect, at_effect in _by_effect(study, multiples, highest).items():
        speeds = study["crossing_Omega"].values[at_effect]
        frequencies = study["crossing_frequency"].values[at_effect]
        ax.plot(speeds, frequencies, **crossing_look(effect))


def name_multiples(
    names: Names, study: xr.Dataset, multiples: Sequence[float], highest: float
) -> None:
    """Write the names of multiples at their lines, as far as they are shown, from the last speed on,
    where there is room."""
    speeds = study["Omega"].values
    releases = followed_frequency(study).values
    for multiple in multiples:
        line = multiple * releases
        shown = np.flatnonzero(line <= highest)
        if not shown.size:
            continue
        places = shown[np.linspace(shown.size - 1, 0, PLACES).astype(int)]
        points = [(float(speeds[at]), float(line[at])) for at in places]
        rivals = _points_of_others(study, multiples, multiple)
        look: dict[str, Any] = {"fontsize": large(6), "bbox": BEHIND_NAME}
        name = f"{multiple:g} {SYMBOLS[0]}"
        names.add_along(name, points, AT_LINE, rivals, over_lines=True, **look)


def _points_of_others(study: xr.Dataset, multiples: Sequence[float], own: float) -> Array:
    """Points of the lines of other multiples than one's own, shape (n, 2)."""
    releases = followed_frequency(study).dropna("Omega")
    points = [np.empty((0, 2))]
    for multiple in multiples:
        if multiple != own:
            points.append(np.column_stack([releases["Omega"], multiple * releases]))
    return np.concatenate(points)


def places_of_marks(study: xr.Dataset, multiples: Sequence[float], highest: float) -> Array:
    """Speeds and frequencies of crossings that have a mark, shape (n, 2)."""
    places = [np.empty((0, 2))]
    for at_effect in _by_effect(study, multiples, highest).values():
        speeds = study["crossing_Omega"].values[at_effect]
        places.append(np.column_stack([speeds, study["crossing_frequency"].values[at_effect]]))
    return np.concatenate(places)


def entries_of_crossings(
    studies: Sequence[xr.Dataset], multiples: Sequence[float], highest: float
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


def marked_at_multiples(study: xr.Dataset, multiples: Sequence[float]) -> Mask:
    """Crossings of multiples that a reader asks for."""
    if not multiples or "crossing_effect" not in study:
        return np.zeros(study["crossing_Omega"].shape, dtype=bool)
    of_slips = flag_names(study["crossing_line"]) == "stick_slip"
    return of_slips & np.isin(study["crossing_multiple"].values, multiples)


def _by_effect(study: xr.Dataset, multiples: Sequence[float], highest: float) -> dict[str, Mask]:
    """Crossings of multiples that are shown, by what growth rates do there."""
    marked = marked_at_multiples(study, multiples)
    if not marked.any():
        return {}
    shown = marked & (study["crossing_frequency"].values <= highest)
    effects = flag_names(study["crossing_effect"])
    found = {}
    for effect in CROSSINGS:
        at_effect = shown & (effects == effect)
        if at_effect.any():
            found[effect] = at_effect
    return found
