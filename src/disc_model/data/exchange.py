"""Datasets of sweeps, studies and of anyone's own in files that other programs read: netCDF, and
tables of text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from functools import partial
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.complex_parts import joined, with_parts
from disc_model.data.discs_as_text import with_discs, with_texts
from disc_model.data.files import regular_file, write_atomically
from disc_model.data.tables import check_suffix, table_of
from disc_model.errors import Fault, ParameterError, raise_faults, require

TEXTS = (".csv", ".json", ".txt", ".yaml", ".yml")
"""Suffixes of files that are certainly no datasets."""


class HasDataset(Protocol):
    """A result that becomes a dataset, such as a `Branch` or a `Critical`."""

    def to_dataset(self) -> xr.Dataset: ...


@runtime_checkable
class SavesItself(Protocol):
    """A result that writes itself to a file, such as a `Result`."""

    def save(self, path: str | Path) -> None: ...


def save(
    data: xr.Dataset | xr.DataArray | xr.DataTree | HasDataset | SavesItself, path: str | Path
) -> None:
    """Write a dataset, such as `sweep` and `run_study` return, to a file: whole, for `disc_model.load`, or as a table.

    Parameters
    ----------
    data : of numbers and words; discs along a dimension are written as text, in JSON, and None beside them, the
        plate, as "plate". A `Branch` and
        what `critical` returns are written as the dataset of their method `to_dataset`, and an xarray.DataArray that
        has a name as a dataset of it alone. A `Result` is written by its method `save`, to .nc,
        and read by its method `load`
    path : its suffix says how. ".nc": netCDF 4; of a complex variable `x` it has the real part `x_real` and the
        imaginary part `x_imag`. ".csv": a table of pandas with a row for each point, units in the heads, such as
        "Omega (rad s-1)", and words for what stands as numbers in `data`. All variables must stand along the
        dimensions of one of them: choose some, as by ``data[["crossing_Omega", "crossing_effect"]]``. Tables are for
        other programs: `load` reads none

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
    if _saves_itself(data):
        data.save(path)  # type: ignore[union-attr]
        return
    _check_named(data)
    given = _as_dataset(data)
    rule = "must be an xarray.Dataset or xarray.DataTree"
    if hasattr(data, "to_dataset"):
        rule = f"{rule}, such as its method to_dataset() returns"
    require((isinstance(given, xr.Dataset | xr.DataTree), "data", data, rule))
    file = check_suffix(regular_file(path), ".nc", ".csv")
    tree = xr.DataTree(given) if isinstance(given, xr.Dataset) else given
    groups = {node.path: with_texts(node.to_dataset(inherit=False)) for node in tree.subtree}
    raise_faults(list(_faults(groups)))
    if file.suffix == ".nc":
        parts = {path: with_parts(group) for path, group in groups.items()}
        dataset.save(xr.DataTree.from_dict(parts), file)
        return
    require((len(groups) == 1, "data", ", ".join(groups), "must be one group to be a table"))
    write_atomically(file, partial(table_of(groups["/"]).to_csv, index=False))


def load(path: str | Path) -> xr.Dataset | xr.DataTree:
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
    ['events', 'final_state', 'late']
    """
    file = regular_file(path)
    readable = file.suffix not in TEXTS
    require((readable, "path", path, "must be a .nc file; tables are for pandas"))
    tree = dataset.load(file)
    stored = {node.path: joined(node.to_dataset(inherit=False)) for node in tree.subtree}
    groups = {path: with_discs(group) for path, group in stored.items()}
    if len(groups) == 1:
        return next(iter(groups.values()))
    return xr.DataTree.from_dict(groups)


# ---- What can be written


def _check_named(data: object) -> None:
    """Raise `ParameterError` for an array of xarray without a name, or with that of a coordinate."""
    if not isinstance(data, xr.DataArray):
        return
    if data.name is None:
        rule = "must have a name, which is that of its variable in the file: data.rename('name')"
        raise ParameterError(Fault(("data",), "", rule))
    if data.name in data.coords:
        rule = f"must have another name than its coordinate {data.name}: data.rename('name')"
        raise ParameterError(Fault(("data",), "", rule))


def _saves_itself(data: object) -> bool:
    """Whether data is a result of this package that writes itself, such as a `Result`."""
    return is_dataclass(data) and not isinstance(data, type) and isinstance(data, SavesItself)


def _as_dataset(data: object) -> Any:
    """A result of this package, or an array with a name, as its dataset; all else as it is."""
    if isinstance(data, xr.DataArray):
        return data.to_dataset()
    if is_dataclass(data) and not isinstance(data, type) and hasattr(data, "to_dataset"):
        return data.to_dataset()
    return data


def _faults(groups: Mapping[str, xr.Dataset]) -> Iterator[str]:
    """Yield what no file can hold of groups by their paths."""
    for path, group in groups.items():
        place = tuple(part for part in path.split("/") if part)
        yield from _attribute_faults(place, group.attrs)
        for key, variable in group.variables.items():
            name = str(key)
            yield from _attribute_faults((*place, name), variable.attrs)
            if not _is_plain(variable):
                kind = type(variable.values.flat[0]).__name__ if variable.size else variable.dtype
                rule = f"must hold numbers or words to be saved, and holds {kind}"
                yield Fault((*place, name), "", rule)


def _is_plain(variable: xr.Variable) -> bool:
    """Whether a variable holds numbers or words."""
    if variable.dtype.kind == "O":
        return all(isinstance(value, str) for value in variable.values.flat)
    return variable.dtype.kind in "biufcU"


def _attribute_faults(place: tuple[str, ...], attrs: Mapping[Any, Any]) -> Iterator[str]:
    """Yield a fault for each attribute that is neither text nor numbers."""
    for name, value in attrs.items():
        kind = np.asarray(value).dtype.kind
        if not isinstance(value, str) and kind not in "iuf":
            yield Fault.of((*place, str(name)), value, "must be text or numbers, as an attribute")
