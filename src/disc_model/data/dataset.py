"""How results become files: groups of a case, CF attributes, encoding, and saving in one piece.

A case is a tree of groups, and so is its file: the root holds what has no dimension, ``events`` an entry for each
switch along `event`; every recorded window is a group under its name, along `time`, and so is ``poincare``. Nothing
holds a time stamp or a duration that differs from run to run, so that equal runs give equal bytes.

Files are whole or not there, and end in a checksum, which readers of netCDF and HDF5 pass over: HDF5 notices a changed
byte in compressed arrays only, and reads a changed scalar or attribute as if nothing had happened.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import math
import os
import secrets
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.data.variables import CHOICES, COUNTS, SCALARS, SERIES, STATUSES, attributes
from disc_model.errors import DiscModelError, Fault, ParameterError, shown
from disc_model.parameters import RESIDUAL, Parameters

CONVENTIONS = "CF-1.11"
T = TypeVar("T")
OVERHEAD = 1 << 18
"""About what attributes and the file format take, in bytes."""


# ----------------------------------------------------------------------------------------------------
# The groups of a case


def events_dataset(events: Any) -> xr.Dataset:
    """Switches, from a frame like `Result.events`; `time` is a coordinate along `event` (two may coincide)."""
    data = {name: ("event", _column(column, SERIES[name].flags), attributes(name)) for name, column in events.items()}
    return xr.Dataset(data).set_coords("time")


def samples_dataset(samples: Mapping[str, Any], theta: float) -> xr.Dataset:
    """Samples of one window along the coordinate `time`; envelopes keep their ``_min`` and ``_max``.

    theta : rad, where ``w_point`` was taken
    """
    data = {
        name: ("time", np.asarray(values, dtype=np.int8 if name == "phase" else float), attributes(name))
        for name, values in samples.items()
    }
    return xr.Dataset(data, attrs={"theta": theta})


def failed_groups(p: Parameters, t_end: float, tol: float, message: str) -> dict[str, xr.Dataset]:
    """What stands for a case that raised an error: all its scalars, unknown but for its status."""
    known = {"status": STATUSES.index("failed"), "t_end": t_end, "tol": tol}
    return {"": scalars_dataset(p, dict.fromkeys(COUNTS, 0) | known, "failed", message)}


def scalars_dataset(p: Parameters, values: Mapping[str, Any], status: str, message: str) -> xr.Dataset:
    """The root of a case: what has no dimension.

    values : of `SCALARS`, nan where not given; the status by its place in `STATUSES`, and once more in words
    """
    data: dict[str, Any] = {}
    for name in SCALARS:
        value = np.int8(values[name]) if name == "status" else values.get(name, math.nan)
        data[name] = ((), np.int64(value) if name in COUNTS else value, attributes(name))
    disc = p.disc.model_dump_json() if p.disc else ""  # a file holds no mapping
    for name, value in (p.model_dump() | {"contact_compliance": _compliance(p), "disc": disc}).items():
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
    if p.contact_compliance != RESIDUAL:
        return float(p.contact_compliance)
    # not above: with it comes scipy, for which each job that only reads results would wait
    from disc_model.flexibility import contact_give

    try:
        return contact_give(p)
    except DiscModelError:
        return math.nan


def _column(column: Any, flags: tuple[str, ...]) -> np.ndarray:
    if flags:
        return pd.Categorical(column, categories=flags).codes.astype(np.int8)
    return np.asarray(column, dtype=float)


# ----------------------------------------------------------------------------------------------------
# Trees and files


def to_tree(groups: Mapping[str, xr.Dataset]) -> xr.DataTree:
    """Groups by name, the root under "", as a tree."""
    return xr.DataTree.from_dict({f"/{name}": dataset for name, dataset in groups.items()})


def save(tree: xr.DataTree, path: str | Path) -> None:
    """Write a tree as netCDF 4, compressed, in one piece: `path` is either what it was before or complete.

    Raises
    ------
    ParameterError
        If it is no tree, or no file can have this name.
    disc_model.data.dataset.WriteError
        If the disk is full.
    """
    if not isinstance(tree, xr.DataTree):
        raise ParameterError(Fault(("tree",), shown(tree), "must be an xarray.DataTree"))
    file, encoding = _file(path), _encoding(tree)
    size = sum(node.to_dataset(inherit=False).nbytes for node in tree.subtree)
    write_atomically(file, lambda name: tree.to_netcdf(name, engine="netcdf4", encoding=encoding), size + OVERHEAD)


def load(path: str | Path) -> xr.DataTree:
    """Read a file written by `save` into memory.

    Raises
    ------
    ParameterError
        If no file can have this name.
    disc_model.data.dataset.DamagedFile
        If it is not what was written.
    """
    verify_checksum(_file(path))
    with xr.open_datatree(path, engine="netcdf4", decode_timedelta=False) as tree:
        return tree.load()


def json_attribute(value: Any) -> str:
    """A mapping or list as text: netCDF attributes hold neither, nor None or bool."""
    return json.dumps(value, sort_keys=True)


def agreed(values: Iterable[str]) -> str:
    """A value that all share; of several the list of all, as text."""
    different = sorted(set(values))
    return different[0] if len(different) == 1 else json_attribute(different)


def _encoding(tree: xr.DataTree) -> dict[str, dict[str, Any]]:
    return {
        node.path: {str(name): _encode(var) for name, var in node.to_dataset(inherit=False).variables.items()}
        for node in tree.subtree
    }


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


LONGEST_NAME = 233
"""Bytes; that of a file still being written is longer, and file systems allow 255."""
NAME_RULE = f"must be the name of a file, of at most {LONGEST_NAME} bytes"


class WriteError(DiscModelError, OSError):
    """A file could not be written."""


class DamagedFile(DiscModelError):
    """A file that is not what was once written."""


def may_be_file(path: object) -> bool:
    """Whether a file may have such a path; see `NAME_RULE`."""
    try:
        file = Path(path)  # type: ignore[arg-type] # whether it is one is what is found out here
        name = os.fsencode(file.name)
        return (
            name not in (b"", b"..")
            and b"\0" not in os.fsencode(file)
            and len(name) <= LONGEST_NAME
            and not file.is_dir()
        )
    except (TypeError, ValueError, OSError):
        return False


def _file(path: str | Path) -> Path:
    """A path that a file may have; raises `ParameterError` otherwise."""
    if not may_be_file(path):
        raise ParameterError(Fault(("path",), shown(str(path)), NAME_RULE))
    return Path(path)


def write_atomically(path: Path, write: Callable[[str], object], size: int) -> None:
    """Write a file in one piece, with a checksum at its end: `path` is either what it was before or complete.

    Raises `WriteError` if there is no such folder, the disk is full, or the file may not be that large.

    Parameters
    ----------
    write : called with the name of a new file in the same folder, which it shall write
    size : bytes that the file will roughly have, to find out about a full disk
    """
    if not path.parent.is_dir():
        raise WriteError(f"{path}: must be in a folder that exists")
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
        with contextlib.suppress(OSError):
            temporary.unlink()


def verify_checksum(path: Path) -> None:
    """Compare a file with the checksum at its end; raises `DamagedFile` if it does not match or is not there."""
    content = path.read_bytes()
    body, end = content[:-_LENGTH], content[-_LENGTH:]
    if end != _checksum(hashlib.sha256(body)):
        raise DamagedFile(f"{path}: damaged or not written by this version of disc_model (its checksum does not match)")


def _append_checksum(path: Path) -> None:
    with path.open("r+b") as file:
        end = _checksum(hashlib.file_digest(file, "sha256"))
        file.write(end)
        file.flush()
        os.fsync(file.fileno())  # else a crash of the machine may leave the new name with nothing in it


def _checksum(digest: hashlib._Hash) -> bytes:
    return _LABEL + digest.hexdigest().encode() + b"\n"


def _refusal(temporary: Path, size: int) -> OSError | None:
    """Why so many bytes cannot be written; the netCDF library only says that they were not."""
    try:
        with temporary.open("wb") as file:
            file.write(bytes(size))
    except OSError as error:
        return error
    return None


# ----------------------------------------------------------------------------------------------------
# Reading what other jobs have written

SET_ASIDE = ".damaged"
"""Ending that a damaged file gets."""


class InputsError(DiscModelError):
    """Files that are damaged or missing: a line for each, and what to do."""


def load_inputs(paths: Sequence[Path]) -> list[xr.DataTree]:
    """Read files written by `save`; `each_intact` says what becomes of damaged ones."""
    return each_intact(load, paths)


def load_cases(paths: Sequence[Path]) -> dict[str, xr.DataTree]:
    """`load_inputs` by the names of the files, which are those of the cases."""
    return dict(zip([path.stem for path in paths], load_inputs(paths), strict=True))


def each_intact(read: Callable[[Path], T], paths: Sequence[Path]) -> list[T]:
    """Apply a function to files; raises `InputsError` if any is damaged or missing.

    Damaged ones are set aside under another name, so that the next run finds them missing and computes them anew.
    """
    found, faults = [], []
    for path in paths:
        try:
            found.append(read(path))
        except DamagedFile as error:
            faults.append(f"{error}; now called {set_aside(path).name}")
        except FileNotFoundError:
            faults.append(f"{path}: not there; another job may just have set it aside")
    if faults:
        raise InputsError("\n".join([*faults, "Run snakemake again: it computes them anew."]))
    return found


def set_aside(path: Path) -> Path:
    """Give a file another name, under which nothing looks for it."""
    aside = path.with_name(path.name + SET_ASIDE)
    with contextlib.suppress(FileNotFoundError):  # another job may just have done so
        os.replace(path, aside)
    return aside


# ----------------------------------------------------------------------------------------------------
# What the tree of one case holds, or why not: what claims and figures ask it for


class Missing(Exception):
    """Evidence that is not there. The text says why; it continues after "the case"."""


def group(case: xr.DataTree, name: str) -> xr.Dataset:
    """A window, the Poincare section ``poincare`` or ``events``, as recorded."""
    if name not in case.children:
        status = STATUSES[int(case.dataset["status"])] if "status" in case.dataset else "ok"
        raise Missing("failed" if status == "failed" else f"did not record {name}")
    return case.children[name].to_dataset(inherit=False)


def events(case: xr.DataTree) -> xr.Dataset:
    """Switches within the span ``kept_from`` to ``kept_until``."""
    found = group(case, "events")
    if "kept_from" not in found.attrs:
        raise Missing("keeps no events")
    return found


def samples(case: xr.DataTree, name: str, at_least: int = 2) -> xr.Dataset:
    """A window of single samples, no ranges; at least so many of them."""
    found = group(case, name)
    if _are_ranges(found):
        raise Missing(f"recorded {name} as ranges, not as samples: its window has an envelope")
    return _of_length(found, at_least, f"samples in {name}")


def ranges(case: xr.DataTree, name: str, at_least: int = 1) -> xr.Dataset:
    """A window of ranges, each variable as ``_min`` and ``_max``; at least so many bins."""
    found = group(case, name)
    if not _are_ranges(found):
        raise Missing(f"recorded {name} as samples, not as ranges: its window needs an envelope")
    return _of_length(found, at_least, f"bins in {name}")


def _are_ranges(window: xr.Dataset) -> bool:
    return any(str(key).endswith("_min") for key in window)


def _of_length(window: xr.Dataset, at_least: int, what: str) -> xr.Dataset:
    if window.sizes["time"] < at_least:
        raise Missing(f"has {window.sizes['time']} {what}, at least {at_least} are needed")
    return window


# ----------------------------------------------------------------------------------------------------
# Tables in Markdown


def markdown_table(head: Iterable[object], rows: Iterable[Iterable[object]]) -> list[str]:
    """Lines of a table: its head, the rule below it, a line a row; a | within a cell is kept apart."""
    names = list(head)
    return [_line(names), _line(["---"] * len(names)), *map(_line, rows)]


def _line(cells: Iterable[object]) -> str:
    return "| " + " | ".join(str(cell).replace("|", r"\|") for cell in cells) + " |"
