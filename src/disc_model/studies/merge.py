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
import pandas as pd
import xarray as xr

from disc_model.data.dataset import CONVENTIONS, common_provenance, json_attribute
from disc_model.data.variables import EXCLUDED, WITHOUT_CYCLE, flag_names, stated_in
from disc_model.errors import DiscModelError, as_text
from disc_model.parameters import in_words
from disc_model.studies.quantity import STATUSES, Quantity, holds, quantity_of
from disc_model.studies.run import POINT, coordinates_of, describe, variables_of

JOINED: Any = {"join": "exact", "combine_attrs": "override", "data_vars": "all", "coords": "minimal"}


class MergeError(DiscModelError):
    """The batches are not those of the grid."""


def merge_batches(
    batches: Sequence[xr.Dataset], grid: Sequence[Mapping[str, Any]], attrs: Mapping[str, str]
) -> xr.Dataset:
    """Merge batches; raises `MergeError` if they disagree, or if they do not match `grid`, as of `GridStudy.grid`."""
    try:
        flat = xr.concat(batches, POINT, compat="equals", **JOINED)
    except ValueError as error:
        raise MergeError(f"the batches do not fit together: {error}") from None
    base = _common(batches)
    points = _indices(flat, grid)
    expected = whole = pd.MultiIndex.from_product([range(len(dim["values"])) for dim in grid], names=points.names)
    names = [name for dim in grid for name in dim["names"]]
    if where := attrs.get("where"):
        fixed, every = json.loads(base["base"]), product(*(dim["values"] for dim in grid))
        expected = whole[[holds([where], fixed | dict(zip(names, chain(*point), strict=True))) for point in every]]
    if not points.sort_values().equals(expected):
        different = f"{len(points)} points, {points.nunique()} of them different"
        raise MergeError(f"the batches have {different}, which are not the {len(expected)} points of the grid")
    if len(expected) < len(whole):
        flat = flat.assign({name: _with_excluded(variable) for name, variable in flat.data_vars.items()})
    fill = {name: _nothing(variable) for name, variable in flat.data_vars.items()}
    indexed = flat.drop_vars(names).assign_coords(xr.Coordinates.from_pandas_multiindex(points, POINT))
    sizes = {name: range(size) for name, size in zip(whole.names, whole.levshape, strict=True)}
    merged = indexed.unstack(POINT, fill_value=fill).reindex(sizes, fill_value=fill).drop_vars(whole.names)
    coords = {
        name: ("_".join(dim["names"]), np.array([value[i] for value in dim["values"]]), describe(name))
        for dim in grid
        for i, name in enumerate(dim["names"])
    }
    merged = merged.transpose(*whole.names, ...).assign_coords(coords)
    merged.attrs = {"Conventions": CONVENTIONS, **attrs, **base}
    return summarised(merged, quantity_of(merged.attrs["quantity"]).model_validate(stated_in(merged, "options")))


def _indices(flat: xr.Dataset, grid: Sequence[Mapping[str, Any]]) -> pd.MultiIndex:
    """Index of each point along each dimension; -1 for a value that the grid does not have."""
    columns = {}
    for dim in grid:
        known = {tuple(value): i for i, value in enumerate(dim["values"])}
        values = zip(*(flat[name].values.tolist() for name in dim["names"]), strict=True)
        columns["_".join(dim["names"])] = [known.get(value, -1) for value in values]
    return pd.MultiIndex.from_arrays([*columns.values()], names=[*columns])


def failures(study: xr.Dataset) -> Iterator[str]:
    """One line for each point without a result: its parameters, status and message; errors come first."""
    status = flag_names(study["status"])
    varied = [name for name in study.coords if set(study[name].dims) <= set(study["status"].dims)]
    failed = np.isin(status, STATUSES[1:])
    others = ~failed & (status != EXCLUDED) & ((status != "ok") | (study["message"].values != ""))
    for index in (*np.argwhere(failed), *np.argwhere(others)):
        index_of = dict(zip(map(str, study["status"].dims), map(int, index), strict=True))
        point = study.isel(index_of)
        values = {name: point[name].item() for name in varied}
        where = ", ".join(f"{name} = {x if isinstance(x, str) else as_text(x)}" for name, x in values.items())
        word, message = str(status[tuple(index)]), str(point["message"].item())
        what = WITHOUT_CYCLE.get(word, word)
        yield f"{where}: {message if message.startswith(what) else f'{what}: {message}'}"


def _with_excluded(variable: xr.DataArray) -> xr.DataArray:
    """A variable that has a word for excluded points besides, if it is a flag."""
    if "flag_meanings" not in variable.attrs:
        return variable
    words = [*variable.attrs["flag_meanings"].split(), EXCLUDED]
    return variable.assign_attrs(flag_meanings=" ".join(words), flag_values=np.arange(len(words), dtype=np.int8))


def _nothing(variable: xr.DataArray) -> Any:
    """The value of an excluded point: its word, the last one, or none."""
    if "flag_values" in variable.attrs:
        return variable.dtype.type(variable.attrs["flag_values"][-1])
    return math.nan if variable.dtype.kind == "f" else "" if variable.dtype.kind in "OUT" else 0


def _common(batches: Sequence[xr.Dataset]) -> dict[str, str]:
    """Attributes common to all batches (quantity, options, base values, sources), and the commits that made them."""
    specification = json.loads(batches[0].attrs["specification"])
    for name in ("points", "names", "tile"):
        specification.pop(name, None)
    specification["base"] = in_words(specification.get("base", {}))
    for key in specification.keys() & {"starts", "discs"}:
        every = [json.loads(batch.attrs["specification"])[key] for batch in batches]
        specification[key] = {name: definition for named in every for name, definition in sorted(named.items())}
    common = {name: value if isinstance(value, str) else json_attribute(value) for name, value in specification.items()}
    return common | common_provenance(batches)


# ---- Summaries: they are made again at each merge, so that changing them recomputes no batch


def summarised(study: xr.Dataset, quantity: Quantity) -> xr.Dataset:
    """A merged study with the summary of its quantity, if there is one."""
    if not quantity.SUMMARY_COLUMNS:
        return study
    others = {str(dim): size for dim, size in study["status"].sizes.items() if dim != quantity.over}
    cells = (dict(zip(others, index, strict=True)) for index in np.ndindex(*others.values()))
    rows = [quantity.summarise(study.isel(cell)) for cell in cells]
    coords = coordinates_of(quantity.SUMMARY_COORDINATES, quantity)
    return study.assign_coords(coords).assign(variables_of(quantity.SUMMARY_COLUMNS, coords, rows, others))


# ---- Named cases


def merge_cases(cases: Mapping[str, xr.DataTree], labels: Mapping[str, Mapping[str, str]]) -> xr.DataTree:
    """Put cases into one tree: a table of scalars along `case`, and below it a group for each, laid out as in its file.

        table = xarray.open_dataset("cases.nc")                                  # first_separation by case
        history = xarray.open_dataset("cases.nc", group="F13/history")           # one window of one case

    labels : by case, texts that become variables of the table, such as title and reference
    """
    rows = [tree.to_dataset() for tree in cases.values()]
    table = xr.concat(rows, dim="case", **JOINED)
    table = table.assign_coords(case=("case", list(cases), {"long_name": "name of the case"}))
    texts = [{"message": row.attrs["message"], **labels.get(case, {})} for case, row in zip(cases, rows, strict=True)]
    for name, meaning in _TEXTS.items():
        table[name] = ("case", np.array([text.get(name, "") for text in texts], dtype=str), {"long_name": meaning})
    table.attrs = {"Conventions": CONVENTIONS, **common_provenance(rows)}
    tree = xr.DataTree(table)
    for name, case in cases.items():
        tree[name] = case
    return tree


_TEXTS = {"message": "what ended the simulation early", "reference": "place in the paper", "title": "what the case is"}
