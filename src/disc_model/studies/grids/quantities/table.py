"""Rows of results, one for each point of a grid, as arrays with units."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from disc_model.data.variables import Variable
from disc_model.errors import DiscModelError
from disc_model.parameters import Parameters
from disc_model.status import Status

STATUSES = (
    "ok",
    *(status.value for status in Status if not status.complete),
    "failed",
)
"""What became of a point. `failed`: it raised an error, or was not reached."""
STATUS = Variable("1", "what became of the computation", STATUSES)


Row = Mapping[str, Any]
NUMERICAL = (DiscModelError, ArithmeticError, np.linalg.LinAlgError)
"""What a point may fail of: this package's errors, division by zero and overflow, matrices that cannot be solved."""


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

    def empty(self, shape: Sequence[int]) -> NDArray[Any]:
        """An array of nothing but `missing`."""
        return np.full(shape, self.missing, dtype=self.dtype)


class Quantity(Protocol):
    """What a module of a quantity has."""

    COLUMNS: Mapping[str, Column]

    def coordinates(self, options: Any) -> Mapping[str, tuple[Any, Variable]]:
        """Values along the quantity's own dimensions, beyond those of the grid."""

    def at(self, p: Parameters, options: Any) -> tuple[Row, str]:
        """Values at one point by column (flags as words), and a message; columns left out are missing."""


class Table(NamedTuple):
    """Arrays by variable, shape (points, ...), and one message a point, empty where all went well."""

    arrays: dict[str, NDArray[Any]]
    messages: list[str]


def compute(
    quantity: Quantity,
    points: Sequence[Parameters | DiscModelError],
    options: Any,
    each: Sequence[Any] | None = None,
) -> Table:
    """A quantity at each point; one that fails (see `NUMERICAL`) gets the status `failed` and a message.

    Parameters
    ----------
    points : parameters; an error stands for a point that could not be made, and is its message
    options : as `schema` says for this quantity
    each : options of each point, where they differ in its start
    """
    rows: list[Row] = []
    messages: list[str] = []
    for point, own in zip(points, each or [options] * len(points), strict=True):
        try:
            if isinstance(point, DiscModelError):
                raise point
            row, message = quantity.at(point, own)
        except NUMERICAL as error:
            row, message = {"status": "failed"}, f"{type(error).__name__}: {error}"
        rows.append(row)
        messages.append(message)
    sizes = {name: len(values) for name, (values, _) in quantity.coordinates(options).items()}
    arrays = {}
    for name, column in quantity.COLUMNS.items():
        shape = (len(rows), *(sizes[dim] for dim in column.dims))
        array = column.empty(shape)
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
