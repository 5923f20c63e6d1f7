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

from disc_model.data.variables import PERTURBATIONS, Variable, attributes
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
    """The results at points; `map` may be that of an executor, and `progress` shows a bar on standard error."""
    results = []
    with progress_bar(title, len(points), progress) as done:
        for result in map(call, points):
            results.append(result)
            done(title)
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
        first = next(iter(present.values()))
        array = _in_one(present, len(rows), columns.get(name))
        shape = (*map(len, dims.values()), *array.shape[1:])
        variables[name] = xr.Variable((*dims, *first.dims), array.reshape(shape), first.attrs)
    return Dataset(variables, coords).assign_coords(_varied(dims))


def _in_one(present: Mapping[int, xr.Variable], count: int, column: Variable | None) -> np.ndarray:
    """The values of a variable at all points in one array, by those at points that have any, of which shorter
    arrays are at the beginning."""
    values = [each.values for each in present.values()]
    shape = (count, *np.max([each.shape for each in values], axis=0))
    if column is not None:
        array: np.ndarray = column.empty(shape)
    elif values[0].dtype.kind in "UO":
        array = np.full(shape, "", np.result_type(*{each.dtype for each in values}))
    elif len(values) == count and {each.shape for each in values} == {shape[1:]}:
        return np.stack(values)  # whole numbers and truth stay what they are
    else:
        array = np.full(shape, np.nan)
    for i, each in zip(present, values, strict=True):
        cells: Any = (i, *map(slice, each.shape))
        array[cells] = each
    return array


def _varied(dims: Dims) -> dict[str, Any]:
    """What varies as coordinates, whose words have no unit; discs and other objects are words too."""
    coordinates = {}
    for dim, frame in dims.items():
        for name in map(str, frame):
            values = frame[name].tolist()
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
    differing = set()
    for result in results:
        for name in map(str, result.indexes):  # in a fixed order: files are equal to the byte
            own = result.variables[name]
            if not own.equals(coords.setdefault(name, own)):
                differing.add(name)
    rows = []
    for result in results:
        free = result.rename_dims({x: f"{x}_index" for x in differing & {*result.dims}})
        rows.append({x: y for x, y in free.variables.items() if x not in {*coords} - differing})
    return {name: x for name, x in coords.items() if name not in differing}, rows
