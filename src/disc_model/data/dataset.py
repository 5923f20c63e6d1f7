"""Files of results. A case is a tree of groups: its root holds the scalars, ``events`` has an entry
for each along `event`, and each window, ``poincare`` too, is along `time`. No time stamps or run
times are stored, so that equal runs give equal bytes."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import xarray as xr
from netCDF4 import Dataset
from xarray.backends import NetCDF4DataStore

from disc_model.data.described import describe_run
from disc_model.data.files import (
    MissingFile,
    UnreadableFile,
    WriteError,
    regular_file,
    unreadable,
    write_atomically,
)
from disc_model.data.variables import STATUSES
from disc_model.errors import require

__all__ = ["MissingFile", "UnreadableFile", "WriteError", "load", "save"]

CONVENTIONS = "CF-1.11"


# ---- Trees and files


def save(tree: xr.DataTree, path: str | Path, *, compressed: bool = True) -> None:
    """Write a tree as netCDF 4, atomically; raises `ParameterError` for what is no tree, or
    `WriteError`."""
    require(
        (isinstance(tree, xr.DataTree), "tree", tree, "must be an xarray.DataTree"),
        (isinstance(compressed, bool), "compressed", compressed, "must be True or False"),
    )

    write_atomically(regular_file(path), partial(_write, tree, compressed=compressed))


def _write(tree: xr.DataTree, name: str, *, compressed: bool) -> None:
    """Write a new file of a tree, with all groups defined before an array is written.
    `DataTree.to_netcdf` writes each array as soon as it is defined, after a pass through all of the
    file's metadata: eight times the time for 70 cases."""
    arrays: list[tuple[Any, Any]] = []
    collector = SimpleNamespace(add=lambda source, target: arrays.append((source, target)))
    with Dataset(name, "w") as root:
        for node in tree.subtree:
            group = node.to_dataset(inherit=node is tree)
            store = NetCDF4DataStore(
                root if node is tree else root.createGroup(node.relative_to(tree))
            )
            encoding = {
                str(name): _encode(variable, compressed)
                for name, variable in group.variables.items()
            }
            group.dump_to_store(store, encoding=encoding, writer=collector)
        for source, target in arrays:
            target[...] = source


def load(path: str | Path) -> xr.DataTree:
    """Read a netCDF file as a tree, into memory; raises `ParameterError`, `UnreadableFile` or
    `MissingFile`."""
    file = regular_file(path)
    try:
        groups = xr.open_groups(file, engine="netcdf4", decode_timedelta=False)
        try:
            # a tree of loaded groups is made in three quarters of the time of a tree that is loaded,
            # and DataTree.load skips a variable with its group's name
            return xr.DataTree.from_dict({name: each.load() for name, each in groups.items()})
        finally:
            for each in groups.values():
                each.close()
    except FileNotFoundError:
        raise MissingFile(f"{file}: there is no such file") from None
    except Exception as error:  # whatever a file of another kind leads the libraries to
        raise unreadable(file, getattr(error, "strerror", None) or error) from error


def json_attribute(value: Any) -> str:
    """A mapping or list as JSON text, because netCDF attributes cannot hold these, None or bool."""
    return json.dumps(value, sort_keys=True)


def common_provenance(datasets: Sequence[xr.Dataset]) -> dict[str, str]:
    """Attributes that say what made datasets; a value that differs between them becomes the list of
    all, as text."""
    names = ("source_hash", "git_commit", "versions")
    provenance = {}
    for name in names:
        texts = {str(each.attrs[name]) for each in datasets if name in each.attrs}
        if len(texts) == 1:
            provenance[name] = min(texts)
        elif texts:
            provenance[name] = json_attribute(sorted(texts))
    return provenance


def _encode(variable: xr.Variable, compressed: bool) -> dict[str, Any]:
    """Encoding with the checksums of HDF5 (fletcher32), which every reader compares."""
    if variable.dtype.kind in "UO":
        return {"dtype": "S1"}
    encoding: dict[str, Any] = {"_FillValue": None}
    if variable.ndim and variable.size:
        encoding["fletcher32"] = True
        if compressed:
            encoding |= {"zlib": True, "complevel": 1, "shuffle": True}
    return encoding


# ---- Several files


def load_cases(paths: Iterable[str | Path]) -> dict[str, xr.DataTree]:
    """Trees by the names of their files, such as those of cases or studies; raises `UnreadableFile`
    with a remedy."""
    return {Path(path).stem: load_result(path) for path in paths}


def load_result(path: str | Path) -> xr.DataTree:
    """As `load`, of a file of a study's results: `UnreadableFile` has a remedy, and the variables of a run
    say what they are in today's words."""
    try:
        tree = load(path)
    except UnreadableFile as error:
        raise UnreadableFile(f"{error}\nDelete it, and run the same command again") from None
    if "parameters_key" in tree.attrs:
        describe_run(tree)
    return tree


# ---- Access to the tree of one case, for claims and figures; a missing part is explained


class Missing(Exception):
    """Data that a case does not hold. The text gives the reason; it continues a sentence that
    begins "the case"."""


def group(case: xr.DataTree, name: str) -> xr.Dataset:
    """A window, the Poincare section ``poincare`` or ``events``, as recorded."""
    if name not in case.children:
        known = case.dataset
        if "status" in known and STATUSES[int(known["status"])] == "failed":
            raise Missing("failed")
        raise Missing(f"did not record {name}")
    return case.children[name].to_dataset(inherit=False)


def events(case: xr.DataTree) -> xr.Dataset:
    """Events within the span ``kept_from`` to ``kept_until``."""
    table = group(case, "events")
    if "kept_from" not in table.attrs:
        raise Missing("keeps no events")
    return table


def samples(
    case: xr.DataTree, name: str, at_least: int = 2, *, envelope: bool = False
) -> xr.Dataset:
    """A window of at least `at_least` samples; or bins of an `envelope`, each variable as ``_min``
    and ``_max``."""
    window = group(case, name)
    if any(str(key).endswith("_min") for key in window) != envelope:
        instead = "ranges, not as samples: its window has"
        if envelope:
            instead = "samples, not as ranges: its window needs"
        raise Missing(f"recorded {name} as {instead} an envelope")
    length = window.sizes["time"]
    if length < at_least:
        kept = "samples"
        if envelope:
            kept = "bins"
        raise Missing(f"has {length} {kept} in {name}, at least {at_least} are needed")
    return window


def markdown_table(head: Iterable[object], rows: Iterable[Iterable[object]]) -> list[str]:
    """Lines of a table: its head, the rule below it, and one line for each row; a | within a cell
    is escaped."""
    names = [*head]
    lines = [_table_line(names), _table_line(["---"] * len(names))]
    lines += [_table_line(row) for row in rows]
    return lines


def _table_line(row: Iterable[object]) -> str:
    """Return a line of a table in Markdown."""
    cells = [str(cell).replace("|", r"\|") for cell in row]
    return f"| {' | '.join(cells)} |"
