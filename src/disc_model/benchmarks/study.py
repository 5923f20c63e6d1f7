"""The runner of all studies of the benchmark."""

import enum
import logging
import os
import platform
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from disc_model.data.dataset import json_attribute
from disc_model.data.variables import Variable
from disc_model.sources import versions

log = logging.getLogger(__name__)

TABLES = tomllib.loads(Path(__file__).with_name("variables.toml").read_text(encoding="utf-8"))
CONTACTS: dict[str, dict[str, Any]] = TABLES["contacts"]  # by name, what each adds to the parameters of a case
Row = Mapping[str, Any]
Flags = Mapping[str, type[enum.IntEnum]]


def run(
    table: str,
    points: Sequence[Row] | Mapping[str, Sequence[Any]],  # coordinates and settings by name, or a grid's axes
    measure: Callable[..., Iterable[Row]],  # yields results by variable: one, several, or none for a skipped point
    dims: Sequence[str] = (),  # the axes, or coordinates that become dimensions; without any, results are rows
    *,
    rounds: int = 1,  # in which all points are measured in turn, so that a disturbance affects all alike
    cores: int = 1,
    summarise: Callable[[Any], pd.DataFrame] = lambda groups: groups.median(),  # results grouped by dims, to one each
    flags: Flags | None = None,  # meanings; the last stands where nothing was measured, and nan in other variables
    **about: Any,
) -> xr.Dataset:
    """Measure the variables of a table at points, and log what comes out."""
    if isinstance(points, Mapping):
        dims, points = [*points], [dict(zip(points, values, strict=True)) for values in product(*points.values())]
    meanings = {name: tuple(flag.name.lower() for flag in values) for name, values in (flags or {}).items()}
    variables = {
        name: Variable(units, long_name, meanings.get(name, ())) for name, (units, long_name) in TABLES[table].items()
    }
    rows = []
    with few_cores(cores):
        for _ in range(rounds):
            for point in points:
                for result in measure(**point):
                    rows.append({**point, **result})
                    log.info("%s", " ".join(f"{key}={value}" for key, value in rows[-1].items()))
    frame = pd.DataFrame(rows, columns=[*dict.fromkeys([*dims, *variables])])
    frame = frame.astype({name: float for name, variable in variables.items() if variable.units and name not in dims})
    if dims:
        axes = {dim: [*dict.fromkeys(point[dim] for point in points)] for dim in dims}
        dataset = summarise(frame.groupby([*dims])).to_xarray().reindex(axes)
    else:
        dataset = frame.rename_axis("row").to_xarray().drop_vars("row")
    for name, variable in variables.items():
        if variable.flags:
            dataset[name] = dataset[name].fillna(len(variable.flags) - 1).astype(np.int8)
        dataset[name].attrs = variable.attributes
    made_by = {"machine": machine(), "versions": json_attribute(versions("heyoka", "scikit-sundae"))}
    return dataset.assign_attrs(made_by | about)


@contextmanager
def few_cores(count: int) -> Iterator[None]:
    """Restrict this process, and what it begins meanwhile, to so many cores, where the system can do that."""
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, sorted(before)[-count:])
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def machine() -> str:
    model = platform.processor() or platform.machine()
    with suppress(OSError, StopIteration):
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        model = next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return f"{model}, {os.cpu_count()} cores, {platform.system()}"
