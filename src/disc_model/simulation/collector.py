"""Recorded rows of a run: buffers between the engine and the arrays of a result."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping

import numpy as np

from disc_model.engine import audit, record
from disc_model.errors import Fault, ParameterError
from disc_model.simulation.case import SampleTimes, Windows
from disc_model.simulation.result import BIN_ROW, FOLDED, SAMPLE_ROW
from disc_model.simulation.states import Array

# rows of samples between two pauses: large enough for cheap draining, small enough for the cache
BUFFER = 1 << 15
# events between two pauses: a larger buffer takes longer to make than a short simulation
EVENT_BUFFER = 1 << 10


class Collector:
    """Provides the engine's `buffers`, empties them at each pause, and assembles the recorded
    arrays."""

    def __init__(
        self,
        grids: Mapping[str, SampleTimes],
        windows: Windows,
        events: bool,
        t_end: float,
        longest_step: float,
    ) -> None:
        # the engine pauses between steps only, so one step's samples must fit above ``capacity``
        longest = longest_step + record.SAME_INSTANT * t_end
        per_step = 0
        folds: dict[str, int] = {}
        rows: dict[str, float] = {}
        for name, grid in grids.items():
            per_step += 1 + math.ceil(min(longest / grid.interval, grid.number))
            folds[name] = getattr(windows[name], "envelope", None) or 1
            rows[name] = float(grid.number) / folds[name]
        _require_memory(rows, per_step)

        self.samples = {name: _Samples(grid.number, folds[name]) for name, grid in grids.items()}
        self.first_separation = math.nan  # s
        self.keeps_events = events
        self.events: list[Array] = []
        capacity = 0
        samplers = np.zeros((0, 5))
        if grids:
            capacity = BUFFER
            samplers = np.array([*grids.values()])
        self.buffers = record.RunBuffers(
            np.zeros(record.N_COUNTERS, np.int64),
            np.zeros(3),
            np.zeros(audit.N_SUMS),
            samplers,
            np.zeros(len(grids), np.int64),
            np.empty((capacity + per_step, len(record.SAMPLE_ROW))),
            capacity,
            np.empty((EVENT_BUFFER, len(record.EVENT_ROW))),
        )

    def drain(self) -> None:
        """Copy the rows from the buffers and empty them."""
        counters = self.buffers.counters
        events = self.buffers.event_rows[: counters[record.EVENT_ROWS]]
        rows = self.buffers.sample_rows[: counters[record.SAMPLE_ROWS]]
        counters[record.EVENT_ROWS] = counters[record.SAMPLE_ROWS] = 0
        if counters[record.SEPARATIONS] > 0 and math.isnan(self.first_separation):
            self.first_separation = events[events[:, 1] == record.LOSS_OF_CONTACT][0, 0].item()
        if not self.keeps_events:
            events = events[:0]
        self.events.append(events.copy())
        for i, samples in enumerate(self.samples.values()):
            new = rows[rows[:, 0] == i]
            if len(new):
                samples.add(new)


class _Samples:
    """Samples of a window, or bins of an envelope, in columns for as many as there may be, of which
    some are filled."""

    def __init__(self, count: int, fold: int) -> None:
        names: tuple[str, ...] = SAMPLE_ROW
        if fold > 1:
            names = BIN_ROW
        self.columns = {name: np.empty(count // fold) for name in names}
        self.fold = fold
        self.filled = 0
        self.rest = np.empty((0, len(record.SAMPLE_ROW)))  # rows of the bin that is not full

    def add(self, rows: Array) -> None:
        """Take in rows of the engine in order of time."""
        done = rows[:, 1:]
        if self.fold > 1:
            rows = np.concatenate([self.rest, rows])
            whole = len(rows) // self.fold * self.fold
            self.rest = rows[whole:]
            done = _fold(rows[:whole].reshape(-1, self.fold, rows.shape[1]))
        for column, values in zip(self.columns.values(), done.T, strict=True):
            column[self.filled : self.filled + len(done)] = values
        self.filled += len(done)

    def arrays(self) -> dict[str, Array]:
        """What was recorded, by name."""
        return {name: column[: self.filled] for name, column in self.columns.items()}


def _fold(cells: Array) -> Array:
    """Rows of mean time and (min, max) of each folded column, from cells of shape (n, samples,
    columns)."""
    time = cells[:, :, record.SAMPLE_ROW.index("time")]
    folded = [time.mean(axis=1)]
    for name in FOLDED:
        column = cells[:, :, record.SAMPLE_ROW.index(name)]
        folded += [column.min(axis=1), column.max(axis=1)]
    return np.stack(folded, axis=1)


def _require_memory(rows: Mapping[str, float], per_step: int) -> None:
    """Raise `ParameterError` unless the rows of windows, and those of a step, fit into memory."""
    if not rows:
        return
    size = 8.0 * len(record.SAMPLE_ROW) * (sum(rows.values()) + per_step)
    memory = _memory()
    if size > memory:
        largest = max(rows, key=rows.__getitem__)
        rule = (
            f"must fit into memory: {size / 1e9:.3g} GB of samples in all, "
            f"and there are {memory / 1e9:.3g} GB"
        )
        raise ParameterError(Fault(("windows", largest), "", rule))


def _memory() -> float:
    """Size of this machine's memory in bytes; infinite where the system does not tell it."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return math.inf
