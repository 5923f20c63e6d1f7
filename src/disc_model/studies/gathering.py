"""Results of any function as variables with units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.described import known_of
from disc_model.data.swept_branches import variables_of_branch
from disc_model.data.variables import CycleStatus, message_of
from disc_model.simulation.result import Result
from disc_model.stability.critical import Critical, attributes_of_critical

OF_A_CYCLE = ("releases", "backward_releases", "reversals", "separations", "sticks", "stable")
"""Variables that have no value without a cycle, though the result of `floquet` has a count or a verdict."""
BY_METHODS = ("stable", "at_lower_bound", "border", "stick_time", "slip_time")
"""Numbers and verdicts of results that are no fields of theirs, but follow from these."""


def variables_of_result(result: Any, function: str = "") -> dict[str, xr.Variable]:
    """Numbers, words and one-dimensional arrays of a result, such as the columns of a table; what else it
    holds is left out.

    Parameters
    ----------
    result : what a function has returned
    function : its name, if it is one of this package
    """
    if isinstance(result, xr.DataArray):
        result = result.to_dataset(name=result.name or "value")
    elif _is_whole_dataset(result):
        result = variables_of_branch(result.to_dataset())
    if isinstance(result, xr.Dataset):
        return {str(name): variable for name, variable in result.variables.items()}
    variables = {}
    known = _attributes_of(result, function)
    along = "row" if _is_table(result, 2) else ""
    for key, value in _named_values(result).items():
        name = str(key)
        array = np.array(str(value)) if isinstance(value, str) else np.asarray(value)
        if array.ndim <= 1 and array.dtype.kind in "biufcU":
            dims = (along or f"{name}_index",)[: array.ndim]
            variables[name] = xr.Variable(dims, array, known.get(name, {}))
    return variables


def _attributes_of(result: Any, function: str) -> Mapping[str, Mapping[str, Any]]:
    """Units and meanings of the variables of a result of this package by name; none of a reader's own
    results, whose names need not mean the same."""
    if isinstance(result, Critical):
        return attributes_of_critical(result)
    kind = type(result).__name__ if is_dataclass(result) else function
    if not kind:
        return {}
    return {name: known.texts() for name, known in known_of(kind).items() if not known.flags}


def _is_whole_dataset(result: Any) -> bool:
    """Whether a result of this package is gathered as its dataset; critical values are by their fields, as
    each point has values of its own along the parameter."""
    has_dataset = is_dataclass(result) and hasattr(result, "to_dataset")
    return has_dataset and not isinstance(result, Critical)


def _named_values(result: Any) -> Mapping[str, Any]:
    """The values of a result by name."""
    if isinstance(result, Result):
        return result.scalars()
    if is_dataclass(result):
        return _values_of_fields(result)
    if _is_table(result, 1):
        return {str(name): value for name, value in result.to_dict().items()}
    if _is_table(result, 2):
        return {str(name): np.array(column.tolist()) for name, column in result.items()}
    return result if isinstance(result, Mapping) else {"value": result}


def _is_table(result: Any, dimensions: int) -> bool:
    """Whether a result is a pandas.Series, of one dimension, or a pandas.DataFrame, of two."""
    return hasattr(result, "to_dict") and np.ndim(result) == dimensions


def _values_of_fields(result: Any) -> dict[str, Any]:
    """The values of a result of this package by name; nan where one has no cycle."""
    names = [field.name for field in fields(result) if not field.name.startswith("_")]
    values = {name: getattr(result, name) for name in names}
    for name in BY_METHODS:
        if hasattr(result, name):
            values[name] = getattr(result, name)
    if "message" in values:
        values["message"] = message_of(result)
    if _lacks_cycle(result):
        values |= dict.fromkeys(OF_A_CYCLE, math.nan)
    if hasattr(result, "sliding"):
        values["sliding_growth_rate"] = result.sliding.growth_rate
    return values


def _lacks_cycle(result: Any) -> bool:
    """Whether a result is one of `floquet`, which has found no cycle."""
    return type(result).__name__ == "FloquetResult" and result.status is not CycleStatus.OK
