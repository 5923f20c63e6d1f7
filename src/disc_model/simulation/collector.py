"""Buffers between the engine and the arrays that a result keeps."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from disc_model.engine import machine, sampling
from disc_model.parameters import Parameters
from disc_model.simulation.record import Poincare, Record, Window

Array = NDArray[np.float64]

BUFFER = 1 << 15  # rows of a buffer: large enough that draining costs nothing, small enough to stay in the cache
SMALL_BUFFER = 1 << 8  # of the rows of events at first: a large one takes longer to make than a short simulation
_COLUMN = {name: i for i, name in enumerate(sampling.ROW)}
_FOLDED = ("P", "u", "w", "w_point", "psi", "psi_velocity")


class Collector:
    """Hands the engine its buffers, empties them when it pauses, and shapes what was kept."""

    def __init__(self, p: Parameters, record: Record, start: float, t_end: float, longest_step: float) -> None:
        self._windows = list(record.windows)
        grids = [_uniform(window, start, t_end) for window in record.windows]
        if record.poincare is not None:
            grids.append(_stroboscopic(record.poincare, p.Omega, start, t_end))
        self.samplers: Array = np.array([(*grid, t_end) for grid in grids], dtype=float).reshape(-1, 5)
        self.sampled = np.zeros(len(grids), np.int64)
        # the engine pauses between steps only, so one step's samples must fit above ``capacity``
        longest = longest_step + sampling.SAME_INSTANT * t_end
        per_step = sum(1 + math.ceil(min(longest / grid[1], grid[2])) for grid in grids)
        self.capacity = BUFFER if grids else 0
        self.rows = np.empty((self.capacity + per_step if grids else 0, len(sampling.ROW)))
        self.event_rows = np.empty((SMALL_BUFFER, len(machine.EVENT_ROW)))
        self._keep_events = record.events
        # what was kept, in the order in which it came: arrays are added to these lists and nothing else
        self._events: list[Array] = []
        self._parts: list[list[Array]] = [[] for _ in grids]
        self._rest: list[Array] = [np.zeros((0, len(sampling.ROW))) for _ in grids]
        self._poincare = record.poincare is not None
        self._first_separation = np.array([math.nan])

    @property
    def first_separation(self) -> float:
        """Time of the first loss of contact, s; nan if there was none."""
        return float(self._first_separation[0])

    def position(self) -> dict[str, NDArray[Any]]:
        """What the rest of the run depends on.  Only just after `drain`: the buffers are not part of it."""
        rest = {f"rest_{i}": rows for i, rows in enumerate(self._rest)}
        return {"sampled": self.sampled, "first_separation": self._first_separation, **rest}

    def kept(self) -> dict[str, list[Array]]:
        """What was kept so far: lists that only grow."""
        return {"events": self._events} | {f"samples_{i}": parts for i, parts in enumerate(self._parts)}

    def restore(self, position: Mapping[str, NDArray[Any]], kept: Mapping[str, Sequence[Array]]) -> None:
        """Go on from what `position` and `kept` gave."""
        self.sampled[:], self._first_separation[:] = position["sampled"], position["first_separation"]
        self._rest = [position[f"rest_{i}"] for i in range(len(self._rest))]
        for name, parts in self.kept().items():
            parts[:] = kept.get(name, ())

    def drain(self, counters: NDArray[np.int64]) -> None:
        """Take over what the buffers hold and empty them."""
        n_events, n_rows = int(counters[machine.EVENT_ROWS]), int(counters[machine.SAMPLE_ROWS])
        counters[machine.EVENT_ROWS] = counters[machine.SAMPLE_ROWS] = 0
        if n_events:
            self._take_events(self.event_rows[:n_events])
        if n_events > len(self.event_rows) - machine.MAX_EVENTS_PER_STEP:  # it was full
            self.event_rows = np.empty((BUFFER, len(machine.EVENT_ROW)))
        rows = self.rows[:n_rows]
        for i in range(len(self.sampled)):
            self._take(i, rows[rows[:, 0] == i])

    def _take_events(self, events: Array) -> None:
        if math.isnan(self.first_separation):
            lost = np.flatnonzero(events[:, 1] == machine.LOSS_OF_CONTACT)
            if lost.size:
                self._first_separation[0] = events[lost[0], 0]
        if self._keep_events:
            self._events.append(events.copy())

    def _take(self, i: int, rows: Array) -> None:
        if not len(rows):
            return
        fold = self._fold_of(i)
        if fold is None:
            self._parts[i].append(rows.copy())
            return
        rows = np.concatenate((self._rest[i], rows))
        whole = len(rows) // fold * fold
        self._rest[i] = rows[whole:].copy()  # a view would keep all of them
        if whole:
            self._parts[i].append(_fold(rows[:whole].reshape(-1, fold, rows.shape[1])))

    def _fold_of(self, i: int) -> int | None:
        """Samples to a bin of an envelope, None where samples are kept as they are."""
        return self._windows[i].envelope if i < len(self._windows) else None

    def events(self) -> Array:
        """All events kept, shape (n, len(EVENT_ROW))."""
        if len(self._events) == 1:
            return self._events[0]
        return np.concatenate([np.zeros((0, len(machine.EVENT_ROW))), *self._events])

    def finish(self) -> tuple[tuple[dict[str, Array], ...], dict[str, Array] | None]:
        """Samples of each window, and the Poincare samples."""
        folded = ["time", *(f"{name}_{end}" for name in _FOLDED for end in ("min", "max"))]
        shaped = [
            _columns(parts, sampling.ROW if self._fold_of(i) is None else folded) for i, parts in enumerate(self._parts)
        ]
        for samples in shaped:
            samples.pop("sampler", None)
        return tuple(shaped[: len(self._windows)]), shaped[-1] if self._poincare else None


def _columns(parts: Sequence[Array], names: Sequence[str]) -> dict[str, Array]:
    """Columns of all parts, one after the other; filled part by part, because a part fits into the cache."""
    columns = {name: np.empty(sum(map(len, parts))) for name in names}
    start = 0
    for part in parts:
        for column, values in zip(columns.values(), part.T, strict=True):
            column[start : start + len(part)] = values
        start += len(part)
    return columns


def _fold(cells: Array) -> Array:
    """Rows of mean time and (min, max) of each folded column, from cells of shape (n, samples, columns)."""
    out = [cells[:, :, _COLUMN["time"]].mean(axis=1)]
    for name in _FOLDED:
        column = cells[:, :, _COLUMN[name]]
        out += [column.min(axis=1), column.max(axis=1)]
    return np.stack(out, axis=1)


def _uniform(window: Window, start: float, t_end: float) -> tuple[float, float, float, float]:
    """First time, interval, number of samples within the run, theta."""
    interval = 1 / window.rate
    skip = max(0, math.ceil((start - window.start) * window.rate - 1e-9))
    last = min(window.count - 1, math.floor((t_end - window.start) * window.rate + 1e-9))
    return window.start + skip * interval, interval, max(0, last - skip + 1), window.theta


def _stroboscopic(poincare: Poincare, Omega: float, start: float, t_end: float) -> tuple[float, float, float, float]:
    """As `_uniform`, at whole multiples of the drive's period; none if the drive rests."""
    if Omega == 0:
        return 0.0, 1.0, 0, poincare.theta
    period = 2 * math.pi / Omega
    first = math.ceil(max(poincare.start, start) / period - 1e-9)
    last = math.floor(min(poincare.stop, t_end) / period + 1e-9)
    return first * period, period, max(0, last - first + 1), poincare.theta
