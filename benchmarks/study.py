"""The runner of all studies of the benchmark."""

import enum
import os
import platform
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.data.dataset import json_attribute
from disc_model.data.variables import Variable
from disc_model.provenance import versions

_FILE = Path(__file__).with_name("variables.toml")
TABLES = tomllib.loads(_FILE.read_text(encoding="utf-8"))
CONTACTS: dict[str, dict[str, Any]] = TABLES["contacts"]
"""By name of a contact, what it adds to the parameters of a case."""
Row = Mapping[str, Any]
Flags = Mapping[str, type[enum.IntEnum]]


def run(
    table: str,
    points: Sequence[Row] | Mapping[str, Sequence[Any]],
    measure: Callable[..., Iterable[Row]],
    dims: Sequence[str] = (),
    *,
    rounds: int = 1,
    flags: Flags | None = None,
    **about: Any,
) -> xr.Dataset:
    """Measure the variables of a table at points.

    Parameters
    ----------
    table : name of the table of variables
    points : coordinates and settings of each point by name, or the axes of a grid
    measure : yields results of a point by variable: one, several, or none if it is skipped
    dims : coordinates that become dimensions; without any, and without axes, results are rows
    rounds : in which all points are measured in turn, so that a disturbance affects all alike
    flags : meanings of variables; the last stands where nothing was measured, and nan in others
    about : attributes of the dataset
    """
    if isinstance(points, Mapping):
        dims = [*points]
        points = [dict(zip(points, values, strict=True)) for values in product(*points.values())]
    variables = _variables(table, flags or {})
    rows = []
    for _ in range(rounds):
        for point in points:
            rows += [{**point, **result} for result in measure(**point)]
    dataset = _dataset(rows, points, dims, variables)
    for name, variable in variables.items():
        if variable.flags:
            missing = len(variable.flags) - 1
            dataset[name] = dataset[name].fillna(missing).astype(np.int8)
        dataset[name].attrs = variable.attributes
    return dataset.assign_attrs(
        machine=machine(), versions=json_attribute(versions("heyoka", "scikit-sundae"))
    ).assign_attrs(about)


def _variables(table: str, flags: Flags) -> dict[str, Variable]:
    """Return the variables of a table by name, with the words of their flags."""
    variables = {}
    for name, (units, long_name) in TABLES[table].items():
        words = tuple(flag.name.lower() for flag in flags.get(name, ()))
        variables[name] = Variable(units, long_name, words)
    return variables


def _dataset(
    rows: Sequence[Row],
    points: Sequence[Row],
    dims: Sequence[str],
    variables: Mapping[str, Variable],
) -> xr.Dataset:
    """Return medians of results along dimensions, or all results as rows if there are none.

    Parameters
    ----------
    rows : coordinates and results
    points : the points that were to be measured
    dims : coordinates that become dimensions
    variables : by name; ``repeats`` is the number of results of a point
    """
    frame = pd.DataFrame(rows, columns=[*dict.fromkeys([*dims, *variables])])
    numbers = [name for name, variable in variables.items() if variable.units and name not in dims]
    frame = frame.astype(dict.fromkeys(numbers, float))
    if not dims:
        return frame.rename_axis("row").to_xarray().drop_vars("row")
    groups = frame.groupby([*dims])
    medians = groups.median()
    if "repeats" in variables:
        medians = medians.assign(repeats=groups.size())
    axes = {}
    for dim in dims:
        values = [point[dim] for point in points]
        axes[dim] = [*dict.fromkeys(values)]
    return medians.to_xarray().reindex(axes)


def machine() -> str:
    """Return the processor, its number of cores and the system, in words."""
    model = platform.processor() or platform.machine()
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                model = line.partition(":")[2].strip()
                break
    return f"{model}, {os.cpu_count()} cores, {platform.system()}"
