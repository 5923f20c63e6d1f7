"""Files of results. A case is a tree of groups: its root holds the scalars, ``events`` has an entry
for each along `event`, and each window, ``poincare`` too, is along `time`. No time stamps or run
times are stored, so that equal runs give equal bytes."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import Any

import xarray as xr
from xarray import Dataset

from disc_model.data.coded import table_of
from disc_model.data.files import (
    MissingFile,
    UnreadableFile,
    WriteError,
    regular_file,
    unreadable,
    write_atomically,
)
from disc_model.data.variables import STATUSES, Entries
from disc_model.errors import Fault, ParameterError, require

__all__ = ["MissingFile", "UnreadableFile", "WriteError", "load", "save"]

CONVENTIONS = "CF-1.11"


# ---- Writing


def save(data: Any, path: str | Path) -> None:
    """Write a dataset, such as `sweep` and `run_study` return, to a file: whole, for `disc_model.load`, or as a table.

    Parameters
    ----------
    data : an xarray.Dataset or xarray.DataTree of numbers and words. A `Branch` and what `critical` returns are written
        as the dataset of their method `to_dataset`, and an xarray.DataArray that has a name as a dataset of it alone. A
        `Result` is written by its method `save`, to .nc, and read by its method `load`
    path : its suffix says how. ".nc": netCDF 4. ".csv": a table of pandas with a row for each point, units in the
        heads, such as "Omega (rad s-1)", and words for what stands as numbers in `data`. Numbers that stand along
        fewer dimensions are repeated: choose some, as by ``data[["crossing_Omega", "crossing_multiple"]]``. Tables are
        for other programs: `load` reads none

    Returns
    -------
    None

    Raises
    ------
    ParameterError
        If the file has another suffix, or the dataset holds what such a file cannot, as a table a tree.
    disc_model.data.dataset.WriteError
        If the folder does not exist, or the disk is full.

    Examples
    --------
    >>> import disc_model as dm
    >>> cycles = dm.sweep(dm.floquet, dm.Parameters(N=385, Omega=15), Omega=[12, 14])
    >>> dm.save(cycles, "cycles.nc")
    >>> dm.load("cycles.nc").identical(cycles)
    True
    """
    if hasattr(data, "save"):
        data.save(path)
        return
    file = regular_file(path, ".nc", ".csv")
    given = _as_dataset(data)
    write = partial(_write, given)
    if file.suffix == ".csv":
        is_one = isinstance(given, Dataset)
        require((is_one, "data", "a tree", "must be one group to be a table"))
        write = partial(table_of(given).to_csv, index=False)
    write_atomically(file, write)


def _as_dataset(data: Any) -> Any:
    """A dataset or tree as it is, and an array or a result as its dataset; raises `ParameterError`."""
    rule = "must be an xarray.Dataset or xarray.DataTree"
    if isinstance(data, Dataset | xr.DataTree):
        return data
    require((hasattr(data, "to_dataset"), "data", data, rule))
    try:
        return data.to_dataset()
    except ValueError as error:  # of an array without a name, or with that of a coordinate
        raise ParameterError(Fault(("data",), "", str(error))) from None


def _write(data: Dataset | xr.DataTree, name: str) -> None:
    """Write a dataset or a tree as netCDF; raises `ParameterError` for what a file cannot hold."""
    encoding: Entries
    if isinstance(data, xr.DataTree):
        encoding = {node.path: _encoding(node.to_dataset(inherit=False)) for node in data.subtree}
    else:
        encoding = _encoding(data)
    try:
        data.to_netcdf(name, engine="netcdf4", encoding=encoding)
    except (NotImplementedError, TypeError, ValueError) as error:
        rule = f"must hold numbers and words, with attributes that are text or numbers: {error}"
        raise ParameterError(Fault(("data",), "", rule)) from None


def _encoding(group: Dataset) -> Entries:
    """How variables are written: arrays compressed, with the checksums of HDF5 (fletcher32), which every
    reader compares."""
    arrays = {"fletcher32": True, "zlib": True, "complevel": 1, "shuffle": True}
    encoding = {}
    for name, variable in group.variables.items():
        own: Entries = {"_FillValue": None}
        if variable.dtype.kind in "UO":
            own = {"dtype": "S1"}
        elif variable.ndim and variable.size:
            own.update(arrays)
        encoding[str(name)] = own
    return encoding


# ---- Reading


def load(path: str | Path) -> Dataset | xr.DataTree:
    """Read a dataset of a study, or a file of `disc_model.save` or `Result.save`, into memory.

    Parameters
    ----------
    path : of a netCDF file

    Returns
    -------
    xarray.Dataset
        A DataTree if the file has groups: of a run single numbers at its root, and a group for the events and for each
        window.

    Raises
    ------
    ParameterError
        If the name is not allowed for a file.
    disc_model.data.dataset.UnreadableFile
        If the file is damaged, or is neither.
    disc_model.data.dataset.MissingFile
        If there is no such file.

    Examples
    --------
    >>> import disc_model as dm
    >>> case = dm.Parameters(N=385, Omega=15.1)
    >>> dm.simulate(case, 1, {"late": dm.Window(last=0.5, rate=1e4)}).save("run.nc")
    >>> sorted(dm.load("run.nc").children)
    ['events', 'late']
    """
    tree = load_tree(path)
    if tree.children:
        return tree
    return tree.to_dataset()


def load_tree(path: str | Path, *, lazy: bool = False) -> xr.DataTree:
    """As `load`, always as a tree; if it is lazy, numbers are read when they are used."""
    file = regular_file(path)
    read = xr.load_datatree
    if lazy:
        read = xr.open_datatree
    try:
        tree = read(file, engine="netcdf4", decode_timedelta=False)
        return tree.map_over_datasets(_with_words)
    except FileNotFoundError:
        raise MissingFile(f"{file}: there is no such file") from None
    except Exception as error:  # whatever a file of another kind leads the libraries to
        raise unreadable(file, getattr(error, "strerror", None) or error) from error


def _with_words(group: Dataset) -> Dataset:
    """A group whose words are text of numpy's own."""
    words = {name: x.astype(str) for name, x in group.variables.items() if x.dtype.kind == "O"}
    return group.assign(words)


def load_cases(paths: Iterable[str | Path]) -> dict[str, xr.DataTree]:
    """As `load_tree`, by the names of files, such as those of cases or studies."""
    return {Path(path).stem: load_tree(path) for path in paths}


# ---- Parts of one case


class Missing(Exception):
    """Data that a case does not hold. The text gives the reason; it continues a sentence that
    begins "the case"."""


def group(case: xr.DataTree, name: str) -> Dataset:
    """A window, the Poincare section ``poincare`` or ``events``, as recorded."""
    if name in case.children:
        return case.children[name].to_dataset(inherit=False)
    if "status" in case and STATUSES[int(case["status"])] == "failed":
        raise Missing("failed")
    raise Missing(f"did not record {name}")


def markdown_table(head: Iterable[object], rows: Iterable[Iterable[object]]) -> list[str]:
    """Lines of a table: its head, the rule below it, and one line for each row; a | within a cell
    is escaped."""
    names = [*head]
    lines = []
    table: list[Iterable[object]] = [names, ["---"] * len(names), *rows]
    for row in table:
        cells = [str(cell).replace("|", r"\|") for cell in row]
        lines.append(f"| {' | '.join(cells)} |")
    return lines
