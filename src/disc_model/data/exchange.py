"""Datasets of sweeps, studies and of anyone's own in files that other programs read: netCDF, the
format of MATLAB, and tables of text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np
import xarray as xr

from disc_model.data import dataset
from disc_model.data.complex_parts import joined, with_parts
from disc_model.data.discs_as_text import with_discs, with_texts
from disc_model.data.files import SUFFIXES, regular_file
from disc_model.data.matlab import load_mat, save_mat
from disc_model.data.tables import check_suffix
from disc_model.data.text_tables import names_folder, save_all_tables, save_table
from disc_model.errors import Fault, ParameterError, raise_faults, require

TEXTS = (".csv", ".json", ".txt", ".yaml", ".yml")
"""Suffixes of files that are certainly no datasets."""
TABLE = ".csv"
"""Suffix of a table of text."""
WRITTEN = (*SUFFIXES, TABLE)
"""Suffixes of files that `save` writes."""


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
    """Write a dataset, such as `sweep` and `run_study` return, to a file: whole, for `disc_model.load`, or as a table;
    or all of its tables to a folder.

    Parameters
    ----------
    data : of numbers and words; discs along a dimension are written as text, in JSON, and None beside them, the
        plate, as "plate". A `Branch` and
        what `critical` returns are written as the dataset of their method `to_dataset`, and an xarray.DataArray that
        has a name as a dataset of it alone. A `Result` or a `State` is written by its method `save`, to .nc or .mat,
        and read by its method `load`
    path : its suffix says how. ".nc": netCDF 4; of a complex variable `x` it has the real part `x_real` and the
        imaginary part `x_imag`. ".mat": an array for each variable, complex ones too, with its dimensions in their
        order, a structure for each group, and `units`, `dimensions` and `meanings`, the words of the numbers 0, 1, ...
        Both hold a checksum, by which `load` notices any damage. ".csv": a table with a row for each point, units in
        the heads, such as "Omega (rad s-1)", and words for what stands as numbers in `data`; a variable with further
        dimensions has a column for each place along them, such as `multipliers_real[0]`, and a row for each place if
        only such variables are chosen, as by ``data[["crossing_Omega", "crossing_effect"]]``. Places at which nothing
        was found, such as those after the last crossing, are left out. A branch, and a sweep of branches, has a row
        for each of its points and special points, without its attributes. A folder, which is there or whose name ends
        in "/": a table of this form for each set of dimensions that variables have, such as "energy_start.csv", that of
        single numbers in "single_numbers.csv". Tables are for other programs: `load` reads none

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
    >>> dm.save(cycles, "cycles.mat")
    >>> dm.load("cycles.mat").identical(cycles)
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
    file = None if names_folder(path) else check_suffix(regular_file(path), WRITTEN)
    tree = xr.DataTree(given) if isinstance(given, xr.Dataset) else given
    groups = {node.path: with_texts(node.to_dataset(inherit=False)) for node in tree.subtree}
    raise_faults(list(_faults(groups)))
    if file is None:
        save_all_tables(groups, path)
    elif file.suffix == ".nc":
        parts = {path: with_parts(group) for path, group in groups.items()}
        dataset.save(xr.DataTree.from_dict(parts), file)
    elif file.suffix == TABLE:
        save_table(groups, file)
    else:
        save_mat(groups, file)


def load(path: str | Path) -> xr.Dataset | xr.DataTree:
    """Read a dataset of a study, or a file of `disc_model.save` or `Result.save`, into memory.

    Parameters
    ----------
    path : of a netCDF file, or of a .mat file of `disc_model.save`

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
    require((readable, "path", path, "must be a .nc or .mat file; tables are for pandas"))
    stored = load_mat(file) if file.suffix == ".mat" else _load_netcdf(file)
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


# ---- netCDF


def _load_netcdf(file: Path) -> dict[str, xr.Dataset]:
    """The groups of a netCDF file by their paths."""
    tree = dataset.read_tree(file)
    return {node.path: joined(node.to_dataset(inherit=False)) for node in tree.subtree}
