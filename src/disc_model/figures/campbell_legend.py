"""The legend of a Campbell diagram: its lines, marks and bands, as far as they are drawn."""

from collections.abc import Sequence

import xarray as xr

from disc_model.figures.campbell_bands import entries_of_bands
from disc_model.figures.campbell_counts import entries_of_counts
from disc_model.figures.campbell_crossings import SYMBOLS, meeting_of, symbol_of_line
from disc_model.figures.campbell_looks import (
    NOT_NEAR,
    beyond_look,
    dot_look,
    elsewhere_look,
    growing_look,
    multiple_look,
    speed_look,
)
from disc_model.figures.campbell_multiples import entries_of_crossings, shows_multiples
from disc_model.figures.campbell_peaks import (
    Column,
    Peak,
    elsewhere_of,
    followed_rates,
    growing_modes,
    unjoined,
)
from disc_model.figures.cut import entries_of_left_out, entry_of_cut, modes_cut
from disc_model.figures.drawing import BLACK, open_line, open_ring, sample, wide
from disc_model.figures.rate_scale import ANOTHER_CYCLE, opens
from disc_model.figures.symbols import seen
from disc_model.figures.types import Array, Artist

PEAK = "peak of growth"
AT_CROSSING = "peak at a crossing"
NOT_CROSSED = "peak without a crossing"
SHORT = 24  # characters of entries that stand in the first columns


def entries_of(
    columns: Sequence[Column], highest: float, multiples: Sequence[float] = ()
) -> list[Artist]:
    """Entries of a legend for the lines, marks and bands that are drawn, for what lies above the
    highest frequency shown (Hz), and for crossings of multiples that are asked for; short ones first,
    so that columns are as narrow as they can be."""
    studies = [column.study for column in columns]
    handles = _entries_of_modes(studies, highest)
    above = max(modes_cut(study, "sliding_frequency", highest) for study in studies)
    if above:
        handles.append(entry_of_cut(above, highest))
    handles += entries_of_left_out(studies)
    found = [peak for column in columns for peak in column.peaks]
    of_slips = any(shows_multiples(study, multiples, highest) for study in studies)
    handles += _entries_of_peaks(found, highest, of_slips)
    handles += entries_of_crossings(columns, multiples, highest)
    handles += _entries_of_rates(studies, found)
    handles.sort(key=_is_long)
    return handles + entries_of_counts(columns, multiples, highest)


def _entries_of_modes(studies: Sequence[xr.Dataset], highest: float) -> list[Artist]:
    """Entries of a legend for modes, and for those that grow, that have a frequency up to the highest
    shown (Hz)."""
    handles: list[Artist] = []
    shown = [study["sliding_frequency"] <= highest for study in studies]
    if any(each.any() for each in shown):
        handles.append(sample(color=BLACK, linewidth=wide(0.9), label="mode of steady sliding"))
    grows = [growing_modes(study) for study in studies]
    if any((each & known).any() for each, known in zip(grows, shown, strict=True)):
        handles.append(sample(label="growing mode", **growing_look()))
    return handles


def _is_long(handle: Artist) -> bool:
    """Whether the words of an entry need a wide column."""
    lines = str(handle.get_label()).splitlines()
    return max(map(seen, lines)) > SHORT


def _entries_of_rates(studies: Sequence[xr.Dataset], found: Sequence[Peak]) -> list[Artist]:
    """Entries of a legend for points of other cycles, by themselves or beside open steps, and gaps."""
    followed = [followed_rates(study) for study in studies]
    handles = _entries_of_other_cycles(followed, any(peak.is_open for peak in found))
    if any(elsewhere_of(study).any() for study in studies):
        handles.append(sample(label=NOT_NEAR, **elsewhere_look()))
    return handles + entries_of_bands(studies)


def _entries_of_other_cycles(followed: Sequence[Array], has_open_peaks: bool) -> list[Artist]:
    """The entry of a legend for what may be another cycle, or too wide a step: points by themselves and
    peaks beside open steps, open lines, or both."""
    alone = has_open_peaks or any(unjoined(rate).any() for rate in followed)
    is_open = any(opens(rate).any() for rate in followed)
    if alone and is_open:
        return [open_ring(ANOTHER_CYCLE, BLACK, wide(0.8))]
    if is_open:
        return [open_line(ANOTHER_CYCLE, BLACK, wide(0.8))]
    if alone:
        return [sample(label=ANOTHER_CYCLE, **dot_look(alone=True))]
    return []


def _entries_of_peaks(found: Sequence[Peak], highest: float, of_slips: bool) -> list[Artist]:
    """Entries of a legend for multiples, of stick-slip in any case or only at peaks, for peaks with the
    lines at their speeds, and for their crossings below and above the highest frequency shown (Hz)."""
    crossings = [peak.crossing for peak in found if peak.crossing is not None]
    shown = [crossing for crossing in crossings if meeting_of(crossing)[1] <= highest]
    handles = _entries_of_multiples(shown, of_slips)
    for name, alike in _by_name(found, bool(shown)).items():
        if alike:
            dot = dot_look(not _are_resolved(alike), crossed=alike[0].crossing is not None)
            handles.append(sample(label=name, **{**dot, **speed_look()}))
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
    return {AT_CROSSING if crossings_shown else PEAK: crossed, NOT_CROSSED: others}


def _are_resolved(found: Sequence[Peak]) -> bool:
    """Whether there is no open step beside some peaks."""
    return any(not peak.is_open for peak in found)
