"""Variables that are True or False, as words."""

import numpy as np
import xarray as xr

from disc_model.data.variables import TRUTH
from disc_model.figures.selection import WITHOUT_CYCLE, statuses_like

OF_CYCLES = "stable"  # False, and no answer, where there is no cycle


def as_classes(study: xr.Dataset, variable: str) -> xr.DataArray:
    """The variable, with the words "no" and "yes" for False and True, and "" where there is
    neither, or no cycle that could be stable."""
    array = study[variable]
    of_truth = array.attrs.get("comment") == TRUTH["comment"]
    if not (of_truth or _are_truths(array)):
        return array
    words = np.where(array.values == 1, "yes", "no")
    words = np.where(array.isnull(), "", words)
    if variable == OF_CYCLES:
        words = np.where(np.isin(statuses_like(study, array), WITHOUT_CYCLE), "", words)
    return array.copy(data=words)


def are_of_classes(array: xr.DataArray) -> bool:
    """Whether values, as `as_classes` gives them, are words or flags, so that they have no scale."""
    return array.dtype.kind in "UO" or "flag_meanings" in array.attrs


def _are_truths(array: xr.DataArray) -> bool:
    """Whether values are True or False, but where xarray's where has masked them."""
    known = array.values[array.notnull().values]
    of_words = array.dtype.kind == "O" and known.size > 0
    return array.dtype.kind == "b" or (of_words and all(isinstance(x, bool) for x in known))
