"""Results of any function as variables with units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.missing import reason_of, with_reason
from disc_model.data.swept_branches import variables_of_branch
from disc_model.data.variables import COORDINATES, OF_RESULTS, SCALARS, CycleStatus
from disc_model.parameters import RATIOS, Parameters
from disc_model.simulation.result import Result
from disc_model.stability.critical_values import Critical
from disc_model.studies.registry import quantity_names, quantity_of
from disc_model.studies.run import describe


@cache
def _common() -> dict[str, dict[str, Any]]:
    """Units and names that all quantities and simulations give a variable of this name; what they
    disagree about is left out, since such a name says nothing of another result's variable."""
    tables = [quantity_of(name).COLUMNS for name in quantity_names()]
    found: dict[str, list[dict[str, Any]]] = {}
    for table in (*tables, SCALARS):
        for name, column in table.items():
            if column.units and not column.flags:
                found.setdefault(name, []).append(column.attributes)
    common = {}
    for name, several in found.items():
        first = several[0]
        common[name] = {
            key: first[key] for key in first if all(each[key] == first[key] for each in several)
        }
    return common


@cache
def _of_kind(kind: str) -> dict[str, dict[str, Any]]:
    """Units and names of the variables of a class of results, or of a function of plain numbers,
    which has names of its own: a cycle and steady sliding both have a growth rate."""
    columns = dict(OF_RESULTS.get(kind, {}))
    of_cycle = quantity_of("floquet").COLUMNS
    match kind:
        case "FloquetResult":
            columns = {**of_cycle, **columns}
        case "SteadySliding":
            columns |= {"growth_rate": of_cycle["sliding_growth_rate"], **COORDINATES}
        case "Result":
            columns = dict(SCALARS)
    return {name: column.attributes for name, column in columns.items() if not column.flags}


OF_A_CYCLE = (
    "releases",
    "backward_releases",
    "reversals",
    "separations",
    "sticks",
    "stable",
    "near_motion",
)
"""Variables that have no value without a cycle, though the result of `floquet` has a count or a verdict."""
BY_METHODS = ("stable", "at_lower_bound", "border", "stick_time", "slip_time")
"""Numbers and verdicts of results that are no fields of theirs, but follow from these."""
OF_PARAMETER = {
    "value": "critical value of {}",
    "border": "{} above which the motion stays unstable",
    "crossings": "{} at which stability changes",
    "values": "{} at which the motion was computed",
    "resolution": "largest step in {} between computed values",
}
"""Variables of `Critical` that are in the unit of its parameter, and their names."""


def _attributes_of(result: Any, name: str, function: str) -> dict[str, Any]:
    """Unit and name of a variable of a result of this package; empty if they are not known, and of a
    reader's own results, whose names need not mean the same."""
    kind = type(result).__name__
    if not is_dataclass(type(result)):
        return _of_kind(function).get(name, {})
    if kind == "Critical" and name in OF_PARAMETER:
        along = result.name
        parameter = {}
        # numbers of a disc's modes have no unit here
        if along in (*Parameters.model_fields, *RATIOS):
            parameter = describe(along)
        meaning = parameter.get("long_name", along)
        return {**parameter, "long_name": OF_PARAMETER[name].format(meaning)}
    return _of_kind(kind).get(name) or _common().get(name, {})


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
    along = "row" if _is_table(result, 2) else ""
    for key, value in _named_values(result).items():
        name = str(key)
        array = np.array(str(value)) if isinstance(value, str) else np.asarray(value)
        if array.ndim <= 1 and array.dtype.kind in "biufcU":
            attributes = _attributes_of(result, name, function)
            if array.dtype.kind in "fc":
                attributes = with_reason(attributes, reason_of(type(result).__name__, name))
            variables[name] = xr.Variable(
                (along or f"{name}_index",)[: array.ndim], array, attributes
            )
    return variables


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
    if _lacks_cycle(result):
        values |= dict.fromkeys(OF_A_CYCLE, math.nan)
    if "near_motion" in values and values["near_motion"] is None:
        values["near_motion"] = math.nan
    if hasattr(result, "sliding"):
        values["sliding_growth_rate"] = result.sliding.growth_rate
    return values


def _lacks_cycle(result: Any) -> bool:
    """Whether a result is one of `floquet`, which has found no cycle."""
    return type(result).__name__ == "FloquetResult" and result.status is not CycleStatus.OK
