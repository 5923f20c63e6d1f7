"""The frequencies that stand beside the peaks of a spectrum."""

import math
from collections.abc import Sequence

from disc_model.figures.drawing import large
from disc_model.figures.names import Names
from disc_model.figures.types import Axes

MOST_NAMED = 5  # lines whose frequencies are written
BESIDE = ((3, 2), (-3, 2))  # points, of the names beside their peaks,
BELOW = ((3, -3), (-3, -3))  # where there is no room, beside their lines,
ABOVE = tuple((across, up) for up in (5, 13, 21, 29, 37) for across in (0, -2, 2))  # and else above
ROUNDING = 1e-9  # relative, of the decade of a resolution
MOST_DECIMALS = 1  # of the frequency beside a peak


def name_lines(ax: Axes, peaks: Sequence[tuple[float, float]], resolution: float = 0.1) -> None:
    """Write the frequencies, Hz, of the strongest lines beside their peaks, on the side away from
    the nearest other line if there is room, or above, with a line to the peak. The stronger
    comes first; without room for the strongest there is none. They have no more digits than the
    resolution, Hz, and a tenth at most."""
    names = Names(ax, stems=peaks, first_needed=True)
    every = [frequency for frequency, _ in peaks]
    for frequency, height in sorted(peaks, key=lambda peak: -peak[1])[:MOST_NAMED]:
        sides = (*BESIDE, *BELOW)
        if _nearest(frequency, every) > frequency:
            sides = (*BESIDE[::-1], *BELOW[::-1])
        text = frequency_text(frequency, resolution)
        names.add(text, (frequency, height), sides, ABOVE, fontsize=large(7))


def frequency_text(frequency: float, resolution: float) -> str:
    """A frequency in Hz, rounded to the place of the first digit of the resolution, or to a tenth."""
    places = min(-math.floor(math.log10(resolution) + ROUNDING), MOST_DECIMALS)
    return f"{round(frequency, places):.{max(places, 0)}f} Hz"


def _nearest(frequency: float, every: Sequence[float]) -> float:
    """The frequency of the line nearest another one; zero without any."""
    others = [other for other in every if other != frequency]
    return min(others, key=lambda other: abs(other - frequency), default=0.0)
