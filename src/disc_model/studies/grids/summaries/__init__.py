"""Summaries of merged studies over one dimension, for each value of the others.

The summary of a quantity is the module of the same name here. It is computed again at each merge, so that changing it
recomputes no batch.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any, Protocol

import numpy as np
import xarray as xr

from disc_model.studies.document import QUANTITIES
from disc_model.studies.grids.points import Row
from disc_model.studies.grids.run import Described, arrays_of, own_coordinates


class Summary(Described, Protocol):
    """A module of a summary."""

    def summarise(self, cell: xr.Dataset, options: Any) -> Row:
        """Values by column, for a merged dataset that has only the summarised dimension left."""


def summary_of(quantity: str) -> Summary | None:
    """The summary of a quantity, if it has one."""
    if not QUANTITIES[quantity].over:
        return None
    # their import loads the engine, which most merges do not need
    from disc_model.studies.grids.summaries import campbell, sensitivity

    return campbell if quantity == "campbell" else sensitivity


def summarised(study: xr.Dataset, quantity: str, options: Mapping[str, Any]) -> xr.Dataset:
    """A merged study with the summary of its quantity, if there is one; options are as in the batches."""
    summary = summary_of(quantity)
    if summary is None:
        return study
    checked = SimpleNamespace(**options)
    others = [dim for dim in map(str, study["status"].dims) if dim != QUANTITIES[quantity].over]
    sizes = [study.sizes[dim] for dim in others]
    cells = [study.isel(dict(zip(others, place, strict=True))) for place in np.ndindex(*sizes)]
    arrays = arrays_of(summary, [summary.summarise(cell, checked) for cell in cells], checked)
    variables = {}
    for name, column in summary.COLUMNS.items():
        values = arrays[name].reshape((*sizes, *arrays[name].shape[1:]))
        variables[name] = xr.Variable((*others, *column.dims), values, column.variable.attributes)
    return study.assign_coords(own_coordinates(summary, checked)).assign(variables)
