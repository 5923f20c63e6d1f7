"""Tables of numbers: with a text that describes them as netCDF or in the format of MATLAB, or as
text."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.data.dataset import read_tree, save
from disc_model.data.files import (
    SUFFIXES,
    MissingFile,
    check_mat,
    regular_file,
    seal_mat,
    unreadable,
    write_atomically,
)
from disc_model.data.variables import COORDINATES, OF_STATES, SERIES, flag_names
from disc_model.errors import Fault, ParameterError, raise_faults, require

# columns of numbers, shape (n,), by the names of tables and their own
Tables = dict[str, dict[str, NDArray[Any]]]
BESIDE = ("result", "units", "meanings")
"""What a .mat file holds beside the tables."""
_MATLAB_NAME = re.compile(r"[A-Za-z]\w{0,62}", re.ASCII)


def check_suffix(path: Path, suffixes: Sequence[str] = SUFFIXES) -> Path:
    """A path, unless there is no form of files for its suffix; raises `ParameterError`."""
    if path.suffix not in suffixes:
        rule = f"must end in {' or '.join(suffixes)}"
        raise ParameterError(Fault.of(("path",), str(path), rule))
    return path


def save_tables(
    tables: Tables, described: str, path: str | Path, tree: xr.DataTree | None = None
) -> None:
    """Write tables and a text that describes them in the form of which `Result.save` tells; as
    netCDF, the groups of a tree, with columns and tables that it lacks."""
    file = check_suffix(regular_file(path))
    if file.suffix == ".nc":
        tree = xr.DataTree() if tree is None else tree
        for name, table in tables.items():
            known = tree[name].to_dataset() if name in tree.children else xr.Dataset()
            along = str(next(iter(known.dims), "mode"))
            new = {key: _column(key, along, x) for key, x in table.items() if key not in known}
            tree[name] = known.assign(new)
        tree.attrs["result"] = described
        save(tree, file)
    else:
        _save_mat(tables, described, file)


def _column(name: str, along: str, values: NDArray[Any]) -> xr.Variable:
    """A column that only files hold, with its unit and meaning."""
    known = COORDINATES | OF_STATES
    return xr.Variable(along, values, known[name].attributes if name in known else {})


def _save_mat(tables: Tables, described: str, file: Path) -> None:
    """Write a structure of columns for each table, the text, units, and the words of numbers."""
    from scipy.io import savemat

    rule = f"must be a name that MATLAB allows, but not one of {', '.join(BESIDE)}"
    raise_faults(
        [
            Fault(("windows", name), "", rule)
            for name in tables
            if name in BESIDE or not _MATLAB_NAME.fullmatch(name)
        ]
    )
    known = SERIES | COORDINATES | OF_STATES
    columns = sorted({name for table in tables.values() for name in table} & known.keys())
    units = {name: known[name].units for name in columns}
    # words of the numbers 0, 1, ...: meanings.kind{events.kind + 1}
    meanings = {
        name: np.array(known[name].flags, dtype=object) for name in columns if known[name].flags
    }
    content = {"result": described, "units": units, "meanings": meanings, **tables}

    def write(name: str) -> None:
        savemat(name, content, appendmat=False, long_field_names=True, oned_as="column")
        seal_mat(name)

    write_atomically(file, write)


def load_tables(path: str | Path) -> tuple[str, Tables]:
    """The text and the tables that `save_tables` has written; of netCDF the attribute `result` and
    groups.

    Raises
    ------
    ParameterError
        If the file holds no such text.
    UnreadableFile
        If the file is damaged, or holds other things than columns of numbers.
    MissingFile
        If there is no such file.
    """
    file = regular_file(path)
    if not file.exists():
        raise MissingFile(f"{path}: there is no such file")
    text, tables = _load_mat(file) if file.suffix == ".mat" else _load_netcdf(file)
    try:
        numbers = {}
        for name, table in tables.items():
            numbers[name] = {key: np.asarray(x, float).ravel() for key, x in table.items()}
    except (TypeError, ValueError, RecursionError) as error:
        raise unreadable(path, f"a column must hold numbers: {error}") from error
    return text if isinstance(text, str) else "", numbers


def _load_netcdf(file: Path) -> tuple[object, dict[str, dict[str, Any]]]:
    tree = read_tree(file, sealed=True)
    tables = {}
    for name, node in tree.children.items():
        group = node.to_dataset(inherit=False).variables
        # the time first, as in the windows of a run
        tables[name] = {str(key): group[key].values for key in sorted(group, key="time".__ne__)}
    return tree.attrs.get("result", ""), tables


def _load_mat(file: Path) -> tuple[object, dict[str, dict[str, Any]]]:
    from scipy.io import loadmat

    check_mat(file)
    try:
        content = loadmat(file, appendmat=False, simplify_cells=True)
    except Exception as error:  # whatever a file that another program has sealed leads scipy to
        raise unreadable(file, error) from error
    tables = {
        name: table
        for name, table in content.items()
        if name not in BESIDE and isinstance(table, dict)
    }
    return content.get("result", ""), tables


# ---- Text


def save_csv(tables: Mapping[str, xr.Dataset], path: str | Path) -> None:
    """Write tables of one dimension as text to files of a folder.

    Heads of columns have units, such as ``P (N)``, and words stand in place of their numbers.

    Parameters
    ----------
    tables : by the names of their files, without suffix
    path : of the folder, which is made if it is missing

    Raises
    ------
    ParameterError
        If there can be no such folder.
    WriteError
        If a file cannot be written.
    """
    folder = made_folder(path)
    for name, table in tables.items():
        columns = {}
        for key in (*table.coords, *table.data_vars):
            variable = table[key]
            values = variable.values
            if "flag_meanings" in variable.attrs:
                values = flag_names(variable)
            columns[head_of(str(key), variable.attrs)] = ("row", values)
        frame = xr.Dataset(columns).to_dataframe()
        write_atomically(folder / f"{name}.csv", partial(frame.to_csv, index=False))


def head_of(name: str, attributes: Mapping[Any, Any]) -> str:
    """The head of a column: a name, and the unit of its numbers."""
    unit = attributes.get("units", "1")
    return name if unit in ("", "1") else f"{name} ({unit})"


def made_folder(path: str | Path) -> Path:
    """A folder, made if it is missing; raises `ParameterError`."""
    rule = "must be the name of a folder"
    possible = isinstance(path, str | Path) and "\0" not in str(path)
    require((possible, "path", str(path), rule))
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:  # such as a file of this name
        raise ParameterError(Fault.of(("path",), str(path), f"{rule}: {error.strerror}")) from None
    return folder
