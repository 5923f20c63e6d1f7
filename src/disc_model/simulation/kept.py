"""What a run keeps: rows, as the engine gives them, and checkpoints, from which it goes on.

A simulation that was interrupted goes on from its last checkpoint as if nothing had happened. The file of a run is a
sequence of records, each with the state of the engine and the rows kept since the record before, so that a long run
that keeps much writes all of it once and not again at every checkpoint. A record has a checksum: one that was cut off
when the machine went down, or changed since, is not used, nor is any after it. The records before it are, but only by
the very same run: same arguments, same sources, same versions. A checkpoint of another run, or a file that is none, is
set aside under another name, with a warning that says why.
"""

from __future__ import annotations

import io
import json
import logging
import math
import os
import struct
import time as clock
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.data.provenance import source_hash, versions
from disc_model.engine import machine, sampling
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters, is_number
from disc_model.simulation.case import Poincare, Record, Window

# ----------------------------------------------------------------------------------------------------
# Checkpoints

log = logging.getLogger(__name__)

SET_ASIDE = ".other"
"""Ending that gets what stands in the checkpoint's place but is none of this run."""

Array = NDArray[Any]

_MAGIC = b"discArys"
_HEAD = struct.Struct("<8sQI")  # magic, bytes of the arrays (as `numpy.savez` writes them) and their checksum


class Contents(NamedTuple):
    """What a run needs to go on: ``state`` is replaced by each record, ``rows`` only ever grow."""

    state: dict[str, Array]
    rows: dict[str, list[Array]]


class _Damaged(Exception):
    """A record that is not what was written."""


def identity(
    p: Parameters, t_end: float, tol: float, record: Record, stop_at: str | None, max_steps: int, start: Iterable[Array]
) -> dict[str, str]:
    """All that decides a run's result, by name; ``start`` are the arrays of the state it starts from."""
    return {
        "parameters": p.canonical_json,
        "t_end": repr(t_end),
        "tol": repr(tol),
        "record": repr(record),
        "stop_at": str(stop_at),
        "max_steps": str(max_steps),
        "initial state": " ".join(array.tobytes().hex() for array in start),
        "sources": source_hash("disc_model.simulation.api"),
        "versions": json.dumps(versions(), sort_keys=True),
    }


def faults(path: object, every: object) -> Iterator[str]:
    """What is wrong with the arguments ``checkpoint`` and ``checkpoint_every`` of `disc_model.simulation.api`."""
    if path is not None and not _may_be_file(path):
        yield f"checkpoint={str(path)!r}: must be a file in a folder that exists"
    if not is_number(every) or not 0 <= float(every) < math.inf:  # type: ignore[arg-type]
        yield f"checkpoint_every={every!r}: must be finite and >= 0"


def _may_be_file(path: object) -> bool:
    try:
        file = Path(path)  # type: ignore[arg-type] # whether it is one is what is found out here
        return file.name not in ("", "..") and "\0" not in file.name and file.parent.is_dir() and not file.is_dir()
    except (TypeError, ValueError, OSError):
        return False


def _is_something_else(path: Path) -> bool:
    """Whether a file does not begin like a checkpoint, nor like one whose first bytes could not be written."""
    try:
        with path.open("rb") as file:
            return not _MAGIC.startswith(file.read(len(_MAGIC)))
    except OSError:
        return False


class Checkpoint:
    """The file of one run.

    Parameters
    ----------
    path : where; not to be shared by runs at the same time
    every : s of wall time between two records
    belongs_to : the run's `identity`
    """

    def __init__(self, path: str | os.PathLike[str], every: float, belongs_to: Mapping[str, str]) -> None:
        self.path, self.every, self.belongs_to = Path(path), every, dict(belongs_to)
        self._size = 0  # of the file's records that are this run's, in bytes
        self._written: dict[str, int] = {}  # how many arrays of rows they hold, by name
        self._next = clock.monotonic() + every

    def load(self) -> Contents | None:
        """What the file's records hold that are whole and of this very run; None if there are none."""
        state: dict[str, Array] = {}
        rows: dict[str, list[Array]] = {}
        differing: list[str] = []
        if _is_something_else(self.path):
            self._set_aside("not a checkpoint")
            return None
        try:
            for end, belongs_to, contents in _records(self.path):
                if differing := [name for name, value in self.belongs_to.items() if belongs_to.get(name) != value]:
                    break
                state, self._size = contents.state, end
                for name, arrays in contents.rows.items():
                    rows.setdefault(name, []).extend(arrays)
        except FileNotFoundError:
            return None
        except (OSError, _Damaged) as error:
            log.warning("checkpoint %s ignored from byte %d on: %s", self.path, self._size, error)
        if differing:
            # outside of the try: a run whose file cannot be got out of the way must not write over it
            self._set_aside(f"of another run (other {', '.join(differing)})")
            return None
        self._written = {name: len(arrays) for name, arrays in rows.items()}
        return Contents(state, rows) if self._size else None

    def _set_aside(self, why: str) -> None:
        aside = self.path.with_name(self.path.name + SET_ASIDE)
        try:
            os.replace(self.path, aside)
        except OSError as error:
            raise ParameterError(
                f"checkpoint={str(self.path)!r}: is {why} and cannot be renamed ({error.strerror})"
            ) from None
        log.warning("checkpoint %s ignored: %s; it is now called %s", self.path, why, aside.name)

    @property
    def due(self) -> bool:
        """Whether it is time for the next record."""
        return clock.monotonic() >= self._next

    def save(self, contents: Contents) -> None:
        """Add a record; if that fails, the run goes on and the records that there are stay."""
        try:
            if not self.path.exists() or self.path.stat().st_size < self._size:  # someone removed or cut it
                self._size, self._written = 0, {}
            new = {name: arrays[self._written.get(name, 0) :] for name, arrays in contents.rows.items()}
            with open(self.path, "r+b" if self._size else "wb") as file:
                file.truncate(self._size)  # what there is beyond was cut off, or could not be written
                file.seek(self._size)
                _write(file, self.belongs_to, Contents(contents.state, new))
                size = file.tell()
        except OSError as error:
            log.warning("checkpoint %s not written: %s", self.path, error)
        else:
            self._size = size
            self._written = {name: len(arrays) for name, arrays in contents.rows.items()}
        self._next = clock.monotonic() + self.every

    def remove(self) -> None:
        """Remove the file of a complete run; one that this run neither used nor wrote stays."""
        if self._size:
            self.path.unlink(missing_ok=True)


def _write(file: BinaryIO, belongs_to: Mapping[str, str], contents: Contents) -> None:
    """Write one record.  Arrays of rows of one name become one array."""
    arrays: dict[str, Any] = {f"state/{name}": array for name, array in contents.state.items()}
    arrays |= {f"rows/{name}": np.concatenate(parts) for name, parts in contents.rows.items() if parts}
    body = io.BytesIO()
    np.savez(body, belongs_to=np.array(json.dumps(belongs_to)), **arrays)
    file.write(_HEAD.pack(_MAGIC, body.tell(), zlib.crc32(body.getbuffer())))
    file.write(body.getbuffer())


def _records(path: Path) -> Iterator[tuple[int, dict[str, str], Contents]]:
    """The file's records: where each ends, whose it is, what it holds; raises `_Damaged` at one that is not whole."""
    size = path.stat().st_size
    with open(path, "rb") as file:
        while file.tell() < size:
            magic, length, checksum = _HEAD.unpack(file.read(_HEAD.size).ljust(_HEAD.size))
            if magic != _MAGIC:
                raise _Damaged("not a checkpoint, or damaged")
            if file.tell() + length > size:
                raise _Damaged("cut off")
            body = file.read(length)
            if zlib.crc32(body) != checksum:
                raise _Damaged("damaged, its checksum does not match")
            held = dict(np.load(io.BytesIO(body)))
            belongs_to, contents = json.loads(str(held.pop("belongs_to"))), Contents({}, {})
            for entry, array in held.items():
                part, _, name = entry.partition("/")
                if part == "state":
                    contents.state[name] = array
                else:
                    contents.rows[name] = [array]
            yield file.tell(), belongs_to, contents


# ----------------------------------------------------------------------------------------------------
# Rows: buffers between the engine and the arrays that a result keeps

BUFFER = 1 << 15  # rows of a buffer: large enough that draining costs nothing, small enough to stay in the cache
SMALL_BUFFER = 1 << 8  # of the rows of events at first: a large one takes longer to make than a short simulation
_COLUMN = {name: i for i, name in enumerate(sampling.ROW)}
_FOLDED = ("P", "u", "w", "w_point", "psi", "psi_velocity")
_FOLDED_ROW = ("time", *(f"{name}_{end}" for name in _FOLDED for end in ("min", "max")))


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
        self.first_separation = math.nan
        """Time of the first loss of contact, s; nan if there was none."""

    def position(self) -> dict[str, NDArray[Any]]:
        """What the rest of the run depends on.  Only just after `drain`: the buffers are not part of it."""
        rest = {f"rest_{i}": rows for i, rows in enumerate(self._rest)}
        return {"sampled": self.sampled, "first_separation": np.array([self.first_separation]), **rest}

    def kept(self) -> dict[str, list[Array]]:
        """What was kept so far: lists that only grow."""
        return {"events": self._events} | {f"samples_{i}": parts for i, parts in enumerate(self._parts)}

    def restore(self, position: Mapping[str, NDArray[Any]], kept: Mapping[str, Sequence[Array]]) -> None:
        """Go on from what `position` and `kept` gave."""
        self.sampled[:], self.first_separation = position["sampled"], float(position["first_separation"][0])
        self._rest = [position[f"rest_{i}"] for i in range(len(self._rest))]
        for name, parts in self.kept().items():
            parts[:] = kept.get(name, ())

    def drain(self, counters: NDArray[np.int64]) -> None:
        """Take over what the buffers hold and empty them."""
        n_events, n_rows = int(counters[machine.EVENT_ROWS]), int(counters[machine.SAMPLE_ROWS])
        counters[machine.EVENT_ROWS] = counters[machine.SAMPLE_ROWS] = 0
        if n_events:
            self._take_events(self.event_rows[:n_events], separated=counters[machine.SEPARATIONS] > 0)
        if n_events > len(self.event_rows) - machine.MAX_EVENTS_PER_STEP:  # it was full
            self.event_rows = np.empty((BUFFER, len(machine.EVENT_ROW)))
        rows = self.rows[:n_rows]
        for i in range(len(self.sampled)):
            self._take(i, rows[rows[:, 0] == i])

    def _take_events(self, events: Array, separated: bool) -> None:
        if separated and math.isnan(self.first_separation):
            lost = np.flatnonzero(events[:, 1] == machine.LOSS_OF_CONTACT)
            if lost.size:
                self.first_separation = float(events[lost[0], 0])
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
        shaped = [
            _columns(parts, sampling.ROW if self._fold_of(i) is None else _FOLDED_ROW)
            for i, parts in enumerate(self._parts)
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
