"""The batches of a grid study in one dataset over the grid, and named cases in one tree.

A zip is one dimension without a coordinate of its own. It is named after its parameters, which are
variables along it.
"""

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.dataset import CONVENTIONS, common_provenance, json_attribute
from disc_model.data.variables import EXCLUDED, WITHOUT_CYCLE, flag_names
from disc_model.errors import DiscModelError, as_text
from disc_model.parameters import RATIOS, in_words
from disc_model.studies.quantity import Quantity, quantity_of
from disc_model.studies.run import POINT, coordinates_of, describe, variables_of

JOINED: Any = {
    "join": "exact",
    "combine_attrs": "override",
    "data_vars": "all",
    "coords": "minimal",
}


class MergeError(DiscModelError):
    """The batches are not those of the grid."""


def merge_batches(
    batches: Sequence[xr.Dataset], grid: Sequence[Mapping[str, Any]], attrs: Mapping[str, str]
) -> xr.Dataset:
    """Merge batches; raises `MergeError` if they do not match `grid`, as of `GridStudy.grid`."""
    flat = xr.concat(batches, POINT, compat="equals", **JOINED)
    every = [json.loads(batch.attrs["specification"]) for batch in batches]
    common = {
        name: value for name, value in every[0].items() if name not in ("points", "names", "tile")
    }
    quantity = quantity_of(common["quantity"]).model_validate(common["options"])
    common["base"] = _fixed(in_words(common["base"]), quantity)
    for key in common.keys() & {"starts", "discs"}:
        common[key] = {
            name: definition for each in every for name, definition in sorted(each[key].items())
        }
    base = {
        name: value if isinstance(value, str) else json_attribute(value)
        for name, value in common.items()
    }
    indices = []
    for dim in grid:  # -1 for a value that the grid does not have
        known = {tuple(value): i for i, value in enumerate(dim["values"])}
        columns = (flat[name].values.tolist() for name in dim["names"])
        indices.append([known.get(value, -1) for value in zip(*columns, strict=True)])
    dims, shape = ["_".join(dim["names"]) for dim in grid], [len(dim["values"]) for dim in grid]
    points, size = {*zip(*indices, strict=True)}, math.prod(shape)
    complete = len(points) == size or "where" in attrs  # a rule leaves points out
    if not complete or len(points) < flat.sizes[POINT] or any(-1 in point for point in points):
        raise MergeError(
            f"the batches have {len(points)} different points, which are not those of the grid"
        )
    variables, coords = {}, dict[Any, Any](flat.drop_dims(POINT).coords)
    for name, variable in flat.data_vars.items():
        nothing, more = _excluded(variable) if len(points) < size else (0, {})
        array = np.full((*shape, *variable.shape[1:]), nothing, variable.dtype)
        array[tuple(indices)] = variable.values
        variables[name] = xr.Variable(
            (*dims, *variable.dims[1:]), array, variable.attrs | more, variable.encoding
        )
    for dim, along in zip(grid, dims, strict=True):
        for name, values in zip(dim["names"], zip(*dim["values"], strict=True), strict=True):
            coords[name] = (along, np.array(values), describe(name))
    merged = xr.Dataset(
        variables,
        coords,
        {"Conventions": CONVENTIONS, **attrs, **base, **common_provenance(batches)},
    )
    return summarised(merged, quantity)


def _fixed(base: Mapping[str, Any], quantity: Quantity) -> dict[str, Any]:
    """The values of a base that a quantity does not vary by itself: of others it has those with
    which the file was checked, such as a speed of zero."""
    varied = {*quantity.scanned, *(RATIOS[name][0] for name in quantity.scanned if name in RATIOS)}
    return {name: value for name, value in base.items() if name not in varied}


def failures(study: xr.Dataset) -> Iterator[str]:
    """One line for each point without a result, or with a message: its parameters, status and
    message."""
    status = flag_names(study["status"])
    varied = [name for name in study.coords if set(study[name].dims) <= set(study["status"].dims)]
    for index in np.argwhere(
        (status != EXCLUDED) & ((status != "ok") | (study["message"].values != ""))
    ):
        point = study.isel(dict(zip(study["status"].dims, index, strict=True)))
        values = {name: point[name].item() for name in varied}
        where = ", ".join(
            f"{name} = {x if isinstance(x, str) else as_text(x)}" for name, x in values.items()
        )
        word, message = str(status[tuple(index)]), str(point["message"].item())
        what = WITHOUT_CYCLE.get(word, word)
        yield f"{where}: {message if message.startswith(what) else f'{what}: {message}'}"


def _excluded(variable: xr.DataArray) -> tuple[Any, dict[str, Any]]:
    """The value of a variable at an excluded point; for a flag its last one, and attributes with a
    word for it."""
    if "flag_meanings" in variable.attrs:
        words = [*variable.attrs["flag_meanings"].split(), EXCLUDED]
        numbers = np.arange(len(words), dtype=np.int8)
        return numbers[-1], {"flag_meanings": " ".join(words), "flag_values": numbers}
    return math.nan if variable.dtype.kind == "f" else "" if variable.dtype.kind in "OUT" else 0, {}


def summarised(study: xr.Dataset, quantity: Any) -> xr.Dataset:
    """A merged study with the summary of its quantity, if there is one. Changing a summary
    recomputes no batch."""
    if not quantity.SUMMARY_COLUMNS:
        return study
    others = {str(dim): size for dim, size in study["status"].sizes.items() if dim != quantity.over}
    cells = (dict(zip(others, index, strict=True)) for index in np.ndindex(*others.values()))
    rows = [quantity.summarise(study.isel(cell)) for cell in cells]
    coords = coordinates_of(quantity.SUMMARY_COORDINATES, quantity)
    return study.assign_coords(coords).assign(
        variables_of(quantity.SUMMARY_COLUMNS, coords, rows, others)
    )


def merge_cases(
    cases: Mapping[str, xr.DataTree], labels: Mapping[str, Mapping[str, str]]
) -> xr.DataTree:
    """Put cases into one tree: a table of scalars along `case`, and below it a group for each, laid
    out as in its file. The labels, by case, are texts that become variables of the table: title and
    reference."""
    rows = [tree.to_dataset() for tree in cases.values()]
    table = xr.concat(rows, dim="case", **JOINED)
    table = table.assign_coords(case=("case", list(cases), {"long_name": "name of the case"}))
    texts = [
        {"message": row.attrs["message"], **labels.get(case, {})}
        for case, row in zip(cases, rows, strict=True)
    ]
    for name, meaning in _TEXTS.items():
        table[name] = (
            "case",
            np.array([text.get(name, "") for text in texts], dtype=str),
            {"long_name": meaning},
        )
    table.attrs = {"Conventions": CONVENTIONS, **common_provenance(rows)}
    return xr.DataTree(table, children=cases)


_TEXTS = {
    "message": "what ended the simulation early",
    "reference": "place in the paper",
    "title": "what the case is",
}
