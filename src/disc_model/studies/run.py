"""Computation of one batch of a grid study: a quantity at each point, as variables with units."""

import json
import math
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.data.dataset import CONVENTIONS, json_attribute
from disc_model.data.variables import CHOICES, PERTURBATIONS, SAMPLE, START, Variable, attributes
from disc_model.disc.plate import mode_arrays
from disc_model.errors import DiscModelError
from disc_model.mode_choice import chosen_modes, read_asked
from disc_model.parameters import AUTO, case_of, in_words
from disc_model.simulation.case import Start
from disc_model.sources import git_commit, source_hash, versions
from disc_model.studies.quantity import Coordinate, Made, Point, Quantity, Row, quantity_of, tried

POINT = "point"
WORDS = (*CHOICES, "disc", START)  # what varies by words


def run_batch(text: str, of: Callable[[Quantity], Any] | None = None) -> xr.Dataset:
    """Variables along `point` of the batch in a text of
    `disc_model.studies.grid.GridStudy.batches`: those of the quantity, or of what a function `of`
    it makes."""
    data = json.loads(text)
    quantity = quantity_of(data["quantity"]).model_validate(data["options"])
    computed = quantity if of is None else of(quantity)
    names = data["names"]
    varied = [_varied(names, point) for point in data["points"]]
    chosen, tiled = data["base"].get("n_diameters") == AUTO, "tile" in data
    parameters = (
        [_made(data, values) for values in varied] if chosen or not tiled else []
    )  # a tile makes its own
    if tiled and of is None:
        results = list(_over_tile(quantity, data))
    else:
        stated = {
            None: {
                name: value for name, value in data["options"].items() if name in Start.model_fields
            }
        }
        starts = {name: Start(**start) for name, start in (stated | data.get("starts", {})).items()}
        points = (_point(*point, starts) for point in zip(parameters, varied, strict=True))
        results = [tried("status", computed.compute_point, point) for point in points]
    rows, messages = zip(*results, strict=True)
    coords_of_quantity = coordinates_of(computed.COORDINATES, quantity)
    variables = variables_of(computed.COLUMNS, coords_of_quantity, rows, {POINT: len(rows)})
    if chosen:
        for name in ("diameters", "circles"):  # -1 without a choice
            highest = [
                -1 if isinstance(p, DiscModelError) else getattr(mode_arrays(p), name).max()
                for p in parameters
            ]
            variables[f"n_{name}"] = xr.Variable(POINT, highest, attributes(f"n_{name}"))
    variables["message"] = xr.Variable(
        POINT, np.array(messages, dtype=str), {"long_name": "what went wrong"}
    )
    coords = {
        name: xr.Variable(POINT, [values[name] for values in varied], describe(name))
        for name in names
    }
    attrs = {
        "Conventions": CONVENTIONS, "specification": text,
        "source_hash": source_hash(__name__, type(quantity).__module__), "git_commit": git_commit(),
        "versions": json_attribute(versions()),
    }  # fmt: skip
    return xr.Dataset(variables, coords | coords_of_quantity, attrs)


def _varied(names: Sequence[str], point: Sequence[Any]) -> dict[str, Any]:
    """The varying values of a point by name, in the words of the field. JSON has no infinity, which
    is a word there."""
    values = in_words(dict(zip(names, point, strict=True)))
    for name, value in values.items():
        if value == "inf" and name not in WORDS:
            values[name] = math.inf
    return values


def _over_tile(quantity: Any, data: Mapping[str, Any]) -> Iterator[tuple[Row, str]]:
    """A tile's points in the text's order, without its margin; one tile for each combination of
    other parameters."""
    (first, second), (rows, columns) = data["tile"]["names"], data["tile"]["along"]
    tiles: dict[tuple[Any, ...], Sequence[Sequence[tuple[Row, str]]]] = {}
    for point in data["points"]:
        others = dict(zip(data["names"], point, strict=True))
        i, j = rows.index(others.pop(first)), columns.index(others.pop(second))
        key = tuple(others.values())
        if key not in tiles:
            made = [[_made(data, others | {first: y, second: x}) for x in columns] for y in rows]
            tiles[key] = quantity.compute_tile(made, [(a, b) for a, b in data["tile"]["sampled"]])
        yield tiles[key][i][j]


def _point(
    p: Made, varied: Mapping[str, Any], starts: Mapping[str | None, Start]
) -> Point | DiscModelError:
    """A point with its parameters and everything else that varies; the start of None is that of the
    options."""
    if isinstance(p, DiscModelError):
        return p
    start = starts[varied.get(START)]
    whole = defaultdict[Any, float](float, start.perturbation)
    for name in varied.keys() & PERTURBATIONS.keys():
        whole[name.removeprefix("perturbation_")] += varied[name]
    return Point(p, start.model_copy(update={"perturbation": dict(whole)}), varied.get(SAMPLE, 0))


def _made(data: Mapping[str, Any], varied: Mapping[str, Any]) -> Made:
    """The parameters of a point, or the error if no number of modes meets the tolerance."""
    try:
        p, request = read_asked(case_of({**data["base"], **varied}, data.get("discs", {})))
        return p if request is None else chosen_modes(p, request).parameters
    except DiscModelError as error:
        return error


def describe(name: str) -> dict[str, Any]:
    """Attributes of a varying parameter as a coordinate; choices are stored as words, without
    unit."""
    described = attributes(name)
    return {"long_name": described["long_name"]} if name in (*CHOICES, "disc") else described


# ---- Quantities: rows of results, one for each point, as arrays


def coordinates_of(
    coordinates: Mapping[str, Coordinate], quantity: Quantity
) -> dict[str, xr.Variable]:
    return {
        name: xr.Variable(
            name, np.array(values(quantity)), Variable(units, words.format(quantity)).attributes
        )
        for name, (units, words, values) in coordinates.items()
    }


def variables_of(
    columns: Mapping[str, Variable],
    coords: Mapping[str, xr.Variable],
    rows: Sequence[Row],
    sizes: Mapping[str, int],
) -> dict[str, xr.Variable]:
    """Rows as variables along dimensions of these sizes, the last one fastest, and along the
    quantity's own."""
    variables = {}
    for name, column in columns.items():
        array = column.empty((len(rows), *(coords[dim].size for dim in column.dims)))
        for i, row in enumerate(rows):
            _store(row.get(name), array[i, ...], column)
        array = array.reshape((*sizes.values(), *array.shape[1:]))
        variables[name] = xr.Variable((*sizes, *column.dims), array, column.attributes)
    return variables


def _store(value: Any, cell: NDArray[Any], column: Variable) -> None:
    """Store a value in a view of an array: flags as numbers; lists and arrays are cut to fit."""
    if isinstance(value, list):
        for i, item in enumerate(value[: len(cell)]):
            _store(item, cell[i, ...], column)
    elif isinstance(value, np.ndarray) and value.ndim:
        part = value[tuple(map(slice, cell.shape))]
        cell[tuple(map(slice, part.shape))] = part
    elif value is not None:
        cell[...] = column.flags.index(value) if isinstance(value, str) else value
