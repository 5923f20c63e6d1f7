"""Checkpoints: an interrupted simulation goes on from the last one as if nothing had happened.

The file of a run is a sequence of records, each with the state of the engine and the rows kept since the record before,
so that a long run that keeps much writes all of it once and not again at every checkpoint. A record ends in a checksum:
one that was cut off when the machine went down, or changed since, is not used, nor is any after it. The records before
it are, but only by the very same run: same arguments, same sources, same versions. A checkpoint of another run, or a
file that is none, is set aside under another name, with a warning that says why.
"""

from __future__ import annotations

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
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.simulation.record import Record

log = logging.getLogger(__name__)

SET_ASIDE = ".other"
"""Ending that gets what stands in the checkpoint's place but is none of this run."""

Array = NDArray[Any]

_MAGIC = b"discCkpt"
_HEAD = struct.Struct("<8sQQ")  # magic, bytes of the table of contents, bytes of the arrays
_CHECKSUM = struct.Struct("<I")


class Contents(NamedTuple):
    """What a run needs to go on: ``state`` is replaced by each record, ``rows`` only ever grow."""

    state: Mapping[str, Array]
    rows: Mapping[str, Sequence[Array]]


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
    is_number = isinstance(every, int | float | np.floating | np.integer) and not isinstance(every, bool)
    if not is_number or not 0 <= float(every) < math.inf:  # type: ignore[arg-type]
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
        state: Mapping[str, Array] = {}
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
    state = {name: [array] for name, array in contents.state.items()}
    rows = {name: arrays for name, arrays in contents.rows.items() if arrays}
    pieces = [np.ascontiguousarray(array).data for arrays in (*state.values(), *rows.values()) for array in arrays]
    table = json.dumps({"belongs_to": belongs_to, "state": _entries(state), "rows": _entries(rows)}).encode()
    table += b" " * (-len(table) % 8)  # keeps the arrays aligned
    head, checksum = _HEAD.pack(_MAGIC, len(table), sum(piece.nbytes for piece in pieces)), 0
    for piece in (memoryview(head), memoryview(table), *pieces):
        checksum = zlib.crc32(piece, checksum)
        file.write(piece)
    file.write(_CHECKSUM.pack(checksum))


def _entries(named: Mapping[str, Sequence[Array]]) -> dict[str, tuple[str, list[int]]]:
    """Types and shapes for the table of contents."""
    return {
        name: (arrays[0].dtype.str, [sum(map(len, arrays)), *arrays[0].shape[1:]]) for name, arrays in named.items()
    }


def _records(path: Path) -> Iterator[tuple[int, dict[str, str], Contents]]:
    """The file's records: where each ends, whose it is, what it holds.

    Raises
    ------
    _Damaged
        At the first record that is not whole.
    """
    size = path.stat().st_size
    with open(path, "rb") as file:
        while file.tell() < size:
            head = file.read(_HEAD.size)
            magic, n_table, n_data = _HEAD.unpack(head.ljust(_HEAD.size))
            if magic != _MAGIC:
                raise _Damaged("not a checkpoint, or damaged")
            if file.tell() + n_table + n_data + _CHECKSUM.size > size:
                raise _Damaged("cut off")
            body = file.read(n_table + n_data)
            if file.read(_CHECKSUM.size) != _CHECKSUM.pack(zlib.crc32(body, zlib.crc32(head))):
                raise _Damaged("damaged, its checksum does not match")
            table, data = json.loads(body[:n_table]), memoryview(body)[n_table:]
            state, data = _arrays(table["state"], data)
            rows, _ = _arrays(table["rows"], data)
            yield file.tell(), table["belongs_to"], Contents(state, {name: [array] for name, array in rows.items()})


def _arrays(table: Mapping[str, Any], data: memoryview) -> tuple[dict[str, Array], memoryview]:
    """The arrays of one part of the table of contents, and the data that follow theirs."""
    found: dict[str, Array] = {}
    for name, (kind, shape) in table.items():
        found[name] = np.ndarray(shape, kind, buffer=data)
        data = data[found[name].nbytes :]
    return found, data
