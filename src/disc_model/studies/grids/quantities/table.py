"""Rows of results, one for each point of a grid, as arrays with units."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from disc_model.data.variables import Variable
from disc_model.errors import DiscModelError
from disc_model.status import Status

STATUSES = (
    "ok",
    *(status.value for status in Status if not status.complete),
    "failed",
)
"""What became of a point. `failed`: it raised an error, or was not reached."""
STATUS = Variable("1", "what became of the computation", STATUSES)


class Column(NamedTuple):
    """A variable of a quantity, and its dimensions beyond the grid's."""

    variable: Variable
    dims: tuple[str, ...] = ()
    whole: bool = False

    @property
    def dtype(self) -> type[np.generic]:
        if self.variable.flags:
            return np.int8
        return np.int64 if self.whole else np.float64

    @property
    def missing(self) -> float:
        """What stands where nothing is known: of a status `failed`, of other flags their first."""
        if "failed" in self.variable.flags:
            return self.variable.flags.index("failed")
        return 0 if self.variable.flags or self.whole else math.nan


class Table(NamedTuple):
    """Arrays by variable, shape (points, ...), and one message a point, empty where all went well."""

    arrays: dict[str, NDArray[Any]]
    messages: list[str]


Row = Mapping[str, Any]
NUMERICAL = (DiscModelError, ArithmeticError, np.linalg.LinAlgError)
"""What a point may fail of: this package's errors, division by zero and overflow, matrices that cannot be solved."""


def tabulate(
    compute_one: Callable[[Any], tuple[Row, str]],
    points: Sequence[Any],
    columns: Mapping[str, Column],
    sizes: Mapping[str, int],
) -> Table:
    """Compute each point; one that fails (see `NUMERICAL`) gets the status `failed` and a message.

    Parameters
    ----------
    points : what `compute_one` is given; an error stands for a point that could not be made, and is its message
    compute_one : of parameters, its values by column (flags as words) and a message; columns left out are missing
    sizes : of the dimensions beyond the grid's
    """
    rows, messages = [], []
    for point in points:
        try:
            if isinstance(point, DiscModelError):
                raise point
            row, message = compute_one(point)
        except NUMERICAL as error:
            row, message = {"status": "failed"}, f"{type(error).__name__}: {error}"
        rows.append(row)
        messages.append(message)
    arrays = {}
    for name, column in columns.items():
        shape = (len(rows), *(sizes[dim] for dim in column.dims))
        array = np.full(shape, column.missing, dtype=column.dtype)
        for i, row in enumerate(rows):
            if name in row:
                array[i] = _stored(row[name], column)
        arrays[name] = array
    return Table(arrays, messages)


def _stored(value: Any, column: Column) -> Any:
    """Words of a flag, at any depth of lists, as numbers; arrays are numbers already."""
    if isinstance(value, list):
        return [_stored(item, column) for item in value]
    return column.variable.flags.index(value) if isinstance(value, str) else value
