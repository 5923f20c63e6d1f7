"""Critical values as a dataset: what was computed along the parameter, and the crossings."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from disc_model.data.variables import Variable, attributes_of_number
from disc_model.sources import versions_text

if TYPE_CHECKING:
    from disc_model.stability.critical_values import Critical

RATES = {
    "growth_rate": Variable("s-1", "growth rate of disturbances of the motion"),
    "sliding_growth_rate": Variable(
        "s-1", "growth rate of steady sliding where this is the motion near the static start"
    ),
    "other_growth_rate": Variable(
        "s-1",
        "growth rate of another cycle at the critical value, near the motion from the static start",
    ),
}
VERDICTS = {
    "unstable_above": Variable(
        "1", "whether the motion is unstable just above the change of stability"
    ),
    "near_motion": Variable(
        "1", "whether the motion from the static start may be near the unstable cycle"
    ),
}
OF_PARAMETER = {
    "value": "critical value of {}",
    "border": "{} above which the motion stays unstable",
    "crossings": "{} at which stability changes",
    "resolution": "largest step in {} between computed values",
}
"""Variables in the unit of the parameter, and their names."""


def dataset_of(found: Critical) -> xr.Dataset:
    """Critical values as a dataset, as `Critical.to_dataset` describes it."""
    described = attributes_of_number(found.name)
    variables: dict[str, xr.Variable] = {}
    for name, phrase in OF_PARAMETER.items():
        attrs = {**described, "long_name": phrase.format(described["long_name"])}
        variables[name] = _variable(getattr(found, name), "crossing", attrs)
    for name in ("growth_rate", "sliding_growth_rate"):
        variables[name] = _variable(getattr(found, name), found.name, RATES[name].attributes)
    other = found.other_growth_rate
    variables["other_growth_rate"] = _variable(other, "", RATES["other_growth_rate"].attributes)
    near = math.nan if found.near_motion is None else float(found.near_motion)
    variables["near_motion"] = _variable(near, "", VERDICTS["near_motion"].attributes)
    above = found.unstable_above
    variables["unstable_above"] = _variable(
        above, "crossing", VERDICTS["unstable_above"].attributes
    )
    attrs = {
        "kind": found.kind,
        "message": found.message,
        "name": found.name,
        "parameters": found.parameters.canonical_json,
        "versions": versions_text(),
    }
    coordinates = {found.name: xr.Variable(found.name, found.values, described)}
    return xr.Dataset(variables, coordinates, attrs)


def _variable(values: Any, dim: str, attrs: dict[str, Any]) -> xr.Variable:
    """A variable of numbers along a dimension, or of one number alone."""
    array = np.asarray(values)
    return xr.Variable((dim,)[: array.ndim], array, attrs)
