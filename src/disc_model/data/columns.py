"""Datasets of the numbers of a case: samples and events along a dimension, scalars, and parameters."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.dataset import CONVENTIONS
from disc_model.data.described import known_of
from disc_model.data.variables import CHOICES, SCALARS, SERIES, STATUSES, attributes, message_of
from disc_model.disc.flexibility import contact_compliance
from disc_model.errors import DiscModelError, Fault, ParameterError
from disc_model.parameters import PLATE, RESIDUAL, SURFACE, Parameters


def series_dataset(columns: Mapping[str, Any], along: str) -> xr.Dataset:
    """Dataset of columns of numbers: samples along `time`, or events along `event`, as two may have
    the same time."""
    data: dict[str, Any] = {}
    for name, column in columns.items():
        kind: type = float
        if name in SERIES:
            kind = SERIES[name].dtype
        data[name] = (along, np.asarray(column, kind), attributes(name))
    return xr.Dataset(data).set_coords("time")


def scalars_dataset(
    p: Parameters, values: Mapping[str, Any], status: str, message: str
) -> xr.Dataset:
    """The root of a case: its scalars, `SCALARS`, of which most values are missing if it failed,
    and the parameters."""
    known = {"status": STATUSES.index(status), **values}
    data: dict[str, Any] = {
        name: ((), variable.dtype(known.get(name, variable.unknown)), variable.attributes)
        for name, variable in SCALARS.items()
    }
    for name, value in _parameter_values(p).items():
        if name in CHOICES:
            value = np.int8(CHOICES[name].index(value))
        data[name] = ((), value, attributes(name))
    attrs = {
        "Conventions": CONVENTIONS,
        "parameters": p.canonical_json,
        "parameters_key": p.key,
        "status": status,
        "message": message,
    }
    return xr.Dataset(data, attrs=attrs)


def _parameter_values(p: Parameters) -> dict[str, Any]:
    """The parameters by name: numbers in place of words where these stand for one, and nan for what
    has no value, or does not count beside another one."""
    values: dict[str, Any] = p.model_dump()
    values["stretching"] = p.stretching
    values["disc"] = ""
    if p.disc is not None:
        values["disc"] = p.disc.model_dump_json()  # variables hold no mapping
    if p.contact_compliance == RESIDUAL:
        # nan if no modes are left out for it, which has made the case fail
        values["contact_compliance"] = math.nan
        with contextlib.suppress(DiscModelError):
            values["contact_compliance"] = contact_compliance(p)
    if p.friction_offset == SURFACE:
        values["friction_offset"] = p.h / 2
        if p.disc is not None:  # it follows from the table
            values["friction_offset"] = math.nan
    if p.disc is not None:
        values["n_diameters"] = max(p.disc.diameters)
        values["n_circles"] = max(p.disc.circles)
        values["normalization"] = "orthonormal"  # as amplitudes per root of mass are

    unused = [name for name, value in values.items() if value is None]
    if p.disc is not None:
        unused += [name for name in PLATE if isinstance(values[name], float)]
    elif p.damping_ratio is not None:
        unused.append("D_star")
    values |= dict.fromkeys(unused, math.nan)
    return values


BY_METHODS = ("stable", "at_lower_bound", "border", "stick_time", "slip_time")
"""Numbers and verdicts of results that are no fields of theirs, but follow from these."""
OF_A_CYCLE = ("releases", "backward_releases", "reversals", "separations", "sticks", "stable")
"""Variables that have no value without a cycle, though the result of `floquet` has a count or a verdict."""


def result_dataset(result: Any, function: str = "") -> xr.Dataset:
    """What any function has returned as a dataset with a status and a message: numbers, words and
    one-dimensional arrays by name; raises `ParameterError` for anything else.

    Parameters
    ----------
    result : a dataset, a result of this package, a mapping, or one number
    function : its name, if it is one of this package
    """
    if isinstance(result, xr.Dataset):
        data, words = result, {"status": "ok", "message": result.attrs.get("message", "")}
    elif hasattr(result, "to_dataset"):
        data, words = result.to_dataset(), {"status": "ok", "message": message_of(result)}
    else:
        data = _dataset_of_values(_values_of(result), type(result).__name__ if is_dataclass(result) else function)
        words = {"status": str(getattr(result, "status", "ok")), "message": message_of(result)}
    if not data.variables:
        rule = "must return a number, a mapping of numbers, words and arrays of one dimension, or a dataset"
        raise ParameterError(Fault(("function",), function, rule))
    missing = {name: word for name, word in words.items() if name not in data}
    return xr.Dataset({**missing, **dict(data.data_vars)}, data.coords)


def _dataset_of_values(values: Mapping[str, Any], kind: str) -> xr.Dataset:
    """Numbers, words and one-dimensional arrays by name, with what the table says of them."""
    known = {name: each.texts() for name, each in known_of(kind).items() if not each.flags} if kind else {}
    variables = {}
    for name, value in values.items():
        array = np.array(str(value)) if isinstance(value, str) else np.asarray(value)
        if array.ndim <= 1 and array.dtype.kind in "biufcU":
            variables[name] = xr.Variable((f"{name}_index",)[: array.ndim], array, known.get(name, {}))
    return xr.Dataset(variables)


def _values_of(result: Any) -> Mapping[str, Any]:
    """The values of a result by name; nan where a result of `floquet` has no cycle."""
    if hasattr(result, "scalars"):
        return dict(result.scalars())
    if not is_dataclass(result):
        return result if isinstance(result, Mapping) else {"value": result}
    names = [each.name for each in fields(result) if not each.name.startswith("_")]
    values = {name: getattr(result, name) for name in (*names, *BY_METHODS) if hasattr(result, name)}
    if "message" in values:
        values["message"] = message_of(result)
    if getattr(result, "sliding", None) is not None:
        values["sliding_growth_rate"] = result.sliding.growth_rate
        if result.status != "ok":
            values |= dict.fromkeys(OF_A_CYCLE, math.nan)
    return values
