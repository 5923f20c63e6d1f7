"""Stretches of stick, slip and separation of a run, from its events, or from samples where the run
keeps no events."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.dataset import Missing
from disc_model.data.variables import PHASES, flag_names
from disc_model.figures import selection

Span = tuple[float, float]  # s, begin and end
Spans = Mapping[str, Sequence[Span]]  # by phase


def spans_between(case: xr.DataTree, start: float, stop: float) -> Spans:
    """Stretches of each phase between two times in s, from the events; raises `Missing` unless the
    case keeps all events there, and one before.

    A study's case keeps those of a span. A run that is drawn at once has all of them.
    """
    events = dataset.group(case, "events")
    times = events["time"].values
    phases = flag_names(events["phase"])
    kept_from = events.attrs.get("kept_from", -np.inf)
    kept_until = events.attrs.get("kept_until", np.inf)
    inside = (times > start) & (times < stop)
    before = np.flatnonzero(times <= start)
    if start < kept_from or stop > kept_until or not before.size:
        raise Missing(f"keeps no events from {start:g} to {stop:g} s")
    words = [phases[before[-1]], *phases[inside]]
    borders = [start, *times[inside].tolist(), stop]
    spans: dict[str, list[Span]] = {phase: [] for phase in PHASES}
    for word, begin, end in zip(words, borders[:-1], borders[1:], strict=True):
        same = spans[word]
        if same and same[-1][1] == begin:  # the phase goes on, as at a reversal of slip
            same[-1] = (same[-1][0], end)
        else:
            same.append((begin, end))
    return spans


def spans_in(case: xr.DataTree, window: xr.Dataset) -> Spans:
    """Stretches of each phase in a window; borders lie halfway between samples where the case
    keeps no events. Nothing for a window that holds ranges."""
    if "phase" not in window or window.sizes["time"] < 2:
        return {phase: [] for phase in PHASES}
    time = window["time"].values
    words = flag_names(window["phase"])
    try:
        return spans_between(case, float(time[0]), float(time[-1]))
    except Missing:
        return {phase: selection.spans(time, words == phase) for phase in PHASES}
