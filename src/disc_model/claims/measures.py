"""Numbers that claims are about, from events and samples."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.claims.model import CaseView, Missing
from disc_model.result import EVENT_KINDS, PHASES

Array = NDArray[np.float64]
STICK, SLIP, SEPARATION = (PHASES.index(phase) for phase in ("stick", "slip", "separation"))


class Range(NamedTuple):
    """Least and greatest value."""

    low: float
    high: float

    @property
    def width(self) -> float:
        return self.high - self.low


def times_of(events: xr.Dataset, kind: str) -> Array:
    """Times of one kind of event, s."""
    times: Array = events["time"].values[is_kind(events, kind)]
    return times


def is_kind(events: xr.Dataset, kind: str) -> NDArray[np.bool_]:
    """Which events are of one kind, shape (event,)."""
    mask: NDArray[np.bool_] = events["kind"].values == EVENT_KINDS.index(kind)
    return mask


def release_intervals(case: CaseView) -> Array:
    """Times between successive releases of stick in the events kept, s."""
    intervals = np.diff(times_of(case.group("events"), "stick_to_slip"))
    if intervals.size < 20:
        raise Missing(f"case {case.name} keeps fewer than 20 stick-slip cycles")
    return intervals


def irregularity(intervals: Array) -> float:
    """Standard deviation over mean; 0 for a motion with one release a period."""
    return float(np.std(intervals) / np.mean(intervals))


def closure(intervals: Array, period: int) -> float:
    """Largest difference between an interval and the one `period` releases later, s."""
    return float(np.max(np.abs(intervals[period:] - intervals[:-period])))


def shortest_period(intervals: Array, tolerance: float, longest: int = 8) -> int:
    """Least number of releases after which intervals repeat to `tolerance` s; 0 if none up to `longest`."""
    return next((n for n in range(1, longest + 1) if closure(intervals, n) <= tolerance), 0)


def rate_of(case: CaseView, kind: str) -> float:
    """Events of one kind per second within the events kept, 1/s."""
    start, stop = kept_span(case)
    return times_of(case.group("events"), kind).size / (stop - start)


def kept_span(case: CaseView) -> Range:
    """Stretch of time of which a case keeps its events, s."""
    attrs = case.group("events").attrs
    return Range(float(attrs["kept_from"]), min(float(attrs["kept_until"]), case["time_reached"]))


def separation_durations(case: CaseView) -> Array:
    """Durations of the separations that begin and end within the events kept, s."""
    events = case.group("events")
    apart, together = times_of(events, "separation"), times_of(events, "reattachment")
    apart = apart[: np.searchsorted(apart, together[-1])] if together.size else apart[:0]
    if not apart.size:
        raise Missing(f"case {case.name} keeps no whole separation")
    return np.asarray(together[np.searchsorted(together, apart, side="right")] - apart)


def phase_share(case: CaseView, phase: str, start: float = -np.inf) -> float:
    """Share of time spent in a phase after `start`, within the events kept."""
    events = case.group("events")
    _, stop = kept_span(case)
    time = np.append(events["time"].values, stop)
    kept = time[:-1] >= start
    if not kept.any():
        raise Missing(f"case {case.name} keeps no events after {start:g} s")
    lasting = np.diff(time)[kept]
    inside = events["phase"].values[kept] == PHASES.index(phase)
    return float(lasting[inside].sum() / lasting.sum())


def range_within(case: CaseView, name: str, start: float, stop: float) -> Range:
    """Range of a variable from the whole bins of the window `history` between two times."""
    history = case.group("history")
    time = history["time"].values
    half = (time[1] - time[0]) / 2
    inside = (time >= start + 0.99 * half) & (time <= stop - 0.99 * half)
    if not inside.any():
        raise Missing(f"case {case.name} has no history from {start:g} to {stop:g} s")
    return Range(float(history[f"{name}_min"].values[inside].min()), float(history[f"{name}_max"].values[inside].max()))


def late_range(case: CaseView, name: str, last: float = 20.0) -> Range:
    """Range over the last seconds of the run."""
    end = case["time_reached"]
    return range_within(case, name, end - last, end)


def early_range(case: CaseView, name: str, first: float = 20.0) -> Range:
    """Range over the first seconds, the very first one left out."""
    return range_within(case, name, 1.0, 1.0 + first)
