"""Complex variables of a dataset as two real ones, for files that have no complex numbers."""

from __future__ import annotations

import numpy as np
import xarray as xr

from disc_model.errors import Fault, ParameterError

PARTS = ("real", "imag")
"""Ends of the names of variables that are parts of a complex one in netCDF, which has no complex
numbers."""
COMPLEX_PART = "complex_part"
"""Attribute of such a variable: which part it is."""


def with_parts(group: xr.Dataset) -> xr.Dataset:
    """A dataset with the real and the imaginary part in place of each complex variable."""
    variables: dict[str, xr.Variable] = {}
    coordinates: list[str] = []
    for key, variable in group.variables.items():
        parts = {str(key): variable}
        if variable.dtype.kind == "c":
            parts = _parts_of(str(key), variable)
        for name in parts.keys() & group.variables.keys() - {key}:
            rule = f"must have another name, because it is a part of {key} in the file"
            raise ParameterError(Fault((name,), "", rule))
        variables.update(parts)
        if key in group.coords:
            coordinates += parts
    return xr.Dataset(variables, attrs=group.attrs).set_coords(coordinates)


def _parts_of(name: str, variable: xr.Variable) -> dict[str, xr.Variable]:
    """The parts of a complex variable by their names."""
    parts = {}
    for part in PARTS:
        attrs = {**variable.attrs, COMPLEX_PART: part}
        values = getattr(variable.values, part)
        parts[f"{name}_{part}"] = xr.Variable(variable.dims, values, attrs)
    return parts


def joined(group: xr.Dataset) -> xr.Dataset:
    """A dataset with a complex variable in place of two that are its parts, and words as text of
    numpy's own."""
    variables: dict[str, xr.Variable] = {}
    coordinates = []
    for key, variable in group.variables.items():
        name = str(key)
        read = variable
        if COMPLEX_PART in variable.attrs:
            whole, _, _ = name.rpartition("_")
            names = [f"{whole}_{part}" for part in PARTS]
            if group.variables.keys() >= {*names}:
                name = whole
                read = _whole(*(group.variables[part] for part in names))
        elif variable.dtype.kind == "O":
            read = variable.astype(str)
        variables[name] = read
        if key in group.coords:
            coordinates.append(name)
    return xr.Dataset(variables, attrs=group.attrs).set_coords(coordinates)


def _whole(real: xr.Variable, imaginary: xr.Variable) -> xr.Variable:
    """The complex variable of two parts."""
    values = np.empty(real.shape, complex)
    values.real = real.values
    values.imag = imaginary.values
    attrs = {name: value for name, value in real.attrs.items() if name != COMPLEX_PART}
    return xr.Variable(real.dims, values, attrs)
