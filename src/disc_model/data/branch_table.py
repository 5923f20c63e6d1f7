"""Branches of cycles as one table of text, with a row for each of their points."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from disc_model.data.complex_parts import with_parts
from disc_model.data.point_table import table_of, write_table
from disc_model.data.swept_branches import (
    branch_of_sweep,
    has_failed,
    is_of_sweep,
    name_beside,
    points_of_sweep,
)
from disc_model.data.tables import head_of

BEGIN = "special_"
"""What stands before the names of variables of special points."""
KINDS = (f"{BEGIN}kind", f"{BEGIN}label")
"""Heads of what a special point is."""
OF_BRANCH = {
    "point",
    "period",
    "special_period",
    "special_kind",
    "special_after",
    "separations",
    "releases",
}
"""Variables without which a dataset is no whole branch."""
SAME_BETWEEN = ("separations", "releases")
"""Numbers that a special point between two points has in common with the first of these."""
OF_POINT = ("status", "message", "ended", "not_reached")
"""What is known of a point of a sweep, and stands in each of its rows."""


def has_branches(data: xr.Dataset) -> bool:
    """Whether a dataset is a whole branch, or a sweep of branches."""
    return is_of_sweep(data) or OF_BRANCH.issubset(data.variables)


def save_branches(data: xr.Dataset, file: Path) -> None:
    """Write a branch, or a sweep of branches, as a table with a row for each point, in their order.

    A special point that is one of the points is named in its row, and any other one has a row in its
    place between two points. What a row does not have is empty there. Rows of a sweep begin with the
    values along its axes; a point of it that failed has one row.

    Raises `WriteError` if the file cannot be written.
    """
    if is_of_sweep(data):
        table = _table_of_sweep(data)
    else:
        table = _table_of_branch(data)
    write_table(table, file)


# ---- One branch


def _table_of_branch(data: xr.Dataset) -> pd.DataFrame:
    """The points of a branch, and its special points in their places."""
    real = with_parts(data)
    points = table_of(real.drop_dims("special")).convert_dtypes()
    special = _table_of_special(real, points)
    numbers = _numbers_of_special(data)
    is_point = numbers >= 0

    own = [head for head in special.columns if head not in points.columns]
    at_points = special.loc[is_point, own].set_index(numbers[is_point])
    named = points.assign(place=np.arange(len(points))).join(at_points)
    between = special[~is_point]
    between = between.assign(place=between[f"{BEGIN}after"] + 0.5)
    rows = pd.concat([named, between]).sort_values("place", kind="stable")
    rows = _with_same_between(rows).drop(columns=["place", f"{BEGIN}after"])
    return rows[_in_order(rows, data)]


def _in_order(rows: pd.DataFrame, data: xr.Dataset) -> list[str]:
    """The heads of a table, those of the parameters and of the kinds of special points first."""
    parameters = data.attrs["free_parameters"].split(", ")
    first = ["point", *(head_of(name, data[name].attrs) for name in parameters), *KINDS]
    return [*first, *(head for head in rows.columns if head not in first)]


def _table_of_special(data: xr.Dataset, points: pd.DataFrame) -> pd.DataFrame:
    """The special points of a branch, whose heads are those of the points where both have a column."""
    numbered = data.drop_dims("point").drop_vars("special", errors="ignore")
    table = table_of(numbered).convert_dtypes()
    heads = {}
    for head in table.columns:
        own = head.removeprefix(BEGIN)
        heads[head] = own if own in points.columns else head
    return table.rename(columns=heads)


def _numbers_of_special(data: xr.Dataset) -> NDArray[np.int64]:
    """For each special point the number of the point of the branch that it is: the one before it or
    the next one, if that has its period; -1 if it lies between both, or another one is that point."""
    periods = data["period"].values
    numbers: list[int] = []
    for after, period in zip(data["special_after"].values, data["special_period"], strict=True):
        nearest = [i for i in (after, after + 1) if i < len(periods) and periods[i] == period]
        free = [int(i) for i in nearest if i not in numbers]
        numbers.append(free[0] if free else -1)
    return np.array(numbers, dtype=int)


def _with_same_between(rows: pd.DataFrame) -> pd.DataFrame:
    """Rows in which special points have the numbers that do not change between two points."""
    filled = {name: rows[name].ffill() for name in SAME_BETWEEN}
    return rows.assign(**filled)


# ---- Sweeps


def _table_of_sweep(swept: xr.Dataset) -> pd.DataFrame:
    """The rows of all points of a sweep, below each other."""
    return pd.concat([_table_of_point(point) for point in points_of_sweep(swept)])


def _table_of_point(point: xr.Dataset) -> pd.DataFrame:
    """The rows of a point of a sweep, which begin with its place along the axes and its status."""
    said = [name for name in OF_POINT if name in point]
    place = table_of(point[said])
    if has_failed(point):
        return place
    own = branch_of_sweep(point)
    branch = _table_of_branch(own.assign_coords(point=np.arange(own.sizes["point"])))
    beside = {head: name_beside(head) for head in branch.columns if head in place.columns}
    return place.merge(branch.rename(columns=beside), how="cross")
