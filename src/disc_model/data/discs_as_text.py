"""Discs in datasets as text, in JSON, in which files can hold them."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from disc_model.parameters import PLATE_NAME, Disc

DISCS = "json_of_disc"
"""Attribute of a variable of texts, each of which is a disc in JSON, or the word for a plate: yes."""


def with_texts(group: xr.Dataset) -> xr.Dataset:
    """A dataset with the JSON of discs in their place."""
    texts = {}
    for key, variable in group.variables.items():
        values = variable.values
        if _are_discs(str(key), values):
            written = [_text_of(value) for value in values.flat]
            attrs = {**variable.attrs, DISCS: "yes"}
            texts[key] = xr.Variable(variable.dims, np.reshape(written, values.shape), attrs)
    return _replaced(group, texts)


def _are_discs(name: str, values: NDArray[Any]) -> bool:
    """Whether values are discs, or None for a plate beside them or along the axis `disc`."""
    known = [value for value in values.flat if value is not None]
    are_known = bool(known) or (name == "disc" and values.size > 0)
    return are_known and all(isinstance(value, Disc) for value in known)


def _text_of(disc: Disc | None) -> str:
    """A disc as JSON; the word for a plate, which is given by its sizes and material."""
    return PLATE_NAME if disc is None else disc.model_dump_json()


def _disc_of(text: str) -> Disc | None:
    """The disc of a text, None for a plate."""
    return None if text == PLATE_NAME else Disc.model_validate_json(text)


def with_discs(group: xr.Dataset) -> xr.Dataset:
    """A dataset with discs in place of their JSON."""
    discs = {}
    for key, variable in group.variables.items():
        if DISCS not in variable.attrs:
            continue
        values = np.empty(variable.shape, object)
        for place, text in np.ndenumerate(variable.values):
            values[place] = _disc_of(str(text))
        attrs = {name: value for name, value in variable.attrs.items() if name != DISCS}
        discs[key] = xr.Variable(variable.dims, values, attrs)
    return _replaced(group, discs)


def _replaced(group: xr.Dataset, others: Mapping[Any, xr.Variable]) -> xr.Dataset:
    """A dataset with other variables in place of those of the same names."""
    if not others:
        return group
    variables = {**group.variables, **others}
    return xr.Dataset(variables, attrs=group.attrs).set_coords([*group.coords])
