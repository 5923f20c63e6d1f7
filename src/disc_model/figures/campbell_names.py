"""Names of the peaks and crossings of a Campbell diagram, where there is room for them."""

from collections.abc import Sequence

import numpy as np

from disc_model.figures.campbell_crossings import meeting_of, multiple_text
from disc_model.figures.campbell_multiples import name_multiples, places_of_marks
from disc_model.figures.campbell_peaks import Column, followed_rates
from disc_model.figures.drawing import halo, large
from disc_model.figures.names import Names
from disc_model.figures.rate_scale import opens
from disc_model.figures.selection import opened
from disc_model.figures.types import Array, Axes

BESIDE_MEETING = tuple(
    (across, up) for up in (4, 9, 14) for across, up in ((6, -up), (-6, up), (6, up), (-6, -up))
)
"""Offsets in points of names beside crossings, best first."""
LED_TO_MEETING = tuple((across, up) for up in (22, 32, 44, 56) for across in (-14, 14, -28, 28, 0))
"""Further offsets, at which a line leads to the crossing."""
BETWEEN = 20  # points of each step of a line, which no name covers
UPRIGHT = 200  # points along the line at the speed of a peak
BESIDE_PEAK = ((2, 3), (-2, 3), (2, 10), (-2, 10), (2, 17), (-2, 17))  # and beside peaks


def name_peaks(
    top: Axes,
    bottom: Axes,
    column: Column,
    highest: float = np.inf,
    multiples: Sequence[float] = (),
) -> None:
    """Write the multiples at peaks, at crossings up to the highest frequency shown (Hz), and beside the
    lines of multiples that are asked for, where there is room."""
    study = column.study
    speeds = study["Omega"].values
    rate = study["growth_rate"].values
    modes = study["sliding_frequency"].transpose(..., "Omega").values
    lines = [(speeds, mode) for mode in modes]
    marks = places_of_marks(column, multiples, highest)
    above = Names(top, lines=np.vstack([_along_lines(lines), marks]))
    followed = followed_rates(study)
    of_rates = _along_lines([opened(speeds, followed, opens(followed))])
    below = Names(bottom, lines=np.vstack([of_rates, np.column_stack([speeds, rate])]))
    outline = halo()
    for peak in column.peaks:
        if peak.crossing is None:
            continue
        name = multiple_text(peak.crossing)
        meeting = meeting_of(peak.crossing)
        if meeting[1] <= highest:
            others = [speeds[each.place] for each in column.peaks if each.place != peak.place]
            above.add(
                name,
                meeting,
                BESIDE_MEETING,
                LED_TO_MEETING,
                rivals=_upright_lines(top, others),
                fontsize=large(6),
                path_effects=outline,
            )
        place = (study["Omega"].values[peak.place], study["growth_rate"].values[peak.place])
        below.add(name, place, BESIDE_PEAK, fontsize=large(7), path_effects=outline)
    name_multiples(above, column, multiples, highest)  # anywhere along lines


def _upright_lines(ax: Axes, speeds: Sequence[float]) -> Array:
    """Points along the lines at the speeds of peaks, over the height of a panel."""
    heights = np.linspace(*ax.get_ylim(), UPRIGHT)
    across, up = np.meshgrid(speeds, heights)
    return np.column_stack([across.ravel(), up.ravel()])


def _along_lines(lines: Sequence[Sequence[Array]]) -> Array:
    """Points that no name covers, along lines of given points, and closer than these; shape
    (n, 2)."""
    share = np.linspace(0, 1, BETWEEN)[:, None]
    points = []
    for line in lines:
        given = np.column_stack(line)
        steps = given[:-1] + share[..., None] * np.diff(given, axis=0)
        points.append(steps.reshape(-1, 2))
    return np.concatenate(points)
