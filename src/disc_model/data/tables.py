"""Tables of numbers with a text that describes them, as netCDF; datasets as tables of text."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from disc_model.data.coded import words
from disc_model.data.complex_parts import with_parts
from disc_model.data.dataset import load, save
from disc_model.data.files import regular_file, unreadable
from disc_model.data.variables import COORDINATES, OF_STATES
from disc_model.errors import Fault, ParameterError, require

# columns of numbers, shape (n,), by the names of tables and their own
Tables = dict[str, dict[str, NDArray[Any]]]


def check_suffix(path: Path, *suffixes: str) -> Path:
    """A path, unless there is no form of files for its suffix; raises `ParameterError`."""
    if path.suffix not in suffixes:
        rule = f"must end in {' or '.join(suffixes)}"
        raise ParameterError(Fault.of(("path",), str(path), rule))
    return path


def save_tables(tables: Tables, described: str, path: str | Path, tree: xr.DataTree) -> None:
    """Write the groups of a tree, with columns and tables that it lacks, and a text that describes
    them."""
    file = check_suffix(regular_file(path), ".nc")
    for name, table in tables.items():
        known = tree[name].to_dataset() if name in tree.children else xr.Dataset()
        along = str(next(iter(known.dims), "mode"))
        new = {key: _column(key, along, x) for key, x in table.items() if key not in known}
        tree[name] = known.assign(new)
    tree.attrs["result"] = described
    save(tree, file)


def _column(name: str, along: str, values: NDArray[Any]) -> xr.Variable:
    """A column that only files hold, with its unit and meaning."""
    known = COORDINATES | OF_STATES
    return xr.Variable(along, values, known[name].attributes if name in known else {})


def load_tables(path: str | Path) -> tuple[str, Tables]:
    """The text and the tables that `save_tables` has written.

    Raises
    ------
    ParameterError
        If the file holds no such text.
    UnreadableFile
        If the file is damaged, or holds other things than columns of numbers.
    MissingFile
        If there is no such file.
    """
    tree = load(path)
    tables: Tables = {}
    try:
        for name, node in tree.children.items():
            group = node.to_dataset(inherit=False).variables
            # the time first, as in the windows of a run
            keys = sorted(group, key="time".__ne__)
            tables[name] = {str(key): np.asarray(group[key], float).ravel() for key in keys}
    except (TypeError, ValueError) as error:
        raise unreadable(path, f"a column must hold numbers: {error}") from error
    text = tree.attrs.get("result", "")
    return text if isinstance(text, str) else "", tables


# ---- Text


def table_of(data: xr.Dataset) -> pd.DataFrame:
    """A dataset as one table: a row for each point of its dimensions, words in place of numbers that
    stand for them, and units in the heads, such as "P (N)".

    Raises `ParameterError` where variables stand along other dimensions than those with the most.
    """
    dims = max((variable.dims for variable in data.variables.values()), key=len, default=())
    others = [str(name) for name, variable in data.items() if not {*variable.dims} <= {*dims}]
    rule = (
        f"must be along {', '.join(map(str, dims))} to be one table: choose variables, such as "
        "data[['x', 'y']], or leave out dimensions, such as data.drop_dims(['mode'])"
    )
    require((not others, "data", ", ".join(others), rule))
    points = with_parts(words(data) if dims else words(data).expand_dims("row"))
    heads = {str(name): head_of(str(name), x.attrs) for name, x in points.variables.items()}
    table = points.to_dataframe()
    return table.reset_index(drop=not dims).rename(columns=heads)


def head_of(name: str, attributes: Mapping[Any, Any]) -> str:
    """The head of a column: a name, and the unit of its numbers."""
    unit = attributes.get("units", "1")
    return name if unit in ("", "1") else f"{name} ({unit})"
