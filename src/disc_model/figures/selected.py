"""Words for what was selected of a sweep or of a grid study, as by ``study.sel(direction="up")``."""

from typing import Any

import xarray as xr

from disc_model.figures.sweep_options import COMPARED, option_text
from disc_model.figures.swept_lists import name_of_list
from disc_model.figures.value_texts import named_value, symbol_of, value_text
from disc_model.figures.words import known_name, label_in
from disc_model.parameters import RATIOS, Parameters

DIRECTIONS = {"up": "on the way up", "down": "on the way down"}
"""Words for the direction of a sweep."""
COUNTED = "number of the "
"""What long names of coordinates begin with whose values only count something."""


def selected_of(study: Any, varying: xr.Dataset, variable: str) -> dict[str, str]:
    """Words for the values at which a study was selected, by the names of its coordinates, without
    parameters, which every title says, and times that the label of the variable says.

    varying : the study as it is drawn, without dimensions of one value
    """
    label = label_in(varying, variable)
    said = {}
    for key, values in varying.coords.items():
        name = str(key)
        if values.ndim or name in Parameters.model_fields or name in RATIOS:
            continue
        is_in_label = name in COMPARED and value_text(varying, name) in label
        if not is_in_label and not _is_alone(study, name):
            said[name] = _selected_text(varying, name)
    return said


def _is_alone(study: xr.Dataset, name: str) -> bool:
    """Whether a study has a coordinate that counts values, of which there is but one."""
    values = study.get(name)
    return values is not None and values.ndim > 0 and _counts(values)


def _counts(values: xr.DataArray) -> bool:
    """Whether the values of a coordinate only count something."""
    return str(values.attrs.get("long_name", "")).startswith(COUNTED)


def _selected_text(study: xr.Dataset, name: str) -> str:
    """Words for the single value of a coordinate."""
    values = study[name]
    value = values.item()
    if name == "direction":
        return DIRECTIONS.get(value, str(value))
    if known_name(values):
        return f"{symbol_of(known_name(values))} = {value_text(study, name)}"
    if _counts(values):
        return f"{name.removesuffix('_number').replace('_', ' ')} {value}"
    if isinstance(value, bool):
        return f"{name.replace('_', ' ')} = {value}"
    listed = name_of_list(study, name)
    return listed or option_text(name, value) or named_value(study, name)
