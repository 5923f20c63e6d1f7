"""Points of a study or of a sweep: computed one by one, and stacked along the dimensions of their grid."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import EXCLUDED, PERTURBATIONS, TRUTH, Variable
from disc_model.display import progress_bar
from disc_model.parameters import Disc, Parameters
from disc_model.simulation.case import Start
from disc_model.studies.quantity import FREE_NUMBERS, NUMERICAL

Point = Mapping[str, Any]
"""What varies, by name: numbers and words of the case, perturbations, and arguments of the function."""


@dataclass(frozen=True)
class Call:
    """A function of a case with what does not vary; a point of what does makes a dataset of it.

    Attributes
    ----------
    function : of a case, which returns a dataset
    make : the case, from the values of a point that are its own; raises `ParameterError`
    options : keywords of the function
    discs : tables of discs by the words that stand for them in points
    """

    function: Callable[..., xr.Dataset]
    make: Callable[..., Parameters]
    options: Mapping[str, Any] = field(default_factory=dict)
    discs: Mapping[str, Disc] = field(default_factory=dict)

    def case_at(self, point: Point) -> Parameters:
        """The case of a point; raises `ParameterError`."""
        changes = {name: value for name, value in point.items() if is_of_case(name)}
        if "disc" in changes and self.discs:
            changes["disc"] = self.discs[changes["disc"]]
        return self.make(**changes)

    def __call__(self, point: Point) -> xr.Dataset:
        """What the function returns at a point; status and message alone where it fails."""
        try:
            case = self.case_at(point)
            return self.function(case, **self.options_at(point))
        except NUMERICAL as error:
            return failure(error)

    def options_at(self, point: Point) -> dict[str, Any]:
        """The keywords of the function at a point, at which the start and arguments may vary."""
        options = dict(self.options)
        for name, value in point.items():
            if name in PERTURBATIONS:
                kicked = name.removeprefix("perturbation_")
                start: Start = options["start"]
                kicks: dict[Any, float] = dict(start.perturbation)
                kicks[kicked] = kicks.get(kicked, 0.0) + value
                options["start"] = start.replace(perturbation=kicks)
            elif not is_of_case(name):
                options[name] = value
        return options


def is_of_case(name: str) -> bool:
    """Whether a name is one of a case: a parameter, or a number of one of a disc's modes."""
    return name in Parameters.model_fields or FREE_NUMBERS.fullmatch(name) is not None


def failure(error: Exception) -> xr.Dataset:
    """A point that an error has ended."""
    return xr.Dataset({"status": "failed", "message": f"{type(error).__name__}: {error}"})


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
    columns : what the table knows of the variables: codes of words, and what stands for a missing value;
        elsewhere that is nan, or "" among words
    """
    known = columns or {}
    coords, rows = _common_coordinates(results)
    names = dict.fromkeys(name for row in rows for name in row)
    complete = len(results) == math.prod(sizes.values())
    variables: dict[str, xr.Variable] = {}
    for name in names:
        several = [_coded(row[name], known.get(name)) if name in row else None for row in rows]
        present = [each for each in several if each is not None]
        nothing, dtype = _missing(present, len(rows), known.get(name))
        shape = [max(each.shape[i] for each in present) for i in range(present[0].ndim)]
        array = np.full((*sizes.values(), *shape), nothing, dtype)
        for place, each in zip(places.tolist(), several, strict=True):
            if each is not None:
                array[(*place, *map(slice, each.shape))] = each.values
        attrs = _common_attributes(present)
        if not complete:
            array, attrs = _excluded(array, attrs, places)
        if dtype is object:
            array = array.astype(str)
        truth = present[0].dtype.kind == "b" and array.dtype.kind == "f"
        variables[name] = xr.Variable(
            (*sizes, *present[0].dims), array, attrs | (TRUTH if truth else {})
        )
    return xr.Dataset(variables, coords)


def _coded(variable: xr.Variable, column: Variable | None) -> xr.Variable:
    """A variable with codes in place of words where the table has them, as of a failed point."""
    if column is None or not column.flags or variable.dtype.kind != "U":
        return variable
    codes = np.vectorize(column.flags.index, otypes=[np.int8])(variable.values)
    return xr.Variable(variable.dims, codes, column.codes)


def _common_coordinates(
    results: Sequence[xr.Dataset],
) -> tuple[dict[str, xr.Variable], list[dict[str, xr.Variable]]]:
    """Coordinates along dimensions of the results' own, and the variables of each. A coordinate that
    differs between points is a variable along a dimension without one."""
    coords: dict[str, xr.Variable] = {}
    differing: dict[str, str] = {}
    for result in results:
        for name in map(str, result.dims):
            if name in result.coords:
                own = result.variables[name]
                if not own.equals(coords.setdefault(name, own)):
                    differing[name] = f"{name}_index"
    rows = []
    for result in results:
        row = {}
        for key, variable in result.variables.items():
            name = str(key)
            if name not in coords or name in differing:
                dims = [differing.get(str(dim), str(dim)) for dim in variable.dims]
                row[name] = xr.Variable(dims, variable.values, variable.attrs)
        rows.append(row)
    return {name: own for name, own in coords.items() if name not in differing}, rows


def _missing(
    present: Sequence[xr.Variable], number: int, column: Variable | None
) -> tuple[Any, Any]:
    """What stands for a missing value of a variable, and the type that holds it: whole numbers and truth
    have none unless all values are there."""
    if column is not None:
        return column.unknown, column.dtype
    kinds = {each.dtype.kind for each in present}
    complete = len(present) == number and len({each.shape for each in present}) == 1
    if kinds & set("UO"):
        return "", object
    if "c" in kinds:
        return complex(math.nan, math.nan), complex
    if kinds <= {"b"} and complete:
        return False, bool
    if kinds <= {"i", "u"} and complete:
        return 0, int
    return math.nan, float


def _common_attributes(several: Sequence[xr.Variable]) -> dict[str, Any]:
    """The attributes on which variables of one name agree."""
    common = dict(several[0].attrs)
    for each in several[1:]:
        for name in [*common]:
            if name not in each.attrs or not np.array_equal(each.attrs[name], common[name]):
                del common[name]
    return common


def _excluded(
    array: np.ndarray, attrs: dict[str, Any], places: np.ndarray
) -> tuple[np.ndarray, dict[str, Any]]:
    """An array with the word `EXCLUDED` for points that a rule of the grid leaves out, if it has codes."""
    if "flag_meanings" not in attrs:
        return array, attrs
    words = [*attrs["flag_meanings"].split(), EXCLUDED]
    numbers = np.arange(len(words), dtype=np.int8)
    left_out = np.ones(array.shape[: places.shape[1]], bool)
    left_out[tuple(places.T)] = False
    array[left_out] = numbers[-1]
    return array, {**attrs, "flag_meanings": " ".join(words), "flag_values": numbers}
