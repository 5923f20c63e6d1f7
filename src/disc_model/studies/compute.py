"""Points of a study or of a sweep: computed one by one, and stacked along the dimensions of their grid."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import EXCLUDED, PERTURBATIONS, TRUTH, Variable
from disc_model.display import progress_bar
from disc_model.mode_units import column_of
from disc_model.parameters import Parameters
from disc_model.studies.quantity import NUMERICAL

Point = Mapping[str, Any]
"""What varies, by name: numbers and words of the case, perturbations, and arguments of the function."""


def failure(error: Exception) -> xr.Dataset:
    """A point that an error has ended."""
    return xr.Dataset({"status": "failed", "message": f"{type(error).__name__}: {error}"})


@dataclass(frozen=True)
class Call:
    """A function of a case with what does not vary; a point of what does makes a dataset of it.

    Attributes
    ----------
    function : of a case, which returns a dataset
    make : the case, from the values of a point that are its own; raises `ParameterError`
    options : keywords of the function
    failed : what stands for the result that an error has ended
    """

    function: Callable[..., xr.Dataset]
    make: Callable[..., Parameters]
    options: Mapping[str, Any]
    failed: Callable[[Exception], xr.Dataset] = failure

    def __call__(self, point: Point) -> xr.Dataset:
        """What the function returns at a point; status and message alone where it fails."""
        try:
            return self.function(self.case_at(point), **self.options_at(point))
        except NUMERICAL as error:
            return self.failed(error)

    def case_at(self, point: Point) -> Parameters:
        """The case of a point; raises `ParameterError`."""
        return self.make(**{name: value for name, value in point.items() if is_of_case(name)})

    def options_at(self, point: Point) -> dict[str, Any]:
        """The keywords of the function at a point, at which the start and arguments may vary."""
        options = dict(self.options)
        for name, value in point.items():
            if name in PERTURBATIONS:
                kicked = name.removeprefix("perturbation_")
                kicks = {**options["start"].perturbation, kicked: value}
                options["start"] = options["start"].replace(perturbation=kicks)
            elif not is_of_case(name):
                options[name] = value
        return options


def is_of_case(name: str) -> bool:
    """Whether a name is one of a case: a parameter, or a number of one of a disc's modes."""
    return name in Parameters.model_fields or bool(column_of(name))


def compute(
    call: Callable[[Point], xr.Dataset],
    points: Sequence[Point],
    *,
    map: Callable[..., Iterable[xr.Dataset]] = map,
    title: str = "",
    progress: bool = False,
) -> list[xr.Dataset]:
    """The results at points; `map` may be that of an executor."""
    results = []
    with progress_bar(title, len(points), progress) as bar:
        for result in map(call, points):
            results.append(result)
            bar.advance()
    return results


# ---- Stacking


def stack(
    results: Sequence[xr.Dataset],
    places: np.ndarray,
    sizes: Mapping[str, int],
    columns: Mapping[str, Variable] | None = None,
) -> xr.Dataset:
    """Results along the dimensions of a grid.

    Parameters
    ----------
    results : of points
    places : of each point along the dimensions, shape (points, dimensions)
    sizes : of the dimensions, by name
    columns : what the table knows of variables, such as what stands for a missing value; elsewhere that is nan, or
        "" among words
    """
    known = columns or {}
    coords, rows = _common_coordinates(results)
    variables: dict[str, xr.Variable] = {}
    for name in dict.fromkeys(name for row in rows for name in row):
        at = [i for i, row in enumerate(rows) if name in row]
        present = [rows[i][name] for i in at]
        shapes = {each.shape for each in present}
        shape = tuple(map(max, zip(*shapes, strict=True)))
        whole = len(at) == len(rows) and len(shapes) == 1
        nothing, dtype = _missing(present, whole, known.get(name))
        array = np.full((*sizes.values(), *shape), nothing, dtype)
        for i, each in zip(at, present, strict=True):
            array[(*places[i], *map(slice, each.shape))] = each.values
        attrs = _common_attributes(present)
        if present[0].dtype.kind == "b" and dtype is float:
            attrs |= TRUTH
        variables[name] = xr.Variable((*sizes, *present[0].dims), array, attrs)
    stacked = xr.Dataset(variables, coords)
    return stacked if len(rows) == math.prod(sizes.values()) else _excluded(stacked, places)


def _common_coordinates(
    results: Sequence[xr.Dataset],
) -> tuple[dict[str, xr.Variable], list[dict[str, xr.Variable]]]:
    """Coordinates along dimensions of the results' own, and the variables of each. A coordinate that
    differs between points is a variable along a dimension without one."""
    coords: dict[str, xr.Variable] = {}
    differing: dict[str, str] = {}
    for result in results:
        for name in result.dims & result.coords.keys():
            own = result.variables[name]
            if not own.equals(coords.setdefault(str(name), own)):
                differing[str(name)] = f"{name}_index"
    for name in differing:
        del coords[name]
    rows = []
    for result in results:
        renamed = {dim: to for dim, to in differing.items() if dim in result.dims}
        own_variables = result.drop_vars(coords, errors="ignore").variables
        row = {}
        for key, x in own_variables.items():
            dims = [renamed.get(str(dim), dim) for dim in x.dims]
            row[str(key)] = xr.Variable(dims, x.values, x.attrs)
        rows.append(row)
    return coords, rows


def _missing(
    present: Sequence[xr.Variable], whole: bool, column: Variable | None
) -> tuple[Any, Any]:
    """What stands for a missing value of a variable, and the type that holds it: whole numbers and truth
    have none unless all values are there."""
    if column is not None:
        return column.unknown, column.dtype
    dtype = np.result_type(*(each.dtype for each in present))
    if dtype.kind in "UO":
        return "", dtype
    return (0, dtype) if whole and dtype.kind in "biu" else (math.nan, float)


def _common_attributes(several: Sequence[xr.Variable]) -> dict[str, Any]:
    """The attributes on which variables of one name agree."""
    common = dict(several[0].attrs)
    for each in several:
        for name in [*common]:
            if name not in each.attrs or not np.array_equal(each.attrs[name], common[name]):
                del common[name]
    return common


def _excluded(stacked: xr.Dataset, places: np.ndarray) -> xr.Dataset:
    """A study in which variables that have codes have the word `EXCLUDED` for points that a rule of the
    grid leaves out."""
    for x in stacked.data_vars.values():
        if "flag_meanings" in x.attrs:
            words = [*x.attrs["flag_meanings"].split(), EXCLUDED]
            left_out = np.ones(x.shape[: places.shape[1]], bool)
            left_out[tuple(places.T)] = False
            x.values[left_out] = len(words) - 1
            numbers = np.arange(len(words), dtype=np.int8)
            x.attrs |= {"flag_meanings": " ".join(words), "flag_values": numbers}
    return stacked
