"""Running one batch of a grid study for the workflow."""

from __future__ import annotations

import importlib
import json
import logging
import time
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.dataset import CONVENTIONS, json_attribute
from disc_model.data.provenance import git_commit, versions
from disc_model.data.variables import CHOICES, KICKS, Variable, attributes
from disc_model.errors import DiscModelError
from disc_model.parameters import Parameters
from disc_model.simulation.case import START, Start
from disc_model.studies.grids.quantities.table import Column, Quantity, compute
from disc_model.truncation import AUTO, read_parameters

log = logging.getLogger(__name__)
POINT = "point"
SCHEMA = "disc_model.studies.grids.quantities.schema"
"""By name, since it is no source of a batch: the text of a batch holds the values of all options."""


def run_batch(text: str) -> xr.Dataset:
    """Compute a batch, given as a text of `disc_model.studies.grids.schema.batch_texts`.

    The dataset has the quantity's variables along `point`, and the parameters that vary beside them.
    """
    data = json.loads(text)
    names, points = data["names"], data["points"]
    schema = importlib.import_module(SCHEMA)
    quantity: Quantity = importlib.import_module(schema.module_of(data["quantity"]))
    options = schema.QUANTITIES[data["quantity"]].options.model_validate(data["options"])
    varied = [dict(zip(names, point, strict=True)) for point in points]
    parameters = [_made(data["base"] | _only(Parameters.model_fields, values)) for values in varied]
    each = [_started(options, values, data.get("starts", {})) for values in varied]
    began = time.process_time()
    table = compute(quantity, parameters, options, each)
    log.info("%d points, %.3f s of processor time", len(points), time.process_time() - began)
    for point, message in zip(points, table.messages, strict=True):
        if message:
            log.warning("%s: %s", dict(zip(names, point, strict=True)), message)
    variables = {name: _variable(column, table.arrays[name]) for name, column in quantity.COLUMNS.items()}
    if data["base"].get("n_diameters") == AUTO:
        variables |= {name: _chosen(name, parameters) for name in ("n_diameters", "n_circles")}
    variables["message"] = xr.Variable(POINT, np.array(table.messages, dtype=str), {"long_name": "what went wrong"})
    coords = {name: _coordinate(name, [point[i] for point in points]) for i, name in enumerate(names)}
    own = {name: (name, *_described(values)) for name, values in quantity.coordinates(options).items()}
    attrs = {
        "Conventions": CONVENTIONS,
        "specification": text,
        "git_commit": git_commit(),
        "versions": json_attribute(versions()),
    }
    return xr.Dataset(variables, coords | own, attrs)


def _only(names: Collection[str], values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if name in names}


def _started(options: Any, values: Mapping[str, Any], starts: Mapping[str, Any]) -> Any:
    """The options of a point, with its start and its kicks."""
    if START in values:
        start = Start.model_validate(starts[values[START]])
        options = options.model_copy(update={"prepare": start.prepare, "kick": start.kick})
    kicks = {name.removeprefix("kick_"): value for name, value in _only(KICKS, values).items()}
    return options.kicked(kicks) if kicks else options


def _made(values: Mapping[str, Any]) -> Parameters | DiscModelError:
    """The parameters of a point, or why there are none: no number of modes may meet the tolerance."""
    try:
        return read_parameters(values)[0]
    except DiscModelError as error:
        return error


def _chosen(name: str, parameters: Sequence[Parameters | DiscModelError]) -> xr.Variable:
    """What was chosen for each point, -1 where nothing could be."""
    return xr.Variable(POINT, np.array([getattr(p, name, -1) for p in parameters]), attributes(name))


def describe(name: str) -> dict[str, Any]:
    """Attributes of what varies, a coordinate; choices are stored as words, without unit."""
    if name == START:
        return {"long_name": "where the motion starts"}
    described = attributes(name)
    return {"long_name": described["long_name"]} if name in CHOICES else described


def _variable(column: Column, values: np.ndarray) -> xr.Variable:
    return xr.Variable((POINT, *column.dims), values, _attributes(column.variable))


def _attributes(variable: Variable) -> dict[str, Any]:
    attrs: dict[str, Any] = {"long_name": variable.long_name}
    if variable.units:
        attrs["units"] = variable.units
    if variable.flags:
        attrs["flag_values"] = np.arange(len(variable.flags), dtype=np.int8)
        attrs["flag_meanings"] = " ".join(variable.flags)
    return attrs


def _coordinate(name: str, values: Sequence[Any]) -> xr.Variable:
    return xr.Variable(POINT, np.array(values), describe(name))


def _described(given: tuple[np.ndarray, Variable]) -> tuple[np.ndarray, Mapping[str, Any]]:
    values, variable = given
    return values, _attributes(variable)
