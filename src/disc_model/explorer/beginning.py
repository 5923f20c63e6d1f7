"""Where the explorer opens a study along dimensions that are on no axis of it."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from disc_model.figures.kinds.base import key_of
from disc_model.parameters import Parameters


def usual_place(study: xr.Dataset, dim: str, at: Mapping[str, Any]) -> int:
    """The place of a figure's value along a dimension, or else of the value that a case has unless it is
    given, or else the first place.

    at : values of a figure along dimensions that it does not show
    """
    if dim not in study.coords:
        return 0
    field = Parameters.model_fields.get(dim)
    for wanted in (at.get(dim), None if field is None else field.default):
        places = _places_of(study[dim].values, wanted)
        if places.size:
            return int(places[0])
    return 0


def _places_of(values: np.ndarray, wanted: Any) -> np.ndarray:
    """The places of a value among others; none for None."""
    if wanted is None:
        return np.array([], dtype=int)
    keys = [key_of(value) for value in values]
    return np.flatnonzero(np.array(keys) == key_of(wanted))
