"""Computation of one batch of a grid study: a quantity at each point, as variables with units."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.data.dataset import CONVENTIONS
from disc_model.data.variables import CHOICES, PERTURBATIONS, SAMPLE, Variable, attributes
from disc_model.errors import DiscModelError
from disc_model.parameters import Parameters, case_of
from disc_model.simulation.case import Start
from disc_model.sources import BATCHES, git_commit, quantity_file, source_hash, versions_text
from disc_model.studies.batch import Batch, TileSides
from disc_model.studies.quantity import Coordinate, Made, Point, Quantity, Row, tried
from disc_model.studies.registry import quantity_of

POINT = "point"
Computed = tuple[Row, str]  # values of a point by column, and a message


def run_batch(text: str, of: Callable[[Quantity], Any] | None = None) -> xr.Dataset:
    """Compute a batch.

    Parameters
    ----------
    text : of the batch, as `disc_model.studies.grid.GridStudy.batches` has it
    of : makes what is computed from the study's quantity; by default the quantity itself is

    Returns
    -------
    xarray.Dataset
        Variables along `point`
    """
    batch = Batch.model_validate_json(text)
    quantity = quantity_of(batch.quantity).model_validate(batch.options)
    computed = quantity if of is None else of(quantity)
    if batch.tile is not None and of is None:
        results = _results_over_tiles(quantity, batch, batch.tile)
    else:
        results = _results_at_points(computed, batch)
    rows = [row for row, _ in results]
    own_coords = coordinates_of(computed.COORDINATES, quantity)
    messages = [with_cuts(message, row, computed, own_coords) for row, message in results]

    variables = variables_of(computed.COLUMNS, own_coords, rows, {POINT: len(rows)})
    variables["message"] = xr.Variable(POINT, np.array(messages, dtype=str))
    coords = {}
    for name in batch.names:
        coords[name] = xr.Variable(POINT, [varied[name] for varied in batch.varied])
    coords.update(own_coords)
    attrs = {
        "Conventions": CONVENTIONS,
        "specification": text,
        "source_hash": source_hash(*BATCHES, quantity_file(batch.quantity)),
        "git_commit": git_commit(),
        "versions": versions_text(),
    }
    return xr.Dataset(variables, coords, attrs)


def _results_at_points(computed: Any, batch: Batch) -> list[Computed]:
    """Return the results at the points of a batch, each computed by itself."""
    own = {name: value for name, value in batch.options.items() if name in Start.model_fields}
    start = Start(**own)
    results = []
    for varied in batch.varied:
        point = _point(_parameters_or_error(batch, varied), varied, start)
        results.append(tried("status", computed.compute_point, point))
    return results


def _results_over_tiles(quantity: Any, batch: Batch, sides: TileSides) -> list[Computed]:
    """Return the results at the points of a batch, without the tile's margin.

    There is one tile for each combination of the other parameters.
    """
    first, second = sides.names
    rows, columns = sides.along
    tiles: dict[tuple[Any, ...], Sequence[Sequence[Computed]]] = {}
    results = []
    for varied in batch.varied:
        others = dict(varied)
        i = rows.index(others.pop(first))
        j = columns.index(others.pop(second))
        key = tuple(others.values())
        if key not in tiles:
            plane = [_row_of_tile(batch, sides, {**others, first: y}) for y in rows]
            tiles[key] = quantity.compute_tile(plane, sides.sampled)
        results.append(tiles[key][i][j])
    return results


def _row_of_tile(batch: Batch, sides: TileSides, values: Mapping[str, Any]) -> list[Made]:
    """Return the parameters along the second side of a tile, other values given."""
    second = sides.names[1]
    return [_parameters_or_error(batch, {**values, second: x}) for x in sides.along[1]]


def _point(p: Made, varied: Mapping[str, Any], start: Start) -> Point | DiscModelError:
    """Return a point with its parameters and everything else that varies; an error in place of the
    parameters stays one."""
    if isinstance(p, DiscModelError):
        return p
    perturbation = defaultdict[Any, float](float, start.perturbation)
    for name in varied.keys() & PERTURBATIONS.keys():
        perturbation[name.removeprefix("perturbation_")] += varied[name]
    perturbed = start.model_copy(update={"perturbation": dict(perturbation)})
    return Point(p, perturbed, varied.get(SAMPLE, 0))


def _parameters_or_error(batch: Batch, varied: Mapping[str, Any]) -> Made:
    """Return the parameters of a point, or the error if they break a rule."""
    try:
        return Parameters(**case_of({**batch.base, **varied}, batch.discs))
    except DiscModelError as error:
        return error


def describe(name: str) -> dict[str, Any]:
    """Return attributes of a varying parameter as a coordinate; choices, which are words, have no
    unit."""
    described = attributes(name)
    if name in (*CHOICES, "disc"):
        return {"long_name": described["long_name"]}
    return described


# ---- Quantities: rows of results, one for each point, as arrays


def coordinates_of(
    coordinates: Mapping[str, Coordinate], quantity: Quantity
) -> dict[str, xr.Variable]:
    """Return the dimensions of a quantity's own, with values for its options."""
    return {
        name: xr.Variable(name, np.array(coordinate.values(quantity)))
        for name, coordinate in coordinates.items()
    }


def with_cuts(message: str, row: Row, computed: Any, coords: Mapping[str, xr.Variable]) -> str:
    """A message that also says of which values a row has more than its dimensions have room for."""
    cuts = []
    for dim, coordinate in computed.COORDINATES.items():
        room = coords[dim].size
        found = _number_found(row, computed.COLUMNS, dim)
        if found <= room:
            continue
        advice = f": raise {coordinate.room}" if coordinate.room else ""
        cuts.append(f"{found} were found along {dim}, which has room for {room}{advice}")
    if not cuts:
        return message
    return "; ".join(filter(None, [message.removesuffix("."), *cuts]))


def _number_found(row: Row, columns: Mapping[str, Variable], dim: str) -> int:
    """The largest number of values that a row has along a dimension, in lists and arrays."""
    found = 0
    for name, column in columns.items():
        value = row.get(name)
        if dim not in column.dims:
            continue
        before = column.dims.index(dim)
        if isinstance(value, np.ndarray) and value.ndim > before:
            found = max(found, value.shape[before])
        elif isinstance(value, list):
            found = max(found, _longest(value, before))
    return found


def _longest(value: list[Any], depth: int) -> int:
    """The length of the longest list at a depth of lists within lists, 0 without one."""
    lists = [value]
    for _ in range(depth):
        lists = [inner for outer in lists for inner in outer if isinstance(inner, list)]
    return max(map(len, lists), default=0)


def variables_of(
    columns: Mapping[str, Variable],
    coords: Mapping[str, xr.Variable],
    rows: Iterable[Row],
    sizes: Mapping[str, int],
) -> dict[str, xr.Variable]:
    """Return rows as variables along dimensions of these sizes, the last one fastest, and along
    the quantity's own; what they are is said where they are merged."""
    rows = list(rows)
    variables = {}
    for name, column in columns.items():
        array = column.empty((len(rows), *(coords[dim].size for dim in column.dims)))
        for i, row in enumerate(rows):
            _store(row.get(name), array[i, ...], column)
        array = array.reshape((*sizes.values(), *array.shape[1:]))
        variables[name] = xr.Variable((*sizes, *column.dims), array, column.codes)
    return variables


def _store(value: Any, cell: NDArray[Any], column: Variable) -> None:
    """Store a value in a view of an array: flags as numbers; lists and arrays are cut to fit."""
    if isinstance(value, list):
        for i, item in enumerate(value[: len(cell)]):
            _store(item, cell[i, ...], column)
    elif isinstance(value, np.ndarray) and value.ndim:
        part = value[tuple(map(slice, cell.shape))]
        cell[tuple(map(slice, part.shape))] = part
    elif isinstance(value, str):
        cell[...] = column.flags.index(value)
    elif value is not None:
        cell[...] = value
