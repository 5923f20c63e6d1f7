"""Whether pictures of a run show a motion that still grows."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import xarray as xr

from disc_model.figures.drawing import sample
from disc_model.figures.legend_samples import NOTE
from disc_model.figures.stated_case import ramps_of
from disc_model.figures.types import Array, Artist

STILL_GROWING = "still growing"
"""What legends say of such a run, as of points of a sweep."""
PARTS = 8  # of the time up to the end of what is shown, of which the last four are compared
FEWEST = 50  # events in each part: within fewer cycles, beats of decaying modes look like growth
LATEST = 1.05  # ratio of the spreads of the last two parts from which a motion still grows,
LATER = 1.1  # if that of the two before has risen by this ratio as well


def growth_entries(case: xr.DataTree, windows: Sequence[xr.Dataset]) -> list[Artist]:
    """The entry of a legend that says that a run still grows at the end of its windows; none otherwise."""
    note = growth_note(case, windows)
    return [sample(label=note, linestyle="", gid=NOTE)] if note else []


def growth_note(case: xr.DataTree, windows: Sequence[xr.Dataset]) -> str:
    """What legends say of a run that still grows at the end of its windows; "" otherwise, and where it is
    not known."""
    ends = [window["time"].values[-1] for window in windows if window.sizes["time"]]
    is_known = "events" in case.children and "first_separation" in case
    if not ends or not is_known or ramps_of(case):
        return ""
    events = case["events"].to_dataset()
    if not {"time", "u"} <= {*events.variables} or "kept_from" in events.attrs:
        return ""
    end = float(max(ends))
    # after the first separation the motion has further events, at other heights
    separation = float(case["first_separation"])
    start = separation if separation < end else 0.0  # nan: contact is kept
    spreads = _spreads(events["time"].values, events["u"].values, start, end)
    return STILL_GROWING if _grow(spreads) else ""


def _spreads(times: Array, heights: Array, start: float, end: float) -> Array:
    """Standard deviations of the slider's positions at events in the last four parts of the time from a start
    to an end, s; nan of a part with few events."""
    borders = np.linspace(start, end, PARTS + 1)[-5:]
    spreads = []
    for start, stop in pairwise(borders):
        inside = heights[(times > start) & (times <= stop)]
        spreads.append(np.std(inside) if inside.size >= FEWEST else np.nan)
    return np.array(spreads)


def _grow(spreads: Array) -> bool:
    """Whether the last of four spreads are clearly above those before: an irregular motion varies by less."""
    first, second, third, last = spreads
    return bool(last > LATEST * third and third + last > LATER * (first + second))
