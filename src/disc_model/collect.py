"""Buffers between the engine and the arrays that a result keeps."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from disc_model.engine import machine, sampling, switches
from disc_model.parameters import Parameters
from disc_model.record import Poincare, Record, Window

Array = NDArray[np.float64]

BUFFER = 1 << 15  # rows of a buffer: large enough that draining costs nothing, small enough to stay in the cache
_COLUMN = {name: i for i, name in enumerate(sampling.ROW)}
_SAMPLED = sampling.ROW[1:]
_FOLDED = ("P", "u", "w", "w_point", "psi", "psi_velocity")


class Collector:
    """Hands the engine its buffers, empties them when it pauses, and shapes what was kept."""

    def __init__(self, p: Parameters, record: Record, start: float, t_end: float, longest_step: float) -> None:
        self._windows = list(record.windows)
        grids = [_uniform(window, start, t_end) for window in record.windows]
        if record.poincare is not None:
            grids.append(_stroboscopic(record.poincare, p.Omega, start, t_end))
        self.samplers: Array = np.array(grids, dtype=float).reshape(-1, 4)
        self.sampled = np.zeros(len(grids), np.int64)
        # the engine pauses between steps only, so one step's samples must fit above ``capacity``
        per_step = sum(1 + math.ceil(min(longest_step / grid[1], grid[2])) for grid in grids)
        self.capacity = BUFFER if grids else 0
        self.rows = np.zeros((self.capacity + per_step if grids else 0, len(sampling.ROW)))
        self.event_rows = np.zeros((BUFFER, len(machine.EVENT_ROW)))
        self._keep_events = record.events
        self._events: list[Array] = []
        self._parts: list[list[Array]] = [[] for _ in grids]
        self._rest: list[Array] = [np.zeros((0, len(sampling.ROW))) for _ in grids]
        self._poincare = record.poincare is not None
        self.first_separation = math.nan

    def drain(self, counters: NDArray[np.int64]) -> None:
        """Take over what the buffers hold and empty them."""
        events = self.event_rows[: counters[machine.EVENT_ROWS]]
        if math.isnan(self.first_separation):
            lost = np.flatnonzero(events[:, 1] == switches.LOSS_OF_CONTACT)
            if lost.size:
                self.first_separation = float(events[lost[0], 0])
        if self._keep_events and len(events):
            self._events.append(events.copy())
        counters[machine.EVENT_ROWS] = 0
        rows = self.rows[: counters[machine.SAMPLE_ROWS]]
        for i in range(len(self.samplers)):
            self._take(i, rows[rows[:, 0] == i])
        counters[machine.SAMPLE_ROWS] = 0

    def _take(self, i: int, rows: Array) -> None:
        fold = self._windows[i].envelope if i < len(self._windows) else None
        if fold is None:
            self._parts[i].append(rows.copy())
            return
        rows = np.concatenate((self._rest[i], rows))
        whole = len(rows) // fold * fold
        self._rest[i] = rows[whole:]
        if whole:
            self._parts[i].append(_fold(rows[:whole].reshape(-1, fold, rows.shape[1])))

    def events(self) -> Array:
        """All events kept, shape (n, len(EVENT_ROW))."""
        return np.concatenate([np.zeros((0, len(machine.EVENT_ROW))), *self._events])

    def finish(self) -> tuple[tuple[dict[str, Array], ...], dict[str, Array] | None]:
        """Samples of each window, and the Poincare samples."""
        shaped = []
        for i, parts in enumerate(self._parts):
            fold = self._windows[i].envelope if i < len(self._windows) else None
            width = len(sampling.ROW) if fold is None else 1 + 2 * len(_FOLDED)
            table = np.concatenate([np.zeros((0, width)), *parts])
            if fold is None:
                shaped.append({name: np.ascontiguousarray(table[:, _COLUMN[name]]) for name in _SAMPLED})
            else:
                names = ["time", *(f"{name}_{end}" for name in _FOLDED for end in ("min", "max"))]
                shaped.append({name: np.ascontiguousarray(table[:, j]) for j, name in enumerate(names)})
        return tuple(shaped[: len(self._windows)]), shaped[-1] if self._poincare else None


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
