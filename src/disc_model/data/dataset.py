"""How results become files: groups of a case, CF attributes, encoding, and saving in one piece.

A case is a tree of groups, which is also how its file is laid out:

- the root holds its scalars (parameters, status, first separation, statistics), all without dimension;
- ``events`` holds one entry per switch along `event`;
- every recorded window is a group under its name, along `time`; so is ``poincare``. Their attribute ``theta`` is the
  angle in rad at which ``w_point`` was taken.

`disc_model.data.inputs` reads files, and puts many cases into one. Nothing here holds a time stamp or a duration that
differs from run to run, so that equal runs give equal bytes.

Files are whole or not there, and end in a checksum, which readers of netCDF and HDF5 pass over: HDF5 notices a changed
byte in compressed arrays only, and reads a changed scalar or attribute as if nothing had happened.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import secrets
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.data.variables import CHOICES, COUNTS, SCALARS, SERIES, STATUSES, attributes
from disc_model.errors import DiscModelError
from disc_model.flexibility import contact_give
from disc_model.parameters import Parameters

CONVENTIONS = "CF-1.11"
OVERHEAD = 1 << 18
"""About what attributes and the file format take, in bytes."""


# ----------------------------------------------------------------------------------------------------
# The groups of a case


def events_dataset(events: Any) -> xr.Dataset:
    """Switches, from a frame like `Result.events`; `time` is a coordinate along `event` (two may coincide)."""
    data = {name: ("event", _column(events, name), attributes(name)) for name in events.columns}
    return xr.Dataset(data).set_coords("time")


def samples_dataset(samples: Mapping[str, Any], theta: float) -> xr.Dataset:
    """Samples of one window along the coordinate `time`; envelopes keep their ``_min`` and ``_max``.

    theta : rad, where ``w_point`` was taken
    """
    data = {name: ("time", _narrow(name, values), attributes(name)) for name, values in samples.items()}
    return xr.Dataset(data, attrs={"theta": theta})


def failed_groups(p: Parameters, t_end: float, tol: float, message: str) -> dict[str, xr.Dataset]:
    """What stands for a case that raised an error: all its scalars, unknown but for its status."""
    values: dict[str, Any] = dict.fromkeys(SCALARS, math.nan) | dict.fromkeys(COUNTS, 0)
    values |= {"status": STATUSES.index("failed"), "t_end": t_end, "tol": tol}
    return {"": scalars_dataset(p, values, "failed", message)}


def scalars_dataset(p: Parameters, values: Mapping[str, Any], status: str, message: str) -> xr.Dataset:
    """The root of a case: what has no dimension.

    Parameters
    ----------
    values : of `SCALARS`, nan where not given; the status by its place in `STATUSES`
    status, message : in words
    """
    data: dict[str, Any] = {}
    for name in SCALARS:
        value = np.int8(values[name]) if name == "status" else values.get(name, math.nan)
        data[name] = ((), np.int64(value) if name in COUNTS else value, attributes(name))
    for name, value in (p.model_dump() | {"contact_compliance": _compliance(p)}).items():
        stored = np.int8(CHOICES[name].index(value)) if name in CHOICES else value
        data[name] = ((), stored, attributes(name))
    attrs = {
        "Conventions": CONVENTIONS,
        "parameters": p.canonical_json,
        "parameters_key": p.key,
        "status": status,
        "message": message,
    }
    return xr.Dataset(data, attrs=attrs)


def _compliance(p: Parameters) -> float:
    """Of the contact, m/N; nan where the modes leave nothing out to make it of: then the case has failed of that."""
    try:
        return contact_give(p)
    except DiscModelError:
        return math.nan


def _column(events: Any, name: str) -> np.ndarray:
    column = events[name]
    flags = SERIES[name].flags
    if not flags:
        return np.asarray(column, dtype=float)
    return pd.Categorical(column, categories=flags).codes.astype(np.int8)


def _narrow(name: str, values: Any) -> np.ndarray:
    return np.asarray(values, dtype=np.int8 if name == "phase" else float)


# ----------------------------------------------------------------------------------------------------
# Trees and files


def to_tree(groups: Mapping[str, xr.Dataset]) -> xr.DataTree:
    """Groups by name, the root under "", as a tree."""
    return xr.DataTree.from_dict({f"/{name}": dataset for name, dataset in groups.items()})


def save(tree: xr.DataTree, path: str | Path) -> None:
    """Write a tree as netCDF 4, compressed, in one piece: `path` is either what it was before or complete.

    Raises
    ------
    disc_model.data.dataset.WriteError
        If the disk is full.
    """
    encoding = _encoding(tree)
    size = sum(node.to_dataset(inherit=False).nbytes for node in tree.subtree)
    write_whole(Path(path), lambda name: tree.to_netcdf(name, engine="netcdf4", encoding=encoding), size + OVERHEAD)


def load(path: str | Path) -> xr.DataTree:
    """Read a file written by `save` into memory.

    Raises
    ------
    disc_model.data.dataset.DamagedFile
        If it is not what was written.
    """
    check_whole(Path(path))
    with xr.open_datatree(path, engine="netcdf4", decode_timedelta=False) as tree:
        return tree.load()


def json_attribute(value: Any) -> str:
    """A mapping or list as text: netCDF attributes hold neither, nor None or bool."""
    return json.dumps(value, sort_keys=True)


def _encoding(tree: xr.DataTree) -> dict[str, dict[str, Any]]:
    own = {node.path: node.to_dataset(inherit=False).variables for node in tree.subtree}
    return {path: {str(name): _encode(var) for name, var in variables.items()} for path, variables in own.items()}


def _encode(variable: xr.Variable) -> dict[str, Any]:
    if variable.dtype.kind in "UO":
        return {"dtype": "S1"}
    encoding: dict[str, Any] = {"_FillValue": None}
    if variable.ndim and variable.size:
        encoding |= {"zlib": True, "complevel": 1, "shuffle": True}
    return encoding


# ----------------------------------------------------------------------------------------------------
# Whole files

_LABEL = b"\nsha256 of the rest: "
_LENGTH = len(_LABEL) + 65


class WriteError(DiscModelError, OSError):
    """A file could not be written."""


class DamagedFile(DiscModelError):
    """A file that is not what was once written."""


def write_whole(path: Path, write: Callable[[str], object], size: int) -> None:
    """Write a file in one piece, with a checksum at its end: `path` is either what it was before or complete.

    Parameters
    ----------
    write : called with the name of a new file in the same folder, which it shall write
    size : bytes that the file will roughly have, to find out about a full disk

    Raises
    ------
    WriteError
        If the disk is full, or the file may not be that large.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    # made by `write`, so that the umask says who may read it
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(8)}.tmp")
    try:
        write(str(temporary))
        _append_checksum(temporary)
        os.replace(temporary, path)
    except Exception:
        if refusal := _refusal(temporary, size):
            reason = refusal.strerror or str(refusal)
            raise WriteError(f"{path}: cannot be written: {reason} ({size / 1e6:.1f} MB needed)") from None
        raise
    finally:
        temporary.unlink(missing_ok=True)


def check_whole(path: Path) -> None:
    """Compare a file with the checksum at its end.

    Raises
    ------
    DamagedFile
        If it does not match or is not there.
    """
    content = path.read_bytes()
    body, end = content[:-_LENGTH], content[-_LENGTH:]
    if end != _checksum(body):
        raise DamagedFile(f"{path}: damaged or not written by this version of disc_model (its checksum does not match)")


def _append_checksum(path: Path) -> None:
    end = _checksum(path.read_bytes())
    with path.open("ab") as file:
        file.write(end)
        file.flush()
        os.fsync(file.fileno())  # else a crash of the machine may leave the new name with nothing in it


def _checksum(body: bytes) -> bytes:
    return _LABEL + hashlib.sha256(body).hexdigest().encode() + b"\n"


def _refusal(temporary: Path, size: int) -> OSError | None:
    """Why so many bytes cannot be written; the netCDF library only says that they were not."""
    try:
        with temporary.open("wb") as file:
            file.write(bytes(size))
    except OSError as error:
        return error
    return None


# ----------------------------------------------------------------------------------------------------
# Tables in Markdown


def markdown_table(head: Iterable[object], rows: Iterable[Iterable[object]]) -> list[str]:
    """Lines of a table: its head, the rule below it, a line a row; a | within a cell is kept apart."""
    names = list(head)
    return [_line(names), _line(["---"] * len(names)), *map(_line, rows)]


def _line(cells: Iterable[object]) -> str:
    return "| " + " | ".join(str(cell).replace("|", r"\|") for cell in cells) + " |"
