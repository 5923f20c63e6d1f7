"""Tables of numbers with a text that describes them, as netCDF."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.data.dataset import load_tree, save
from disc_model.data.files import regular_file, unreadable
from disc_model.data.variables import COORDINATES, OF_STATES

# columns of numbers, shape (n,), by the names of tables and their own
Tables = dict[str, dict[str, NDArray[Any]]]


def save_tables(tables: Tables, described: str, path: str | Path, tree: xr.DataTree) -> None:
    """Write the groups of a tree, with columns and tables that it lacks, and a text that describes
    them."""
    known = COORDINATES | OF_STATES
    for name, table in tables.items():
        group = tree[name].to_dataset() if name in tree.children else xr.Dataset()
        along = str(next(iter(group.dims), "mode"))
        for column in table.keys() - group.variables.keys():
            attrs = known[column].attributes if column in known else {}
            group[column] = (along, table[column], attrs)
        tree[name] = group
    tree.attrs["result"] = described
    save(tree, regular_file(path, ".nc"))


def load_tables(path: str | Path) -> tuple[str, Tables]:
    """The text and the tables that `save_tables` has written; the text is "" in another file. Raises
    `ParameterError` for a name that is none of a file, `MissingFile`, and `UnreadableFile` if the file is
    damaged, or holds other things than columns of numbers."""
    tree = load_tree(path)
    tables: Tables = {}
    try:
        for name, node in tree.children.items():
            group = node.to_dataset(inherit=False).variables
            # the time first, as in the windows of a run
            keys = sorted(group, key="time".__ne__)
            tables[name] = {str(key): np.asarray(group[key], float).ravel() for key in keys}
    except (TypeError, ValueError) as error:
        raise unreadable(path, f"a column must hold numbers: {error}") from error
    return str(tree.attrs.get("result", "")), tables
