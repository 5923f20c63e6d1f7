"""Heights of the points of a variable above the axis of its lines."""

import numpy as np
import xarray as xr

from disc_model.figures.rate_scale import without_rounding
from disc_model.figures.truths import as_classes
from disc_model.figures.words import as_numbers, measured


def heights_of(study: xr.Dataset, variable: str) -> tuple[list[str], xr.DataArray]:
    """Names of the classes of a variable, if it has any, and its heights above the axis: without those
    of -inf, which are marked above the panel."""
    names, array = as_numbers(as_classes(study, variable))
    array = array.copy(data=measured(array).values)
    array = without_rounding(array)
    return names, array.where(~np.isneginf(array))
