"""The batches of a grid study in one dataset over the grid.

    study = xarray.open_dataset("results/map_N/map_N.nc")
    study["first_separation"].sel(normalization="as_published").plot()

The dataset has every point of the grid with its `status`, and the results of its quantity's summary. A
zip is one dimension without a coordinate of its own. It is named after its parameters, which are variables along it.
"""

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, product
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.dataset import CONVENTIONS, common_provenance, json_attribute
from disc_model.data.variables import EXCLUDED, WITHOUT_CYCLE, flag_names, stated_in
from disc_model.errors import DiscModelError, as_text
from disc_model.studies.quantity import STATUSES, Quantity, quantity_of
from disc_model.studies.rules import holds
from disc_model.studies.run import POINT, coordinates_of, describe, variables_of


class MergeError(DiscModelError):
    """The batches are not those of the grid."""


def merge_batches(
    batches: Sequence[xr.Dataset], grid: Sequence[Mapping[str, Any]], attrs: Mapping[str, str]
) -> xr.Dataset:
    """Merge batches; raises `MergeError` if their dimensions disagree, or if they do not match the grid.

    batches : as `disc_model.studies.run.run_batch` makes them
    grid : dimensions, as from `disc_model.studies.grid.GridStudy.grid`
    attrs : further attributes, such as the title
    """
    try:
        flat = xr.concat(
            batches, POINT, join="exact", combine_attrs="override", data_vars="all", coords="minimal", compat="equals"
        )
    except ValueError as error:
        raise MergeError(f"the batches do not fit together: {error}") from None
    base = _common(batches)
    place = _places(flat, grid, attrs.get("where", ""), json.loads(base["base"]))
    sizes = {"_".join(dim["names"]): len(dim["values"]) for dim in grid}
    data = {}
    for name, variable in flat.data_vars.items():
        found = _with_excluded(variable) if (place < 0).any() else variable.variable
        values = found.values[place].reshape(*sizes.values(), *variable.shape[1:])
        data[name] = xr.Variable((*sizes, *map(str, variable.dims[1:])), values, found.attrs)
    coords: dict[Any, Any] = {
        name: xr.Variable("_".join(dim["names"]), np.array([value[i] for value in dim["values"]]), describe(name))
        for dim in grid
        for i, name in enumerate(dim["names"])
    }
    coords |= {name: flat[name] for name in flat.coords if name not in coords}
    merged = xr.Dataset(data, coords)
    merged.attrs = {"Conventions": CONVENTIONS, **attrs, **base}
    return summarised(merged, quantity_of(merged.attrs["quantity"]).model_validate(stated_in(merged, "options")))


def failures(study: xr.Dataset) -> Iterator[str]:
    """One line for each point without a result: its parameters, status and message; errors come first."""
    status = flag_names(study["status"])
    varied = [name for name in study.coords if set(study[name].dims) <= set(study["status"].dims)]
    failed = np.isin(status, STATUSES[1:])
    others = ~failed & (status != EXCLUDED) & ((status != "ok") | (study["message"].values != ""))
    for index in (*np.argwhere(failed), *np.argwhere(others)):
        place = dict(zip(map(str, study["status"].dims), map(int, index), strict=True))
        point = study.isel(place)
        values = {name: point[name].item() for name in varied}
        where = ", ".join(f"{name} = {x if isinstance(x, str) else as_text(x)}" for name, x in values.items())
        word, message = str(status[tuple(index)]), str(point["message"].item())
        what = WITHOUT_CYCLE.get(word, word)
        yield f"{where}: {message if message.startswith(what) else f'{what}: {message}'}"


def _with_excluded(variable: xr.DataArray) -> xr.Variable:
    """A variable along the points with one excluded point appended: missing, or a flag with a word of its own."""
    attrs = dict(variable.attrs)
    none: Any = math.nan if variable.dtype.kind == "f" else "" if variable.dtype.kind in "OUT" else 0
    if "flag_meanings" in attrs:
        words = [*attrs["flag_meanings"].split(), EXCLUDED]
        none = len(words) - 1
        attrs |= {"flag_meanings": " ".join(words), "flag_values": np.arange(len(words), dtype=np.int8)}
    more = np.full((1, *variable.shape[1:]), none, dtype=variable.dtype)
    return xr.Variable(variable.dims, np.concatenate([variable.values, more]), attrs)


def _places(flat: xr.Dataset, grid: Sequence[Mapping[str, Any]], where: str, base: Mapping[str, Any]) -> np.ndarray:
    """Row of each point, in the order of the grid, last dimension fastest; -1 for points excluded by a rule."""
    names = [name for dim in grid for name in dim["names"]]
    found = list(zip(*(flat[name].values.tolist() for name in names), strict=True))
    rows = {point: row for row, point in enumerate(found)}
    if twice := [point for row, point in enumerate(found) if rows[point] != row]:
        raise MergeError(f"there twice: {dict(zip(names, twice[0], strict=True))}")
    points = [tuple(chain.from_iterable(point)) for point in product(*(dim["values"] for dim in grid))]
    kept = [point for point in points if not where or holds([where], {**base, **dict(zip(names, point, strict=True))})]
    if missing := [point for point in kept if point not in rows]:
        raise MergeError(f"missing: {dict(zip(names, missing[0], strict=True))} and {len(missing) - 1} more")
    if len(kept) != len(rows):
        raise MergeError(f"{len(rows) - len(kept)} points do not belong to the grid")
    return np.array([rows.get(point, -1) for point in points])


def _common(batches: Sequence[xr.Dataset]) -> dict[str, str]:
    """Attributes common to all batches (quantity, options, base values, sources), and the commits that made them."""
    specification = json.loads(batches[0].attrs["specification"])
    for name in ("points", "names", "tile"):
        specification.pop(name, None)
    for key in specification.keys() & {"starts", "discs"}:
        every = [json.loads(batch.attrs["specification"])[key] for batch in batches]
        specification[key] = {name: one for named in every for name, one in sorted(named.items())}
    common = {name: value if isinstance(value, str) else json_attribute(value) for name, value in specification.items()}
    return common | common_provenance(batches)


# ----------------------------------------------------------------------------------------------------
# Summaries: they are made again at each merge, so that changing them recomputes no batch


def summarised(study: xr.Dataset, quantity: Quantity) -> xr.Dataset:
    """A merged study with the summary of its quantity, if there is one."""
    if not quantity.SUMMARY_COLUMNS:
        return study
    others = {str(dim): size for dim, size in study["status"].sizes.items() if dim != quantity.over}
    rows = [
        quantity.summarise(study.isel(dict(zip(others, index, strict=True)))) for index in np.ndindex(*others.values())
    ]
    own = coordinates_of(quantity.SUMMARY_COORDINATES, quantity)
    return study.assign_coords(own).assign(variables_of(quantity.SUMMARY_COLUMNS, own, rows, others))
