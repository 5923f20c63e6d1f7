"""Summaries of merged studies over one dimension, for each value of the others.

The summary of a quantity is the module of the same name here. It is computed again at each merge, so that changing it
recomputes no batch.
"""

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np
import xarray as xr

from disc_model.studies.document import QUANTITIES
from disc_model.studies.grids.run import own_coordinates, variables_of


def summary_of(quantity: str) -> Any:
    """The summary of a quantity, or None: a module with `COLUMNS` and `COORDINATES` as a quantity has them.

    Its function `summarise(cell, options)` returns values by column, for a merged dataset that has only the summarised
    dimension left; a rule of the grid may leave out some of its points, or all.
    """
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
    others = {str(dim): size for dim, size in study["status"].sizes.items() if dim != QUANTITIES[quantity].over}
    cells = [study.isel(dict(zip(others, place, strict=True))) for place in np.ndindex(*others.values())]
    variables = variables_of(summary, [summary.summarise(cell, checked) for cell in cells], checked, others)
    return study.assign_coords(own_coordinates(summary, checked)).assign(variables)
