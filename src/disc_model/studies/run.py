"""Jobs of studies and their merging, and whole studies without files."""

from __future__ import annotations

import json
import logging
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pandas as pd
import xarray as xr
from xarray import Dataset

from disc_model.data.coded import table_of
from disc_model.data.dataset import CONVENTIONS
from disc_model.data.variables import EXCLUDED, OF_QUANTITIES, described
from disc_model.parameters import Disc
from disc_model.provenance import git_commit, physics_hash, versions_text
from disc_model.simulation.named_case import run_case
from disc_model.studies.compute import Call, Map, compute, stack
from disc_model.studies.grid import VARIED, Points, case_of
from disc_model.studies.motions import history_from
from disc_model.studies.quantity import Row, found, quantity_of

POINT = "point"
log = logging.getLogger(__name__)
Layout = Row


# ---- Jobs


def call_of(layout: Layout) -> Call:
    """The call of a quantity, from what all points of a grid have in common."""
    quantity = quantity_of(layout["quantity"])
    options = quantity.options.model_validate(layout["options"])
    discs = {name: Disc.model_validate(disc) for name, disc in layout["discs"].items()}
    make = partial(case_of, {**quantity.unset(options), **layout["base"]}, discs)
    return Call(quantity.function, make, dict(options), quantity.name)


def run_job(job: str, known: Iterable[Dataset] = ()) -> Dataset:
    """The results of a job along `point`.

    Parameters
    ----------
    job : a text of `Study.jobs`
    known : results of other jobs on the same quantity, options and base, from which points are taken
    """
    layout = json.loads(job)
    points = layout["points"]
    there = {str(point): row for part in known for point, row in points_of(part)}
    missing = [point for point in points if str(point) not in there]
    call = call_of(layout)
    there |= zip(map(str, missing), compute(call, missing), strict=True)
    log.info("%d of %d points computed", len(missing), len(points))
    return _along_points(call, points, [there[str(point)] for point in points])


def run_motions(job: str) -> Dataset:
    """Histories along `point` and `sample`, for a text of `Study.motions`."""
    layout = json.loads(job)
    motion = quantity_of(layout["quantity"]).motion
    assert motion is not None
    history = partial(history_from, motion.state)
    call = replace(call_of(layout), function=history, quantity="motions")
    points = layout["points"]
    return described(_along_points(call, points, compute(call, points)), "motions")


def _along_points(call: Call, points: Points, rows: Sequence[Dataset]) -> Dataset:
    """Results of a call in one dataset, with what varies as coordinates along `point`."""
    frame = pd.DataFrame(points)
    found = stack(rows, {POINT: frame}, OF_QUANTITIES[call.quantity]["columns"])
    return found.assign_attrs(names=json.dumps([*frame]))


def points_of(part: Dataset) -> Iterable[tuple[dict[Any, Any], Dataset]]:
    """The points of a job's results, and the result at each."""
    names = json.loads(part.attrs["names"])
    points = pd.DataFrame({name: part[name].values for name in names}).to_dict("records")
    results = part.drop_vars(names)
    for i, point in enumerate(points):
        yield point, results.isel(point=i)


def merge(layout: Layout, results: Sequence[Dataset], attrs: Mapping[str, str]) -> Dataset:
    """The results at all points of a grid over its dimensions, which a variable has in the order of the
    parameters, before its own.

    Parameters
    ----------
    layout : of `Study.layout`
    results : at all points that are not left out, in the order of `Study.points`
    attrs : of the study
    """
    name = layout["quantity"]
    dims = {dim: pd.DataFrame(columns) for dim, columns in layout["dims"].items()}
    rows = [found(name, {"status": EXCLUDED})] * math.prod(map(len, dims.values()))
    for place, result in zip(layout["places"], results, strict=True):
        rows[place] = result
    study = stack(rows, dims, OF_QUANTITIES[name]["columns"])
    first = {dim: frame.columns[0] for dim, frame in dims.items()}

    def rank(dim: Any) -> int:
        name = first.get(dim, dim)
        return VARIED.index(name) if name in VARIED else len(VARIED)

    ordered = sorted(study.dims, key=rank)
    every = {"Conventions": CONVENTIONS, **attrs, "quantity": name}
    for key in ("options", "base", "discs"):
        every[key] = json.dumps(layout[key], sort_keys=True)
    every |= {
        "git_commit": git_commit(),
        "source_hash": physics_hash(),
        "versions": versions_text(),
    }
    return described(study.transpose(*ordered).assign_attrs(every), name, layout["options"])


# ---- Points of which there is something to say


def told_points(study: Dataset) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Tables of the points without a result, and of those with a result and a message."""
    points = table_of(study[["status", "message"]])
    known = points["status"].isin(["ok", EXCLUDED])
    return points[~known], points[known & (points["message"] != "")]


# ---- Whole studies


def run_study(
    source: str | Path | Mapping[str, Any], *, map: Map = map, progress: bool = False
) -> Dataset | xr.DataTree:
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

    >>> study = {"study": "samples", "quantity": "bifurcation", "options": {"transient": 20}}
    >>> study |= {"base": {"N": 385}, "axes": {"Omega": [14, 15]}}
    >>> dm.plot_sweep(dm.run_study(study)).get_xlabel()
    'Speed Ω (rad/s)'
    """
    # needs yaml, of the extra `workflow`
    from disc_model.studies.study import load_study, parse_study

    folder = Path() if isinstance(source, Mapping) else Path(source).parent
    study = parse_study(dict(source)) if isinstance(source, Mapping) else load_study(source)
    grids, names = study.all_grids([folder])
    datasets: Row = {}
    for name in names:
        grid = grids[name]
        points: Points = grid.points.to_dict("records")
        call = call_of(grid.layout)
        results = compute(call, points, map=map, title=call.quantity, progress=progress)
        datasets[name] = merge(grid.layout, results, grid.attrs)
    if study.cases:
        trees = dict(zip(study.cases, map(run_case, study.cases.values()), strict=True))
        datasets["cases"] = xr.DataTree(children=trees)
    if len(datasets) == 1:
        return next(iter(datasets.values()))
    return xr.DataTree.from_dict(datasets)
