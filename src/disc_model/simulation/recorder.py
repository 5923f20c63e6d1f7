"""Recorded rows of a run: buffers between the engine and the arrays of a result."""

import math
import os
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from disc_model.engine import dense_output, event_loop
from disc_model.engine.audit import N_SUMS
from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Parameters
from disc_model.simulation.case import Poincare, Window, Windows

Array = NDArray[Any]

BUFFER = 1 << 15  # rows of a buffer: large enough for cheap draining, small enough to stay in the cache
SMALL_BUFFER = 1 << 8  # rows of the first buffer of events: a large one takes longer to make than a short simulation
_FOLDED = ("P", "u", "w", "w_point", "psi", "psi_velocity")
_FOLDED_ROW = ("time", *(f"{name}_{end}" for name in _FOLDED for end in ("min", "max")))


class Collector:
    """Provides the engine's `buffers`, empties them at each pause, and assembles the recorded arrays."""

    def __init__(
        self, p: Parameters, windows: Windows, events: bool, start: float, t_end: float, longest_step: float
    ) -> None:
        self._names, self._keeps_events = [*windows], events
        # samples in a bin of an envelope; None where single samples are kept
        self._folds = [getattr(window, "envelope", None) for window in windows.values()]
        grids = [_grid(window, p, start, t_end) for window in windows.values()]
        capacity = BUFFER if grids else 0
        # the engine pauses between steps only, so one step's samples must fit above ``capacity``
        longest = longest_step + dense_output.SAME_INSTANT * t_end
        per_step = sum(1 + math.ceil(min(longest / grid[1], grid[2])) for grid in grids)
        if grids:
            self._check_room([float(grid[2]) for grid in grids], per_step)
        counters, sampled = np.zeros(event_loop.N_COUNTERS, np.int64), np.zeros(len(grids), np.int64)
        samplers = np.array(grids) if grids else np.zeros((0, 5))
        sample_rows = np.empty((capacity + per_step, len(dense_output.ROW)))
        event_rows = np.empty((SMALL_BUFFER, len(event_loop.EVENT_ROW)))
        # in order, as this takes half the time that names do
        self.buffers = event_loop.RunBuffers(
            counters, np.zeros(3), np.zeros(N_SUMS), samplers, sampled, sample_rows, capacity, event_rows
        )
        self.first_separation = math.nan  # s
        # recorded arrays in order of time; those of the rest, rows of bins that are not full
        self._events: list[Array] = []
        self._samples: list[list[Array]] = [[] for _ in grids]
        self._rest: list[list[Array]] = [[] for _ in grids]

    def _check_room(self, counts: list[float], per_step: int) -> None:
        """Raise `ParameterError` if memory cannot hold the recorded rows, open bins included, and those of a step."""
        rows = [n if fold is None else n / fold + 2 * min(fold, n) for n, fold in zip(counts, self._folds, strict=True)]
        size, room = 8.0 * len(dense_output.ROW) * (sum(rows) + per_step), _memory()
        if size > room:
            path = ("windows", self._names[rows.index(max(rows))])
            rule = f"must fit into memory: {size / 1e9:.3g} GB of samples in all, and there are {room / 1e9:.3g} GB"
            raise ParameterError(Fault(path, "", rule))

    def drain(self) -> None:
        """Copy the rows from the buffers and empty them."""
        counters, event_rows = self.buffers.counters, self.buffers.event_rows
        events = event_rows[: counters[event_loop.EVENT_ROWS]]
        rows = self.buffers.sample_rows[: counters[event_loop.SAMPLE_ROWS]]
        counters[event_loop.EVENT_ROWS] = counters[event_loop.SAMPLE_ROWS] = 0
        if counters[event_loop.SEPARATIONS] > 0 and math.isnan(self.first_separation):
            self.first_separation = events[events[:, 1] == event_loop.LOSS_OF_CONTACT][0, 0].item()
        if self._keeps_events and len(events):
            self._events.append(events.copy())
        if len(events) > len(event_rows) - event_loop.MAX_EVENTS_PER_STEP:  # the small buffer was full
            self.buffers = self.buffers._replace(event_rows=np.empty((BUFFER, len(event_loop.EVENT_ROW))))
        for i, (fold, samples, rest) in enumerate(zip(self._folds, self._samples, self._rest, strict=True)):
            if len(new := rows[rows[:, 0] == i]):  # a copy, as of every index that is a mask
                (samples if fold is None else rest).append(new)
            if fold is not None and sum(map(len, rest)) >= fold:
                together = np.concatenate(rest)
                whole = len(together) // fold * fold
                rest[:] = [together[whole:].copy()]
                samples.append(_fold(together[:whole].reshape(-1, fold, together.shape[1])))

    def events(self) -> Array:
        """All recorded events, shape (n, len(EVENT_ROW))."""
        if len(self._events) == 1:  # of most runs, whose rows are not copied once more
            return self._events[0]
        return np.concatenate([np.zeros((0, len(event_loop.EVENT_ROW))), *self._events])

    def finish(self) -> dict[str, dict[str, Array]]:
        """Samples of each window."""
        names = [dense_output.ROW if fold is None else _FOLDED_ROW for fold in self._folds]
        return dict(zip(self._names, map(_columns, self._samples, names), strict=True))


def _columns(parts: list[Array], names: Sequence[str]) -> dict[str, Array]:
    """Columns of all parts, filled part by part, as a part fits into the cache. Each part is removed from the list, so
    that memory never holds more than one part twice."""
    columns = {name: np.empty(sum(map(len, parts))) for name in names}
    start = 0
    parts.reverse()
    while parts:
        part = parts.pop()
        for column, values in zip(columns.values(), part.T, strict=True):
            column[start : start + len(part)] = values
        start += len(part)
    columns.pop("sampler", None)
    return columns


def _fold(cells: Array) -> Array:
    """Rows of mean time and (min, max) of each folded column, from cells of shape (n, samples, columns)."""
    columns = [cells[:, :, dense_output.ROW.index(name)] for name in ("time", *_FOLDED)]
    ranges = [bound for column in columns[1:] for bound in (column.min(axis=1), column.max(axis=1))]
    return np.stack([columns[0].mean(axis=1), *ranges], axis=1)


def _memory() -> float:
    """Size of this machine's memory in bytes; infinite where the system does not tell it."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return math.inf


def _grid(window: Window | Poincare, p: Parameters, start: float, t_end: float) -> tuple[float, ...]:
    """Sampling grid of a window in a run, as `dense_output.sample_step` has it; without samples if the drive rests."""
    if isinstance(window, Window):
        interval = min(1 / window.rate, sys.float_info.max)
        skipped = max(0.0, (start - window.start) * window.rate - 1e-9)
        reached = min(window.last_sample, (t_end - window.start) * window.rate + 1e-9)
        if not skipped <= reached < math.inf:
            return start, interval, 0, window.theta, t_end
        index, last = math.ceil(skipped), math.floor(reached)
        first = window.start + index * interval
    elif p.Omega == 0:
        return 0.0, 1.0, 0, window.theta, t_end
    else:
        interval = min(2 * math.pi / p.Omega, sys.float_info.max)
        index = math.ceil(max(window.start, start) / interval - 1e-9)
        last = math.floor(min(window.stop, t_end) / interval + 1e-9)
        first = index * interval
    return first, interval, max(0, last - index + 1), window.theta, t_end
