"""Points of a study or of a sweep: computed one by one, and stacked along the dimensions of their grid."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr
from xarray import Dataset

from disc_model.data.variables import PERTURBATIONS, TRUTH, Variable, attributes
from disc_model.display import progress_bar
from disc_model.parameters import Parameters
from disc_model.studies.grid import VARIED, WORDS, Dims
from disc_model.studies.quantity import NUMERICAL, Row, failed

Map = Callable[..., Iterable[Any]]
"""A function such as Python's own `map`."""
Point = Row
"""What varies, by name: numbers and words of the case, perturbations, and arguments of the function."""


@dataclass(frozen=True)
class Call:
    """A function of a case with what does not vary; a point of what does makes a dataset of it.

    Attributes
    ----------
    function : of a case, which returns a dataset
    make : the case, from the values of a point that are its own; raises `ParameterError`
    options : keywords of the function
    quantity : its name, if it is one and gives codes for words
    """

    function: Callable[..., Dataset]
    make: Callable[..., Parameters]
    options: Row
    quantity: str = ""

    def __call__(self, point: Point) -> Dataset:
        """What the function returns at a point; status and message alone where it fails."""
        own = {}
        kicks = {}
        options = dict(self.options)
        for name, value in point.items():
            if name in Parameters.model_fields:
                own[name] = value
            elif name in PERTURBATIONS:
                kicks[name.removeprefix("perturbation_")] = value
            else:
                options[name] = value
        if kicks:
            options["start"] = options["start"].replace(**kicks)
        try:
            return self.function(self.make(**own), **options)
        except NUMERICAL as error:
            return failed(self.quantity, error)


def compute(
    call: Callable[[Point], Dataset],
    points: Sequence[Point],
    *,
    map: Map = map,
    title: str = "",
    progress: bool = False,
) -> list[Dataset]:
    """The results at points; `map` may be that of an executor."""
    results = []
    with progress_bar(title, len(points), progress) as bar:
        for result in map(call, points):
            results.append(result)
            bar.advance()
    return results


# ---- Stacking


def stack(
    results: Sequence[Dataset], dims: Dims, columns: Mapping[str, Variable] = MappingProxyType({})
) -> Dataset:
    """Results along the dimensions of a grid.

    Parameters
    ----------
    results : at all points, in the order of the dimensions, of which the last one varies first
    dims : what varies along each dimension, by its name
    columns : what the table knows of variables, such as what stands for a missing value; elsewhere that is nan, or
        "" among words
    """
    coords, rows = _common_coordinates(results)
    variables: dict[str, xr.Variable] = {}
    for name in dict.fromkeys(chain.from_iterable(rows)):
        present = {i: row[name] for i, row in enumerate(rows) if name in row}
        first, *_ = present.values()
        shapes = {each.shape for each in present.values()}
        shape = tuple(map(max, zip(*shapes, strict=True)))
        if name in columns:
            array = columns[name].empty((len(rows), *shape))
        else:
            whole = len(present) == len(rows) and len(shapes) == 1
            array = _empty([each.dtype for each in present.values()], (len(rows), *shape), whole)
        for i, each in present.items():
            cells: Any = (i, *map(slice, each.shape))
            array[cells] = each.values
        attrs = dict(first.attrs)
        if first.dtype.kind == "b" and array.dtype.kind == "f":
            attrs |= TRUTH
        stacked = array.reshape((*map(len, dims.values()), *shape))
        variables[name] = xr.Variable((*dims, *first.dims), stacked, attrs)
    return Dataset(variables, coords).assign_coords(_varied(dims))


def _varied(dims: Dims) -> dict[str, Any]:
    """What varies as coordinates, whose words have no unit; discs and other objects are words too."""
    coordinates = {}
    for dim, frame in dims.items():
        for name in map(str, frame):
            values = ["plate" if value is None else value for value in frame[name]]
            if not all(isinstance(value, int | float | str) for value in values):
                values = [*map(str, values)]
            attrs = {}
            if name in VARIED:
                attrs = attributes(name)
            if name in WORDS:
                attrs = {"long_name": attrs["long_name"]}
            coordinates[name] = (dim, values, attrs)
    return coordinates


def _common_coordinates(
    results: Sequence[Dataset],
) -> tuple[dict[Any, xr.Variable], list[dict[Any, xr.Variable]]]:
    """Coordinates along dimensions of the results' own, and the variables of each. A coordinate that
    differs between points is a variable along a dimension without one."""
    coords: dict[Any, xr.Variable] = {}
    differing = {}
    for result in results:
        for name in result.indexes:  # in a fixed order: files are equal to the byte
            own = result.variables[name]
            if not own.equals(coords.setdefault(name, own)):
                differing[name] = f"{name}_index"
    for name in differing:
        del coords[name]
    rows = []
    for result in results:
        dims = {name: dim for name, dim in differing.items() if name in result.dims}
        if dims:
            result = result.rename_dims(dims)
        rows.append({name: x for name, x in result.variables.items() if name not in coords})
    return coords, rows


def _empty(dtypes: Sequence[Any], shape: Sequence[int], whole: bool) -> np.ndarray:
    """An array that holds values of these types; whole numbers and truth only if all values are there."""
    dtype = np.result_type(*dtypes)
    if dtype.kind in "UO":
        return np.full(shape, "", dtype)
    if whole:
        return np.empty(shape, dtype)
    return np.full(shape, np.nan)
