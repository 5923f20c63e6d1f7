"""Dimensions of a sweep: which of them are drawn, and which only count values."""

import re
from typing import Any

import xarray as xr

from disc_model.data.variables import WITHOUT_EFFECT

COUNTED = ("branch", "branch_point")
"""Dimensions whose values only count something."""
COUNT = re.compile("number of the (?!.* along )")
"""What long names of dimensions begin with along which a variable has several values at one point, in
no order of their own."""


def columns_along(study: xr.Dataset, dim: str) -> list[str]:
    """The columns of numbers along a dimension of samples, those of the case first, and then of words."""
    beside = [
        str(name) for name, values in study.coords.items() if values.dims == (dim,) and name != dim
    ]
    numbers = [name for name in beside if study[name].dtype.kind in "fi"]
    numbers.sort(key=lambda name: _is_without_effect(study[name]))
    return [*numbers, *(name for name in beside if study[name].dtype.kind in "UO")]


def _is_without_effect(values: xr.DataArray) -> bool:
    """Whether numbers along samples are none of the case."""
    return WITHOUT_EFFECT.items() <= values.attrs.items()


def drawn_dims(study: xr.Dataset) -> list[str]:
    """Dimensions of a study whose values are numbers of a quantity; words where there are none."""
    named = [str(dim) for dim in study.dims if dim in study.coords and dim not in COUNTED]
    numbers = [dim for dim in named if study[dim].dtype.kind in "fi"]
    if "status" not in study or not all(only_counts(study, dim) for dim in numbers):
        return numbers
    words = [dim for dim in named if dim in study["status"].dims and dim not in numbers]
    return [*words, *numbers]


def dims_without_coordinates(study: xr.Dataset, variable: str) -> list[Any]:
    """The dimensions of a variable that have no coordinate; none of what is no variable."""
    if variable not in study.data_vars:
        return []
    return [dim for dim in study[variable].dims if dim not in study.coords]


def only_counts(study: xr.Dataset, dim: str) -> bool:
    """Whether a dimension only counts the values that a variable has at a point, such as the samples
    of a Poincaré section."""
    if dim not in study.coords:
        return True
    return bool(COUNT.match(str(study[dim].attrs.get("long_name", ""))))


def numbers_along(study: xr.Dataset, dim: str) -> list[str]:
    """The names of numbers of the case along a dimension."""
    along = [str(name) for name, values in study.coords.items() if values.dims == (dim,)]
    numbers = [name for name in along if study[name].dtype.kind in "fi"]
    return [name for name in numbers if not _is_without_effect(study[name])]


def selection_for(study: xr.Dataset, variable: str, x: str) -> str:
    """How values of a variable along two dimensions are selected, one of which is `x` unless that is "", as
    "study.sel(Omega=14)"."""
    dims = [str(dim) for dim in study[variable].dims if dim != x]
    numbers = [dim for dim in drawn_dims(study) if dim in dims]
    further = numbers[: study[variable].ndim - 2]
    if not further:
        return f"study.isel({dims[0]}=0)"
    values = [f"{dim}={_text_of(study[dim].values[0].item())}" for dim in further]
    return f"study.sel({', '.join(values)})"


def _text_of(value: float) -> str:
    """A number in as few digits as it has."""
    short = f"{value:g}"
    return short if float(short) == value else repr(value)
