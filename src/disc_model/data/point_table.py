"""A dataset as one table of text, with a row for each point."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from disc_model.data.coded import words
from disc_model.data.files import write_atomically
from disc_model.data.missing import NUMBERED, WITH_ROOM
from disc_model.data.tables import head_of
from disc_model.errors import Fault, ParameterError


def save_points(data: xr.Dataset, file: Path) -> None:
    """Write a dataset of real numbers and words as a table with a row for each point.

    Heads of columns have units, such as ``Omega (rad s-1)``, and words stand in place of their
    numbers. A variable that has further dimensions has a column for each place along these, such as
    ``multipliers_real[0]``; these columns are the last ones. Where a dimension has room for more than was
    found, such as that of crossings, places without a number have neither a row nor a column; modes that no
    point has have none either.

    Raises
    ------
    ParameterError
        If a variable does not stand along the points.
    WriteError
        If the file cannot be written.
    """
    write_table(table_of(data), file)


def write_table(table: pd.DataFrame, file: Path) -> None:
    """Write a table to a file; raises `WriteError` if that fails."""
    write_atomically(file, partial(table.to_csv, index=False))


def table_of(data: xr.Dataset) -> pd.DataFrame:
    """The table that `save_points` writes; raises `ParameterError` as it does."""
    worded = words(data)
    points = _dimensions_of_points(worded)
    _check_dimensions(worded)
    worded = _without_empty_places(worded)
    sizes = {dim: worded.sizes[dim] for dim in points}
    columns = {}
    for name in _names_in_order(worded, points):
        for head, column in _columns(worded, str(name), sizes):
            columns[head] = column.set_dims(sizes).values.ravel()
    return pd.DataFrame(columns)[_has_numbers(worded, sizes)]


def _names_in_order(data: xr.Dataset, points: Sequence[str]) -> list[str]:
    """Coordinates and variables, those last that have several columns: a reader looks for one number
    of each point first."""
    names = [str(name) for name in (*data.coords, *data.data_vars)]
    return sorted(names, key=lambda name: not {*data[name].dims} <= {*points})


def _numbers_along(data: xr.Dataset, dim: str) -> list[xr.DataArray]:
    """The variables of a dataset along a dimension whose numbers may be missing."""
    return [each for each in data.values() if dim in each.dims and each.dtype.kind == "f"]


def _without_empty_places(data: xr.Dataset) -> xr.Dataset:
    """A dataset without the places along dimensions `NUMBERED` at which no point has a number; the first
    one stays, for its heads."""
    kept = {}
    for dim in {*NUMBERED} & {*map(str, data.dims)}:
        found = np.zeros(data.sizes[dim], bool)
        numbers = _numbers_along(data, dim)
        for each in numbers:
            others = [other for other in each.dims if other != dim]
            found |= each.notnull().any(others).values
        if numbers:
            found[0] = True
            kept[dim] = np.flatnonzero(found)
    return data.isel(kept)


def _has_numbers(data: xr.Dataset, points: Mapping[str, int]) -> NDArray[np.bool_]:
    """Whether each row has a number of what is along a dimension `WITH_ROOM`; all rows have where the
    points have no such dimension."""
    numbers = [each for dim in WITH_ROOM if dim in points for each in _numbers_along(data, dim)]
    found = np.full([*points.values()], not numbers)
    for each in numbers:
        further = [dim for dim in each.dims if dim not in points]
        found |= each.notnull().any(further).variable.set_dims(points).values
    return found.ravel()


def _dimensions_of_points(data: xr.Dataset) -> tuple[str, ...]:
    """The dimensions of the points: those of their status, or else those that most variables have."""
    dims: tuple[object, ...] = ()
    if "status" in data:
        dims = data["status"].dims
    if not dims and data.data_vars:
        counts = Counter(variable.dims for variable in data.values())
        ((dims, _),) = counts.most_common(1)
    return tuple(map(str, dims))


def without_place(data: xr.Dataset) -> list[str]:
    """Variables that stand neither along the points of a dataset nor along some of their dimensions."""
    points = {*_dimensions_of_points(data)}
    others = []
    for name, variable in data.items():
        own = {*variable.dims}
        if not (own <= points or own >= points):
            others.append(str(name))
    return others


def _check_dimensions(data: xr.Dataset) -> None:
    """Raise `ParameterError` where variables have no place in a table of the points."""
    others = without_place(data)
    if others:
        choice = f'choose variables of one table, such as data[["{others[0]}"]]'
        dims = ", ".join(f'"{dim}"' for dim in _further_dimensions(data, others))
        left = f"data.drop_dims([{dims}]), which has all others"
        all_tables = 'or name a folder, such as "tables/", for all tables'
        rule = f"{rule_of_rows(data)}: {', '.join(others)}; {choice}, or {left}, {all_tables}"
        raise ParameterError(Fault(("data",), "", rule))


def _further_dimensions(data: xr.Dataset, others: Sequence[str]) -> list[str]:
    """The dimensions of variables that have no place in a table of the points, but not of those that
    have one."""
    placed = {dim for name, each in data.items() if name not in others for dim in each.dims}
    further = dict.fromkeys(dim for name in others for dim in data[name].dims)
    return [str(dim) for dim in further if dim not in placed]


def rule_of_rows(data: xr.Dataset) -> str:
    """What the rows of a dataset as a table are, before those variables that have no place in it."""
    along = ", ".join(_dimensions_of_points(data))
    return f"has a row for each {along} as a table, in which these have no place"


def _columns(
    data: xr.Dataset, name: str, points: Mapping[str, int]
) -> Iterator[tuple[str, xr.Variable]]:
    """Yield the head and the cells of each column of a variable; none of a coordinate of other
    dimensions, of which heads have the values."""
    variable = data[name].variable
    own = [str(dim) for dim in variable.dims if dim not in points]
    if name in data.coords and own:
        return
    for places in product(*(range(data.sizes[dim]) for dim in own)):
        at = dict(zip(own, places, strict=True))
        head = name
        if own:
            labels = [_label(data, dim, place) for dim, place in at.items()]
            head = f"{name}[{', '.join(labels)}]"
        yield head_of(head, variable.attrs), variable.isel(at)


def _label(data: xr.Dataset, dim: str, place: int) -> str:
    """The value of a coordinate at a place, or the place where there is none."""
    if dim not in data.coords:
        return str(place)
    value = data[dim].values[place]
    return value if isinstance(value, str) else f"{value:.12g}"
