"""Jobs of studies and their merging, and whole studies without files."""

from __future__ import annotations

import json
import logging
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from disc_model.data.dataset import CONVENTIONS, common_provenance, json_attribute
from disc_model.data.described import described
from disc_model.data.variables import CHOICES, EXCLUDED, attributes, unit_of_parameter
from disc_model.errors import require
from disc_model.parameters import Disc, Parameters
from disc_model.provenance import canonical_json, git_commit, physics_hash, versions_text
from disc_model.simulation.named_case import run_case
from disc_model.studies.compute import Call, compute, stack
from disc_model.studies.grid import REQUIRED, VARIED, WORDS
from disc_model.studies.quantity import quantity_of

if TYPE_CHECKING:
    from disc_model.studies.study import Study

POINT = "point"
log = logging.getLogger(__name__)
Layout = Mapping[str, Any]


# ---- Jobs


def call_of(layout: Layout) -> Call:
    """The call of a quantity, from what all points of a grid have in common."""
    quantity = quantity_of(layout["quantity"])
    options = dict(quantity.options.model_validate(layout["options"]))
    if layout.get("axes"):
        options["axes"] = {name: [*map(_number, x)] for name, x in layout["axes"].items()}
    discs = {name: Disc.model_validate(disc) for name, disc in layout["discs"].items()}
    base = {name: x for name, x in layout["base"].items() if x is not None}
    return Call(quantity.function, partial(_case, base), options, discs)


def points_of(layout: Layout) -> list[dict[str, Any]]:
    """What varies at the points of a job."""
    points = []
    for point in layout["points"]:
        points.append({name: x if name in WORDS else _number(x) for name, x in point.items()})
    return points


def _known_or_made(
    case: Parameters, first: Mapping[str, Any], make: Callable[..., Parameters], **changes: Any
) -> Parameters:
    """The case of the first point, which is made already, or another one."""
    return case if changes == first else make(**changes)


def _case(base: Mapping[str, Any], **changes: Any) -> Parameters:
    """A case from the values that do not vary, and from those that do; what the quantity varies by
    itself is 0."""
    return Parameters(**{**dict.fromkeys(REQUIRED, 0.0), **base, **changes})


def _number(value: Any) -> Any:
    """A number of a JSON text, which has a word for an infinite one."""
    return math.inf if value == "inf" else value


def run_job(job: str, known: Iterable[xr.Dataset] = ()) -> xr.Dataset:
    """The results of a job along `point`.

    Parameters
    ----------
    job : a text of `Grid.jobs`
    known : results of other jobs on the same quantity, options and base, from which points are taken
    """
    layout = json.loads(job)
    points = points_of(layout)
    there = {canonical_json(point): row for part in known for point, row in _points_of(part)}
    missing = [point for point in points if canonical_json(point) not in there]
    for point, row in zip(missing, compute(call_of(layout), missing), strict=True):
        there[canonical_json(point)] = row
    log.info("%d of %d points computed", len(missing), len(points))
    rows = [there[canonical_json(point)] for point in points]
    return _along_points(layout, points, rows)


def _along_points(
    layout: Layout, points: Sequence[Mapping[str, Any]], rows: Sequence[xr.Dataset]
) -> xr.Dataset:
    """Results in one dataset, with what varies as coordinates along `point`."""
    places = np.arange(len(rows))[:, np.newaxis]
    results = stack(rows, places, {POINT: len(rows)}, quantity_of(layout["quantity"]).columns)
    varied = {name: (POINT, [point[name] for point in points]) for name in points[0]}
    said = {
        "source_hash": physics_hash(),
        "versions": versions_text(),
        "names": json_attribute([*points[0]]),
    }
    return results.assign_coords(varied).assign_attrs(said)


def _points_of(part: xr.Dataset) -> Iterable[tuple[dict[str, Any], xr.Dataset]]:
    """The points of a job's results, and the result at each."""
    names = json.loads(part.attrs["names"])
    columns = [part[name].values.tolist() for name in names]
    results = part.drop_vars(names)
    for i in range(part.sizes[POINT]):
        point = {name: column[i] for name, column in zip(names, columns, strict=True)}
        yield point, results.isel({POINT: i})


def merge(layout: Layout, parts: Sequence[xr.Dataset], attrs: Mapping[str, str]) -> xr.Dataset:
    """The results of all jobs of a grid over its dimensions, which a variable has in the order of the
    parameters, before its own.

    Parameters
    ----------
    layout : of `Grid.layout`
    parts : of `run_job`
    attrs : of the study
    """
    quantity = quantity_of(layout["quantity"])
    pairs = [pair for part in parts for pair in _points_of(part)]
    given = pairs[0][0].keys()
    dims = {}
    for dim, columns in layout["dims"].items():
        values = [
            [x if name in WORDS else _number(x) for x in column] for name, column in columns.items()
        ]
        dims[dim] = [*zip(*values, strict=True)]
    numbered = {dim: [*layout["dims"][dim]] for dim in dims if {*layout["dims"][dim]} <= given}
    places = []
    for point, _ in pairs:
        places.append(
            [dims[dim].index(tuple(point[x] for x in names)) for dim, names in numbered.items()]
        )
    sizes = {dim: len(dims[dim]) for dim in numbered}
    found = stack(
        [row for _, row in pairs], np.array(places).reshape(len(pairs), -1), sizes, quantity.columns
    )

    coords = {}
    for dim, columns in layout["dims"].items():
        for i, name in enumerate(columns):
            coords[name] = (
                dim,
                np.array([value[i] for value in dims[dim]]),
                coordinate_attributes(name),
            )
    study = found.assign_coords(coords)
    first = {dim: next(iter(columns)) for dim, columns in layout["dims"].items()}
    ranked = sorted(study.dims, key=lambda dim: _rank(first.get(str(dim), str(dim))))
    options = layout["options"]
    every = {
        "Conventions": CONVENTIONS,
        **attrs,
        "quantity": quantity.name,
        "options": json_attribute(options),
        "base": json_attribute(layout["base"]),
        **({"discs": json_attribute(layout["discs"])} if layout["discs"] else {}),
        "git_commit": git_commit(),
        **common_provenance(parts),
    }
    return described(study.transpose(*ranked).assign_attrs(every), quantity.name, options)


def _rank(name: str) -> int:
    """The place of a parameter among those that vary; the last one for anything else."""
    return VARIED.index(name) if name in VARIED else len(VARIED)


def coordinate_attributes(name: str) -> dict[str, Any]:
    """Attributes of a varying parameter as a coordinate; words have no unit."""
    stated = attributes(name)
    if name in (*CHOICES, "disc"):
        return {"long_name": stated["long_name"]}
    return stated


# ---- Points of which there is something to say


def point_lines(study: xr.Dataset) -> tuple[list[str], list[str]]:
    """Lines of the points without a result, and of those with a result and a message: parameters,
    status and message."""
    status = study["status"]
    flags = status.attrs["flag_meanings"].split()
    varied = [str(name) for name in study.coords if {*study[name].dims} <= {*status.dims}]
    failures, remarks = [], []
    for index in np.ndindex(*status.shape):
        point = study[["status", "message"]].isel(dict(zip(status.dims, index, strict=True)))
        word = flags[int(point["status"])]
        message = str(point["message"].values)
        values = ", ".join(_value_text(name, point[name].item()) for name in varied)
        if word not in ("ok", EXCLUDED):
            failures.append(f"{values}: {word}: {message}")
        elif message:
            remarks.append(f"{values}: {message}")
    return failures, remarks


def _value_text(name: str, value: Any) -> str:
    """A value of a point with its name and unit."""
    if isinstance(value, str):
        return f"{name} = {value}"
    unit = unit_of_parameter(name) if name in Parameters.model_fields else ""
    return f"{name} = {value:.9g} {unit}".strip()


# ---- Whole studies


def run_study(
    source: str | Path | Mapping[str, Any],
    *,
    map: Callable[..., Iterable[Any]] = map,
    progress: bool = False,
) -> xr.Dataset | xr.DataTree:
    """Compute a study in this process, without files.

    Parameters
    ----------
    source : path of a study file, or the mapping that such a file holds
    map : as in `sweep`
    progress : whether a bar on standard error shows how many points are done

    Returns
    -------
    xarray.Dataset
        The quantity over the grid, with the `status` and `message` of each point. A study of named cases gives a
        DataTree of them, one of several grids a DataTree of their datasets.

    Raises
    ------
    disc_model.studies.study.StudyError
        If the study has faults; it lists all of them.

    Examples
    --------
    >>> import disc_model as dm
    >>> axes = {"mu_s": [0.35, 0.4], "mu_k": [0.2]}
    >>> study = {"study": "growth", "quantity": "floquet", "base": {"N": 385, "Omega": 12}, "axes": axes}
    >>> dm.run_study(study)["growth_rate"].sizes
    Frozen({'mu_s': 2, 'mu_k': 1})

    A bifurcation diagram:

    >>> turns = {"study": "turns", "quantity": "bifurcation", "options": {"transient": 20}}
    >>> turns |= {"base": {"N": 385}, "axes": {"Omega": [14, 15]}}
    >>> dm.plot_sweep(dm.run_study(turns)).get_xlabel()
    'Speed Ω (rad/s)'
    """
    # needs yaml, of the extra `workflow`
    from disc_model.studies.study import load_study, parse_study

    named = isinstance(source, str | Path | Mapping)
    require(
        (named, "source", source, "must be the path of a study file, or a mapping"),
        (callable(map), "map", map, "must be a function, such as map of an executor"),
        (isinstance(progress, bool), "progress", progress, "must be True or False"),
    )
    folder = Path() if isinstance(source, Mapping) else Path(source).parent
    study = parse_study(source, folder) if isinstance(source, Mapping) else load_study(source)
    grids, names = study.all_grids([folder])
    datasets: dict[str, Any] = {}
    for name in names:
        datasets[name] = _run_grid(grids[name], map, progress)
    if study.specs:
        trees = dict(zip(study.specs, map(run_case, study.specs.values()), strict=True))
        datasets["cases"] = xr.DataTree(children=trees)
    if len(datasets) == 1:
        return next(iter(datasets.values()))
    return xr.DataTree.from_dict(datasets)


def _run_grid(study: Study, map: Callable[..., Iterable[Any]], progress: bool) -> xr.Dataset:
    """The grid of a study, whose points are computed here."""
    grid = study.grid
    assert grid is not None
    layout = grid.layout
    call = call_of({**layout, "axes": {dim: grid.dims[dim][dim].tolist() for dim in grid.plane}})
    call = replace(call, make=partial(_known_or_made, grid.case, grid.first, call.make))
    rows = compute(call, grid.rows, map=map, title=grid.quantity.name, progress=progress)
    return merge(layout, [_along_points(layout, grid.rows, rows)], study.attrs)
