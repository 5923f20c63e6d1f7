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
from disc_model.sources import versions

TABLES = tomllib.loads(Path(__file__).with_name("variables.toml").read_text(encoding="utf-8"))
CONTACTS: dict[str, dict[str, Any]] = TABLES[
    "contacts"
]  # by name, what each adds to the parameters of a case
Row = Mapping[str, Any]
Flags = Mapping[str, type[enum.IntEnum]]


def run(
    table: str,
    points: Sequence[Row]
    | Mapping[str, Sequence[Any]],  # coordinates and settings by name, or a grid's axes
    measure: Callable[
        ..., Iterable[Row]
    ],  # yields results by variable: one, several, or none for a skipped point
    dims: Sequence[
        str
    ] = (),  # the axes, or coordinates that become dimensions; without any, results are rows
    *,
    rounds: int = 1,  # in which all points are measured in turn, so that a disturbance affects all alike
    flags: Flags
    | None = None,  # meanings; the last stands where nothing was measured, and nan in other variables
    **about: Any,
) -> xr.Dataset:
    """Measure the variables of a table at points."""
    if isinstance(points, Mapping):
        dims, points = (
            [*points],
            [dict(zip(points, values, strict=True)) for values in product(*points.values())],
        )
    meanings = {
        name: tuple(flag.name.lower() for flag in values) for name, values in (flags or {}).items()
    }
    variables = {
        name: Variable(units, long_name, meanings.get(name, ()))
        for name, (units, long_name) in TABLES[table].items()
    }
    rows = [
        {**point, **result}
        for _ in range(rounds)
        for point in points
        for result in measure(**point)
    ]
    frame = pd.DataFrame(rows, columns=[*dict.fromkeys([*dims, *variables])])
    frame = frame.astype(
        {name: float for name, variable in variables.items() if variable.units and name not in dims}
    )
    if dims:
        axes = {dim: [*dict.fromkeys(point[dim] for point in points)] for dim in dims}
        groups = frame.groupby([*dims])
        repeats = {"repeats": groups.size()} if "repeats" in variables else {}
        dataset = groups.median().assign(**repeats).to_xarray().reindex(axes)
    else:
        dataset = frame.rename_axis("row").to_xarray().drop_vars("row")
    for name, variable in variables.items():
        if variable.flags:
            dataset[name] = dataset[name].fillna(len(variable.flags) - 1).astype(np.int8)
        dataset[name].attrs = variable.attributes
    made_by = {
        "machine": machine(),
        "versions": json_attribute(versions("heyoka", "scikit-sundae")),
    }
    return dataset.assign_attrs(made_by | about)


def machine() -> str:
    model = platform.processor() or platform.machine()
    with suppress(OSError, StopIteration):
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        model = next(
            line.partition(":")[2].strip() for line in lines if line.startswith("model name")
        )
    return f"{model}, {os.cpu_count()} cores, {platform.system()}"
