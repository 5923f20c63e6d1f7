"""Groups of variables in the format of MATLAB, and back."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.data.files import (
    MissingFile,
    WriteError,
    check_mat,
    seal_mat,
    unreadable,
    write_atomically,
)
from disc_model.errors import Fault, ParameterError, raise_faults
from disc_model.units import Count, Strict

BESIDE = ("dataset", "units", "meanings", "dimensions")
"""What a .mat file holds beside variables and groups."""
LONGEST = 63  # characters of a name in MATLAB


class StoredVariable(Strict):
    """What a .mat file says of a variable beside its values.

    Attributes
    ----------
    name, dims : in the dataset
    field : its name in the file
    shape : of its values, which have two dimensions or more in MATLAB
    dtype : of its values; "str" for words
    attrs : JSON of its attributes
    coordinate : whether it is one
    """

    name: str
    field: str
    dims: tuple[str, ...]
    shape: tuple[Count, ...]
    dtype: str
    attrs: str
    coordinate: bool


class StoredGroup(Strict):
    """What a .mat file says of a group: its variables, and JSON of its attributes."""

    variables: tuple[StoredVariable, ...]
    attrs: str


class StoredDataset(Strict):
    """What a .mat file says of a dataset: its groups by their paths."""

    groups: dict[str, StoredGroup]


def save_mat(groups: Mapping[str, xr.Dataset], file: Path) -> None:
    """Write groups, given by their paths, as structures of arrays."""
    from scipy.io import savemat
    from scipy.io.matlab import MatWriteError

    described = {path: _description(group) for path, group in groups.items()}
    raise_faults(list(_name_faults(described)))
    content: dict[str, Any] = {}
    for path, stored in described.items():
        structure = content
        for part in path.split("/")[1:]:
            if part:
                structure = structure.setdefault(_field(part), {})
        structure.update(_structure(groups[path], stored))
    content["dataset"] = StoredDataset(groups=described).model_dump_json()

    def write(name: str) -> None:
        savemat(name, content, appendmat=False, long_field_names=True, oned_as="column")
        seal_mat(name)

    try:
        write_atomically(file, write)
    except MatWriteError as error:  # of what is larger than the format allows, 4 GB
        raise WriteError(f"{file}: cannot be written: {error}; netCDF has no such limit") from None


def _description(group: xr.Dataset) -> StoredGroup:
    """What a file says of a group beside the values."""
    variables = []
    for key, variable in group.variables.items():
        is_words = variable.dtype.kind in "UO"
        stored = StoredVariable(
            name=str(key),
            field=_field(str(key)),
            dims=tuple(map(str, variable.dims)),
            shape=variable.shape,
            dtype="str" if is_words else variable.dtype.name,
            attrs=_attributes_text(variable.attrs),
            coordinate=key in group.coords,
        )
        variables.append(stored)
    return StoredGroup(variables=tuple(variables), attrs=_attributes_text(group.attrs))


def _field(name: str) -> str:
    """A name as MATLAB allows it."""
    field = re.sub(r"\W", "_", name, flags=re.ASCII)
    return field if re.match(r"[A-Za-z]", field) else f"x{field}"


def _name_faults(groups: Mapping[str, StoredGroup]) -> Iterator[str]:
    """Yield names that cannot be in a .mat file."""
    rule = f"must be a name of at most {LONGEST} characters, and none of {', '.join(BESIDE)}"
    for path, group in groups.items():
        place = tuple(part for part in path.split("/") if part)
        names = [(*place, variable.name) for variable in group.variables]
        below = [x for x in groups if x.rpartition("/")[0] == path.rstrip("/") and x != path]
        names += [tuple(x.split("/")[1:]) for x in below]
        known: dict[str, str] = {}
        for name in names:
            field = _field(name[-1])
            if field in BESIDE or len(field) > LONGEST:
                yield Fault(name, "", f"{rule}, in a .mat file")
            elif field in known:
                yield Fault(name, "", f"must differ from {known[field]} in letters and digits")
            known[field] = name[-1]


def _attributes_text(attrs: Mapping[Any, Any]) -> str:
    """JSON of attributes: arrays with the kind of their numbers."""
    plain: dict[str, Any] = {}
    for name, value in attrs.items():
        plain[str(name)] = value
        if not isinstance(value, str):
            numbers = np.asarray(value)
            plain[str(name)] = {"dtype": numbers.dtype.name, "values": numbers.tolist()}
    return json.dumps(plain)


def _attributes(text: str) -> dict[str, Any]:
    """Attributes from their JSON."""
    attrs = json.loads(text)
    for name, value in attrs.items():
        if isinstance(value, dict):
            attrs[name] = np.array(value["values"], value["dtype"])[()]
    return attrs


def _structure(group: xr.Dataset, stored: StoredGroup) -> dict[str, Any]:
    """The values of a group by their names in MATLAB, with units, dimensions and meanings."""
    structure: dict[str, Any] = {}
    units = {}
    dimensions = {}
    meanings = {}
    for variable in stored.variables:
        values = group.variables[variable.name]
        structure[variable.field] = _matlab_values(values)
        dimensions[variable.field] = np.array(variable.dims, dtype=object)
        if "units" in values.attrs:
            units[variable.field] = values.attrs["units"]
        if "flag_meanings" in values.attrs:
            words = str(values.attrs["flag_meanings"]).split()
            meanings[variable.field] = np.array(words, dtype=object)
    beside = {"units": units, "dimensions": dimensions, "meanings": meanings}
    structure.update({name: table for name, table in beside.items() if table})
    return structure


def _matlab_values(variable: xr.Variable) -> Any:
    """The values of a variable as scipy writes them: words as cells, a single one as text."""
    if variable.dtype.kind not in "UO":
        return variable.values
    return variable.values.astype(object) if variable.ndim else str(variable.values)


def load_mat(file: Path) -> dict[str, xr.Dataset]:
    """The groups of a .mat file by their paths."""
    from scipy.io import loadmat

    if not file.exists():
        raise MissingFile(f"{file}: there is no such file")
    check_mat(file)
    try:
        content = loadmat(file, appendmat=False)
        text = str(content["dataset"][0])
        stored = StoredDataset.model_validate_json(text)
        return {path: _group(content, path, group) for path, group in stored.groups.items()}
    except KeyError:
        reason = "it holds no dataset; Result.load and State.load read runs and states"
        raise unreadable(file, reason) from None
    except (ParameterError, ValueError, TypeError, IndexError) as error:
        raise unreadable(file, error) from error


def _group(content: Mapping[str, Any], path: str, stored: StoredGroup) -> xr.Dataset:
    """A group of a .mat file, which has the contents that scipy reads."""
    structure: Any = content
    for part in path.split("/")[1:]:
        if part:
            structure = _member(structure, _field(part))
    variables = {}
    for variable in stored.variables:
        values = _read_values(_member(structure, variable.field), variable)
        variables[variable.name] = xr.Variable(variable.dims, values, _attributes(variable.attrs))
    coordinates = {x.name: variables.pop(x.name) for x in stored.variables if x.coordinate}
    return xr.Dataset(variables, coordinates, _attributes(stored.attrs))


def _member(structure: Any, field: str) -> Any:
    """A member of the whole file or of a structure of one element."""
    return structure[field] if isinstance(structure, Mapping) else structure[field][0, 0]


def _read_values(array: NDArray[Any], variable: StoredVariable) -> NDArray[Any]:
    """The values of a variable as they were before they were written."""
    if variable.dtype != "str":
        return array.astype(variable.dtype).reshape(variable.shape)
    if array.dtype.kind == "O":
        words = [str(cell[0]) if cell.size else "" for cell in array.flat]
    else:  # a single word
        words = [str(array[0]) if array.size else ""]
    return np.array(words, dtype=str).reshape(variable.shape)
