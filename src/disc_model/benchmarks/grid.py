"""Datasets of what is measured at each point of a grid, and their variables, from ``variables.toml``."""

import enum
import math
import tomllib
from collections.abc import Callable, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import Variable

TABLES = tomllib.loads(Path(__file__).with_name("variables.toml").read_text(encoding="utf-8"))


def words(kinds: type[enum.IntEnum]) -> tuple[str, ...]:
    """Words for the values of a flag."""
    return tuple(kind.name.lower() for kind in kinds)


def variables(table: str, **flags: type[enum.IntEnum]) -> dict[str, Variable]:
    """The variables of a dataset, of which some are flags."""
    return {
        name: Variable(units, long_name, words(flags[name]) if name in flags else ())
        for name, (units, long_name) in TABLES[table].items()
    }


def measured(
    coords: Mapping[str, Sequence[Any]], variables: Mapping[str, Variable], measure: Callable[..., Mapping[str, float]]
) -> xr.Dataset:
    """Results of ``measure`` at each point; variables that it omits are nan, which a flag must never be."""
    shape = tuple(len(values) for values in coords.values())
    data = {name: np.full(shape, math.nan) for name in variables}
    for place, point in zip(np.ndindex(shape), product(*coords.values()), strict=True):
        for name, value in measure(*point).items():
            data[name][place] = value
    flags = {name: data[name].astype(np.int8) for name, own in variables.items() if own.flags}
    return xr.Dataset(
        {name: ([*coords], (data | flags)[name], own.attributes) for name, own in variables.items()},
        coords={name: list(values) for name, values in coords.items()},
    )
