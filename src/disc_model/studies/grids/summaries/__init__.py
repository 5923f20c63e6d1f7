"""What a merged study says beyond its points: a summary over one of its dimensions, for each value of the others.

A summary is a module here, of its quantity's name. It is worked out again at each merge, so that a change of it
computes no batch anew.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any, Protocol

import numpy as np
import xarray as xr

from disc_model.studies.grids.points import Row
from disc_model.studies.grids.run import Described, own_coordinates, table_of


class Summary(Described, Protocol):
    """A module of a summary.

    OVER : the dimension that it is over
    """

    OVER: str

    def summarise(self, cell: xr.Dataset, options: Any) -> Row:
        """Values by column, of a merged dataset of which only the dimension is left that the summary is over."""


def summary_of(quantity: str) -> Summary | None:
    """The summary of a quantity, if it has one."""
    # the engine comes with them, which most merges do without
    if quantity == "campbell":
        from disc_model.studies.grids.summaries import campbell

        return campbell
    if quantity == "sensitivity":
        from disc_model.studies.grids.summaries import sensitivity

        return sensitivity
    return None


def summarised(study: xr.Dataset, quantity: str, options: Mapping[str, Any]) -> xr.Dataset:
    """A merged study with the summary of its quantity, if this has one; its options are as its batches hold them."""
    summary = summary_of(quantity)
    if summary is None:
        return study
    checked = SimpleNamespace(**options)
    others = [dim for dim in map(str, study["status"].dims) if dim != summary.OVER]
    sizes = [study.sizes[dim] for dim in others]
    cells = [study.isel(dict(zip(others, place, strict=True))) for place in np.ndindex(*sizes)]
    arrays = table_of(summary, [(summary.summarise(cell, checked), "") for cell in cells], checked).arrays
    variables = {}
    for name, column in summary.COLUMNS.items():
        values = arrays[name].reshape((*sizes, *arrays[name].shape[1:]))
        variables[name] = xr.Variable((*others, *column.dims), values, column.variable.attributes)
    return study.assign_coords(own_coordinates(summary, checked)).assign(variables)
