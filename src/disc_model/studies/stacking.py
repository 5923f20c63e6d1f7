"""Results of many points as variables along the dimensions of a sweep."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import TRUTH


def stacked(
    rows: Sequence[dict[str, xr.Variable]], sizes: Mapping[str, int]
) -> tuple[dict[str, xr.Variable], dict[str, xr.Variable]]:
    """Variables along the dimensions of a sweep, and the function's own coordinates; nan or ""
    where one is missing. A coordinate that differs between points is a variable, too."""
    rows = _with_common_coordinates(rows)
    first: dict[str, xr.Variable] = {}
    for row in reversed(rows):
        first.update(row)
    fixed = {}
    stacked = {}
    for name, variable in first.items():
        if variable.dims == (name,):
            fixed[name] = variable
            continue
        present = [row[name] for row in rows if name in row]
        _warn_of_mixture(name, present)
        values = [row[name].values if name in row else None for row in rows]
        array = _padded(values)
        whole = array.reshape((*sizes.values(), *array.shape[1:]))
        attrs = _common_attributes([each.attrs for each in present])
        is_truth = any(each.dtype.kind == "b" for each in present)
        if is_truth and array.dtype.kind == "f":
            attrs = {**attrs, **TRUTH}
        stacked[name] = xr.Variable((*sizes, *variable.dims), whole, attrs)
    return stacked, fixed


def _warn_of_mixture(name: str, several: Sequence[xr.Variable]) -> None:
    """Warn of a result that is a word at some points and a number at others, as "1" is no number."""
    are_words = {each.dtype.kind == "U" for each in several}
    if len(are_words) > 1:
        text = f"{name} is a word at some points and a number at others: its numbers are words, too"
        warnings.warn(text, stacklevel=3)


def _with_common_coordinates(
    rows: Sequence[dict[str, xr.Variable]],
) -> list[dict[str, xr.Variable]]:
    """The rows, in which variables along a coordinate that is not the same in all have a dimension
    without one: places along it have other values at other points."""
    first: dict[str, xr.Variable] = {}
    differing = set()
    for row in rows:
        for name, variable in row.items():
            is_coordinate = variable.dims == (name,)
            if is_coordinate and not variable.equals(first.setdefault(name, variable)):
                differing.add(name)
    if not differing:
        return [*rows]
    renamed = {name: f"{name}_index" for name in differing}
    kept = []
    for row in rows:
        kept.append({name: _along(variable, renamed) for name, variable in row.items()})
    return kept


def _along(variable: xr.Variable, renamed: Mapping[str, str]) -> xr.Variable:
    """A variable along dimensions of other names."""
    dims = [renamed.get(str(dim), str(dim)) for dim in variable.dims]
    return xr.Variable(dims, variable.values, variable.attrs)


def _common_attributes(several: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """The attributes on which variables of one name agree; a critical value may be one of a speed at
    one point and of a load at another."""
    common = dict(several[0])
    for attributes in several[1:]:
        for name, value in several[0].items():
            other: Any = attributes.get(name)
            if other is not value and not np.array_equal(other, value):
                common.pop(name, None)
    return common


def _type_of(kinds: set[str], *, complete: bool) -> tuple[Any, Any]:
    """The type that holds values of some of numpy's kinds, and what stands for missing ones: whole
    numbers and truth have none unless all values are there. Numbers among words become words."""
    if "U" in kinds:
        return object, ""
    if "c" in kinds:
        return complex, complex(math.nan, math.nan)
    if kinds <= {"b"} and complete:
        return bool, False
    if kinds <= {"i", "u"} and complete:
        return int, 0
    return float, math.nan


def _padded(rows: Sequence[np.ndarray | None]) -> np.ndarray:
    """Arrays of one number of dimensions as the rows of one array, shape (len(rows), ...); what is
    missing is nan, or "" among words."""
    present = [row for row in rows if row is not None]
    shapes = [row.shape for row in present]
    shape = tuple(max(sizes) for sizes in zip(*shapes, strict=True))
    complete = all(row is not None and row.shape == shape for row in rows)
    dtype, missing = _type_of({row.dtype.kind for row in present}, complete=complete)
    array = np.full((len(rows), *shape), missing, dtype)
    for i, row in enumerate(rows):
        if row is not None:
            place: Any = (i, *map(slice, row.shape))
            array[place] = row.astype(str) if dtype is object else row
    return array.astype(str) if dtype is object else array
