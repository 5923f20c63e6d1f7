"""The batches of a grid study in one dataset over the grid, and named cases in one tree.

A zip is one dimension without a coordinate of its own. It is named after its parameters, which are
variables along it.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.data.dataset import CONVENTIONS, common_provenance, json_attribute
from disc_model.data.described import described
from disc_model.data.variables import EXCLUDED, Variable
from disc_model.errors import DiscModelError
from disc_model.parameters import PLATE, RATIOS
from disc_model.studies.batch import Batch, GridAxis
from disc_model.studies.quantity import Quantity
from disc_model.studies.registry import quantity_of
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
    batches: Sequence[xr.Dataset], grid: Sequence[GridAxis], attrs: Mapping[str, str]
) -> xr.Dataset:
    """Merge batches into one dataset over a grid.

    Parameters
    ----------
    batches : as `disc_model.studies.run.run_batch` makes them
    grid : dimensions of the grid, as of `GridStudy.grid`
    attrs : attributes of the study

    Raises
    ------
    MergeError
        If the batches do not match the grid.
    """
    flat = xr.concat(batches, POINT, compat="equals", **JOINED)
    specified = [Batch.model_validate_json(batch.attrs["specification"]) for batch in batches]
    first = specified[0]
    quantity = quantity_of(first.quantity).model_validate(first.options)
    places = _places(flat, grid, complete="where" not in attrs)

    shape = [len(dim.values) for dim in grid]
    dims = [dim.name for dim in grid]
    left_out = flat.sizes[POINT] < math.prod(shape)
    variables = {}
    for name, variable in flat.data_vars.items():
        nothing: Any = 0
        changed = dict(variable.attrs)
        if left_out:
            nothing, flags = _excluded(variable)
            changed.update(flags)
        array = np.full((*shape, *variable.shape[1:]), nothing, variable.dtype)
        array[places] = variable.values
        along = (*dims, *variable.dims[1:])
        variables[name] = xr.Variable(along, array, changed, variable.encoding)

    coords = dict[Any, Any](flat.drop_dims(POINT).coords)
    for dim in grid:
        columns = zip(*dim.values, strict=True)
        for name, values in zip(dim.names, columns, strict=True):
            coords[name] = (dim.name, np.array(values), describe(name))
    every = {
        "Conventions": CONVENTIONS,
        **attrs,
        **_common_attributes(specified, quantity),
        **common_provenance(batches),
    }
    study = summarised(xr.Dataset(variables, coords, every), quantity)
    return described(study, first.quantity, quantity.model_dump())


def _places(
    flat: xr.Dataset, grid: Sequence[GridAxis], *, complete: bool
) -> tuple[NDArray[np.int64], ...]:
    """Return the index of each point along each dimension of a grid, which has all points if it is
    `complete`; raises `MergeError` if the points are not those of the grid."""
    indices = []
    for dim in grid:
        known = {value: i for i, value in enumerate(dim.values)}
        columns = [flat[name].values.tolist() for name in dim.names]
        values = zip(*columns, strict=True)
        # -1 for a value that the grid does not have
        indices.append(np.array([known.get(value, -1) for value in values]))
    points = set(zip(*(index.tolist() for index in indices), strict=True))

    missing = complete and len(points) != math.prod(len(dim.values) for dim in grid)
    repeated = len(points) < flat.sizes[POINT]
    unknown = any((index < 0).any() for index in indices)
    if missing or repeated or unknown:
        raise MergeError(
            f"the batches have {len(points)} different points, which are not those of the grid"
        )
    return tuple(indices)


def _common_attributes(batches: Sequence[Batch], quantity: Quantity) -> dict[str, str]:
    """Return attributes that describe what the batches have in common, and all their discs."""
    first = batches[0]
    discs: dict[str, Any] = {}
    for batch in batches:
        discs.update((name, disc.model_dump()) for name, disc in batch.discs.items())
    common = {
        "quantity": first.quantity,
        "options": json_attribute(first.options),
        "base": json_attribute(fixed_base(first.base, first.names, quantity)),
    }
    if discs:
        common["discs"] = json_attribute(dict(sorted(discs.items())))
    return common


def fixed_base(base: Mapping[str, Any], names: Sequence[str], quantity: Quantity) -> dict[str, Any]:
    """The values of a base that all points have: not of what a quantity varies by itself, of which
    it has those with which the file was checked, such as a speed of zero; nor the damping that a
    damping ratio replaces, which may be among the names of axes; nor what a plate has, of a disc that
    is given by its modes."""
    varied = {*quantity.scanned}
    varied.update(RATIOS[name][0] for name in quantity.scanned if name in RATIOS)
    if "damping_ratio" in names or base.get("damping_ratio") is not None:
        varied.add("D_star")
    if "disc" in names or base.get("disc") is not None:
        varied.update((*PLATE, "damping_ratio"))
    return {name: value for name, value in base.items() if name not in varied}


def _excluded(variable: xr.DataArray) -> tuple[Any, dict[str, Any]]:
    """Return the value of a variable at an excluded point, and for a flag, of which it is the last
    one, attributes with a word for it."""
    if "flag_meanings" in variable.attrs:
        words = [*variable.attrs["flag_meanings"].split(), EXCLUDED]
        numbers = np.arange(len(words), dtype=np.int8)
        return numbers[-1], {"flag_meanings": " ".join(words), "flag_values": numbers}
    if variable.dtype.kind == "f":
        return math.nan, {}
    return ("" if variable.dtype.kind in "OUT" else 0), {}


def summarised(study: xr.Dataset, quantity: Any) -> xr.Dataset:
    """A merged study with the summary of its quantity, if there is one. Changing a summary
    recomputes no batch."""
    if not quantity.SUMMARY_COLUMNS:
        return study
    others = {str(dim): size for dim, size in study["status"].sizes.items() if dim != quantity.over}
    rows = []
    for index in np.ndindex(*others.values()):
        cell = dict(zip(others, index, strict=True))
        rows.append(quantity.summarise(study.isel(cell)))
    coords = coordinates_of(quantity.SUMMARY_COORDINATES, quantity)
    for name, coordinate in coords.items():
        coords[name] = _with_room(coordinate, quantity.SUMMARY_COLUMNS, rows)
    summary = variables_of(quantity.SUMMARY_COLUMNS, coords, rows, others)
    return study.assign_coords(coords).assign(summary)


def _with_room(
    numbers: xr.Variable, columns: Mapping[str, Variable], rows: Sequence[Mapping[str, Any]]
) -> xr.Variable:
    """A dimension that numbers what was found, with as many numbers as the longest row needs."""
    found = [numbers.size]
    for name, column in columns.items():
        if column.dims == numbers.dims:
            found += [len(row[name]) for row in rows if name in row]
    first = int(numbers.values[0])
    return xr.Variable(numbers.dims, np.arange(first, first + max(found)), numbers.attrs)


def merge_cases(
    cases: Mapping[str, xr.DataTree], labels: Mapping[str, Mapping[str, str]]
) -> xr.DataTree:
    """Put cases into one tree: a table of scalars along `case`, and below it a group for each, laid
    out as in its file. The labels, by case, are texts that become variables of the table: title and
    reference."""
    rows = [tree.to_dataset() for tree in cases.values()]
    table = xr.concat(rows, dim="case", **JOINED)
    table = table.assign_coords(case=("case", list(cases)))
    texts = []
    for case, row in zip(cases, rows, strict=True):
        texts.append({"message": row.attrs["message"], **labels.get(case, {})})
    for name in ("message", "reference", "title"):
        table[name] = ("case", np.array([text.get(name, "") for text in texts], dtype=str))
    table.attrs = {"Conventions": CONVENTIONS, **common_provenance(rows)}
    return xr.DataTree(described(table, "Result"), children=cases)
