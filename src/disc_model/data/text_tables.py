"""Datasets as text: one table in a file, or all of their tables in a folder."""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path

import xarray as xr

from disc_model.data.branch_table import has_branches, save_branches
from disc_model.data.complex_parts import with_parts
from disc_model.data.point_table import save_points
from disc_model.data.tables import made_folder
from disc_model.errors import Fault, ParameterError

Groups = Mapping[str, xr.Dataset]
"""Groups of a dataset by their paths, such as "/"."""
SINGLE = "single_numbers"
"""Name of the table of numbers that have no dimension."""
BRANCHES = "branches"
"""Name of the table of a branch, or of a sweep of branches."""


def names_folder(path: object) -> bool:
    """Whether a path is that of a folder: it ends in a slash, or the folder is there."""
    if not isinstance(path, str | os.PathLike) or "\0" in str(path):
        return False
    return str(path).endswith(("/", os.sep)) or os.path.isdir(path)


def save_table(groups: Groups, file: Path) -> None:
    """Write the only one of groups as a table; raises `ParameterError` where there are several, or
    where one is several tables."""
    first, *others = groups
    if others:
        rule = f"must be one group to be a table, such as data[{others[0]!r}].to_dataset()"
        raise ParameterError(Fault(("data",), "", rule))
    if has_branches(groups[first]):
        save_branches(groups[first], file)
    else:
        save_points(with_parts(groups[first]), file)


def save_all_tables(groups: Groups, path: str | Path) -> None:
    """Write all tables of groups to files of a folder, which is made if it is missing: those of a
    group that has a name to a folder of this name within it."""
    for place, group in groups.items():
        folder = made_folder(Path(path, place.strip("/")))
        for name, table in _tables_of(group).items():
            save_table({"/": table}, folder / f"{name}.csv")


def _tables_of(group: xr.Dataset) -> dict[str, xr.Dataset]:
    """Variables that stand along the same dimensions, by the names of these; a whole branch is one
    table."""
    if has_branches(group):
        return {BRANCHES: group}
    alike = defaultdict(list)
    for name, variable in group.items():
        along = tuple(str(dim) for dim in group.dims if dim in variable.dims)
        alike[along].append(name)
    return {"_".join(along) or SINGLE: group[names] for along, names in alike.items()}
