"""Critical values as a dataset: what was computed along the parameter, and the crossings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from disc_model.data.variables import Variable, attributes_of_number
from disc_model.sources import versions_text
from disc_model.stability.cycle import STICK_SLIP
from disc_model.stability.parameter_scan import SLIDING

if TYPE_CHECKING:
    from disc_model.stability.critical_values import Critical

RATES = {
    "growth_rate": Variable("s-1", "growth rate of disturbances of the motion"),
    "sliding_growth_rate": Variable(
        "s-1", "growth rate of steady sliding where this is the motion near the static start"
    ),
}
UNSTABLE_ABOVE = Variable("1", "whether the motion is unstable just above the change of stability")
UNSTABLE = {STICK_SLIP: "the stick-slip cycle", SLIDING: "steady sliding"}
"""What names of variables call the kinds of motion whose stability is followed."""
OF_PARAMETER = {
    "value": "critical value of {parameter} for instability of {motion}",
    "border": "{parameter} above which {motion} stays unstable",
    "crossings": "{parameter} at which stability of {motion} changes",
    "values": "{parameter} at which the motion was computed",
    "resolution": "largest step in {parameter} between computed values",
}
"""Variables in the unit of the parameter, and their names."""
SAVED = ("value", "border", "crossings", "resolution")
"""Those of them in a dataset, along which the values are a coordinate."""


def long_name_of(name: str, kind: str, meaning: str) -> str:
    """The name of a variable in the unit of the parameter, by what this means and the kind of motion."""
    return OF_PARAMETER[name].format(parameter=meaning, motion=UNSTABLE[kind])


def dataset_of(found: Critical) -> xr.Dataset:
    """Critical values as a dataset, as `Critical.to_dataset` describes it."""
    described = attributes_of_number(found.name)
    variables: dict[str, xr.Variable] = {}
    for name in SAVED:
        attrs = {**described, "long_name": long_name_of(name, found.kind, described["long_name"])}
        variables[name] = _variable(getattr(found, name), "crossing", attrs)
    for name in ("growth_rate", "sliding_growth_rate"):
        variables[name] = _variable(getattr(found, name), found.name, RATES[name].attributes)
    above = found.unstable_above
    variables["unstable_above"] = _variable(above, "crossing", UNSTABLE_ABOVE.attributes)
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
