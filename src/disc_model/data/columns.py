"""Datasets of the numbers of a case: samples and events along a dimension, scalars, and parameters."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.dataset import CONVENTIONS
from disc_model.data.variables import CHOICES, SCALARS, SERIES, STATUSES, attributes
from disc_model.disc.flexibility import contact_compliance
from disc_model.errors import DiscModelError
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
