"""Datasets of the numbers of a case: samples and events along a dimension, scalars, and what functions
return."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import xarray as xr
from xarray import Dataset

from disc_model.data.dataset import CONVENTIONS
from disc_model.data.variables import (
    SCALARS,
    SERIES,
    STATUSES,
    Entries,
    attributes,
    described,
    message_of,
)
from disc_model.errors import Fault, ParameterError
from disc_model.parameters import Parameters


def series_dataset(columns: Entries, along: str) -> Dataset:
    """Dataset of columns of numbers: samples along `time`, or events along `event`, as two may have
    the same time."""
    data: Entries = {}
    for name, column in columns.items():
        array = np.asarray(column, float)
        if name in SERIES:
            array = np.asarray(column, SERIES[name].dtype)
        data[name] = (along, array, attributes(name))
    return Dataset(data).set_coords("time")


def scalars_dataset(p: Parameters, values: Entries, status: str, message: str) -> Dataset:
    """The root of a case: its scalars, `SCALARS`, of which most values are missing if it failed,
    and the parameters as an attribute."""
    known = {"status": STATUSES.index(status), **values}
    data = {
        name: ((), variable.dtype(known.get(name, variable.unknown)), variable.attributes)
        for name, variable in SCALARS.items()
    }
    attrs = {
        "Conventions": CONVENTIONS,
        "parameters": p.canonical_json,
        "parameters_key": p.key,
        "status": status,
        "message": message,
    }
    return Dataset(data, attrs=attrs)


# ---- What functions return

BY_METHODS = ("stable", "frequency", "stick_time", "slip_time", "sliding_growth_rate")
"""Numbers and verdicts of results that are no fields of theirs, but follow from these."""
OF_A_CYCLE = ("releases", "backward_releases", "reversals", "separations", "sticks", "stable")
"""Variables that have no value without a cycle, though the result of `floquet` has a count or a verdict."""


def result_dataset(result: Any, function: str = "") -> Dataset:
    """What any function has returned as a dataset with a status and a message: numbers, words and
    one-dimensional arrays by name; raises `ParameterError` for anything else.

    Parameters
    ----------
    result : a dataset, a result of this package, whose attributes become variables, a mapping, or one number
    function : its name, if it is one of this package
    """
    kind = function
    if is_dataclass(result):
        kind = type(result).__name__
    if isinstance(result, Dataset):
        data = result
    elif hasattr(result, "to_dataset"):
        data = result.to_dataset()
        stated = {name: x for name, x in data.attrs.items() if name not in ("message", "versions")}
        data = data.assign(_dataset_of_values(stated, kind))
    else:
        data = _dataset_of_values(_values_of(result), kind)
    if not data.variables:
        rule = "must return a number, a mapping of numbers, words and arrays of one dimension, or a dataset"
        raise ParameterError(Fault(("function",), function, rule))
    words = {"status": str(getattr(result, "status", "ok")), "message": message_of(result)}
    return with_real_parts(Dataset({**words, **data.data_vars}, data.coords))


def _dataset_of_values(values: Mapping[Any, Any], kind: str) -> Dataset:
    """Numbers, words and one-dimensional arrays by name, with what the table says of them."""
    variables = {}
    for name, value in values.items():
        array = np.asarray(str(value) if isinstance(value, str) else value)
        if array.ndim <= 1 and array.dtype.kind in "biufcU":
            variables[name] = ((f"{name}_index",)[: array.ndim], array)
    return described(Dataset(variables), kind)


def _values_of(result: Any) -> Entries:
    """The values of a result by name; nan where a result of `floquet` has no cycle."""
    if isinstance(result, Mapping):
        return dict(result)
    if hasattr(result, "scalars"):
        return dict(result.scalars())
    if not is_dataclass(result):
        return {"value": result}
    names = [each.name for each in fields(result) if not each.name.startswith("_")]
    every = {name: getattr(result, name, None) for name in (*names, *BY_METHODS)}
    values = {name: value for name, value in every.items() if value is not None}
    if "multipliers" in values and values["status"] != "ok":
        values |= dict.fromkeys(OF_A_CYCLE, math.nan)
    return {**values, "message": message_of(result)}


def with_real_parts(data: Dataset) -> Dataset:
    """A dataset with the real and the imaginary part of each complex variable x in its place, x_real and
    x_imag: files have no complex numbers."""
    parts: dict[str, xr.DataArray] = {}
    for name, x in data.data_vars.items():
        if x.dtype.kind == "c":
            parts |= {f"{name}_real": x.real, f"{name}_imag": x.imag}
    return data.drop_vars({x.name for x in parts.values()}).assign(parts)
