"""The legend of a Campbell diagram: its lines, marks and bands, as far as they are drawn."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from disc_model.figures.campbell_bands import entries_of_bands
from disc_model.figures.campbell_crossings import (
    SYMBOLS,
    entries_of_unknown,
    meeting_of,
    symbol_of_line,
)
from disc_model.figures.campbell_looks import (
    beyond_look,
    dot_look,
    elsewhere_look,
    growing_look,
    multiple_look,
    speed_look,
)
from disc_model.figures.campbell_multiples import entries_of_crossings, entries_of_unmarked
from disc_model.figures.campbell_peaks import Column, Peak, followed_rates, growing_modes, unjoined
from disc_model.figures.cut import entries_of_left_out, entry_of_cut, modes_cut
from disc_model.figures.drawing import BLACK, open_line, sample, wide
from disc_model.figures.rate_scale import LINEAR
from disc_model.figures.selection import doubts
from disc_model.figures.types import Artist

PEAK = "peak of growth"
NOT_CROSSED = "no crossing found at it"
ALONE = "by itself: another cycle, or too wide a step"
"""What a point may be that differs from both neighbours."""


def entries_of(
    columns: Sequence[Column], highest: float, multiples: Sequence[int] = ()
) -> list[Artist]:
    """Entries of a legend for the lines, marks and bands that are drawn, for what lies above the
    highest frequency shown (Hz), and for crossings of multiples that are asked for."""
    handles: list[Artist] = [
        sample(color=BLACK, linewidth=wide(0.9), label="mode of steady sliding")
    ]
    studies = [column.study for column in columns]
    if any(growing_modes(study).any() for study in studies):
        handles.append(sample(label="mode of steady sliding that grows", **growing_look()))
    above = max(modes_cut(study, "sliding_frequency", highest) for study in studies)
    if above:
        handles.append(entry_of_cut(above, highest))
    handles += entries_of_left_out(studies)
    handles += entries_of_unknown(studies)
    found = [peak for column in columns for peak in column.peaks]
    handles += _entries_of_peaks(found, highest, bool(multiples))
    handles += entries_of_crossings(studies, multiples, highest)
    handles += entries_of_unmarked(columns, multiples, highest)
    return handles + _entries_of_rates(studies)


def _entries_of_rates(studies: Sequence[xr.Dataset]) -> list[Artist]:
    """Entries of a legend for points by themselves, of other cycles, open steps, and gaps."""
    handles: list[Artist] = []
    followed = [followed_rates(study) for study in studies]
    if any(unjoined(rate).any() for rate in followed):
        handles.append(sample(label=ALONE, **dot_look(alone=True)))
    for name in {look.label for study in studies for look in doubts(study, "growth_rate")}:
        handles.append(sample(label=name, **elsewhere_look()))
    if any((np.abs(np.diff(rate)) > LINEAR).any() for rate in followed):
        wide_step = f"line open: a step of over {LINEAR:g}/s"
        handles.append(open_line(wide_step, BLACK, wide(0.8)))
    return handles + entries_of_bands(studies)


def _entries_of_peaks(found: Sequence[Peak], highest: float, of_slips: bool) -> list[Artist]:
    """Entries of a legend for multiples, of stick-slip in any case or only at peaks, for peaks, and for
    their crossings below and above the highest frequency shown (Hz)."""
    if not found:
        return _entries_of_multiples([], of_slips)
    crossings = [peak.crossing for peak in found if peak.crossing is not None]
    shown = [crossing for crossing in crossings if meeting_of(crossing)[1] <= highest]
    handles = _entries_of_multiples(shown, of_slips)
    unnamed = []
    for name, alike in _by_name(found, bool(shown)).items():
        if _are_resolved(alike):
            look = dot_look(alone=False, crossed=alike[0].crossing is not None)
            handles.append(sample(label=name, **look))
        elif alike:
            unnamed.append(name)  # marks of points by themselves say that they are not resolved
    at_line = " or ".join(unnamed) or "peak"
    handles.append(sample(label=f"speed of a {at_line}", **speed_look()))
    if len(shown) < len(crossings):
        label = f"crossing above {highest:g} Hz"
        handles.append(sample(label=label, **beyond_look()))
    return handles


def _entries_of_multiples(crossings: Sequence[xr.Dataset], of_slips: bool) -> list[Artist]:
    """The entry of a legend for multiples of frequencies that modes meet at crossings, and of
    stick-slip if they are asked for; none if nothing is drawn."""
    symbols = {symbol_of_line(crossing) for crossing in crossings}
    if of_slips:
        symbols.add(SYMBOLS[0])
    if not symbols:
        return []
    said = " or ".join(sorted(symbols, key=SYMBOLS.index))
    return [sample(label=f"multiple of {said}", **multiple_look())]


def _by_name(found: Sequence[Peak], crossings_shown: bool) -> dict[str, list[Peak]]:
    """Peaks with and without a crossing, by what the legend calls them."""
    crossed = [peak for peak in found if peak.crossing is not None]
    others = [peak for peak in found if peak.crossing is None]
    at_crossings = f"{PEAK}, crossing at it" if crossings_shown else PEAK
    return {at_crossings: crossed, f"{PEAK}, {NOT_CROSSED}": others}


def _are_resolved(found: Sequence[Peak]) -> bool:
    """Whether some peaks are no points by themselves."""
    return any(not peak.alone for peak in found)
