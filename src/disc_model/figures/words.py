"""Words of figures: labels of variables, names of values, and what a figure's head says. Nothing here
draws."""

import re
from collections.abc import Mapping
from contextvars import ContextVar
from textwrap import fill
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from disc_model.data import variables
from disc_model.data.variables import EXCLUDED, SHOWN, axis_of, flag_names, typeset
from disc_model.figures.classes import name_of

MODES = {
    "as_published": "modes as published",
    "orthonormal": "orthonormal modes",
    "given": "modes of a table",
}
WORDS = {**MODES, "vertical": "vertical contact force", "normal": "normal contact force"}
"""Names of words along a dimension, in the order in which they are drawn: those of the paper first."""
MODELS = {
    "normal": WORDS["normal"],
    "residual": "residual flexibility",
    "surface": "friction on the surface",
    "bilateral": "bilateral contact",
    "bonded": "bilateral contact",  # its name in older files of results
}
UNITS: ContextVar[Mapping[str, tuple[str, float]]] = ContextVar("units", default={})  # noqa: B039
"""Units of the reader and the factors from SI to them, by parameter or sampled variable, while a
figure is drawn."""
CHARACTER = 0.06  # inch, mean width of a character of a figure's head
LONGEST_LINE = 48  # characters of a label's line


class Measured(NamedTuple):
    """A variable for an axis: its label with a unit, and its values in this unit."""

    label: str
    values: np.ndarray


# ---- Labels of variables


def label_of(variable: xr.DataArray) -> tuple[str, float]:
    """Axis label of any variable or coordinate, and the factor from SI to its unit."""
    words = str(variable.attrs.get("long_name", variable.name)).partition(", nan ")[0]
    # a scanned parameter is the long name of its dimension
    for name in (str(variable.name), words):
        if name in SHOWN:
            return axis_of(name)
    # disturbances have one name in all figures
    words = words.replace("disturbances of ", "")
    phrase = fill(words[0].upper() + words[1:], LONGEST_LINE)
    unit = unit_text(str(variable.attrs.get("units", "1")))
    return (f"{phrase} ({unit})" if unit else phrase), 1.0


def unit_text(units: str) -> str:
    """A unit of a dataset, such as ``m s-1``, as labels have it; "" for none."""
    if units in ("", "1"):
        return ""
    text = units.replace("s-1", "/s").replace(" /", "/")
    return f"1{text}" if text.startswith("/") else text


def measured(variable: xr.DataArray) -> Measured:
    """The label of a variable, and its values in the label's unit."""
    label, factor = label_of(variable)
    values = variable.values
    return Measured(label, values if factor == 1.0 else values * factor)


def quantity_of_label(label: str) -> str:
    """What a label says before its unit."""
    return label.rpartition(" (")[0] or label


def as_numbers(variable: xr.DataArray) -> tuple[list[str], xr.DataArray]:
    """Names of a flag's classes, none for other variables; and the variable with numbers for words,
    their places."""
    if variable.dtype.kind in "UO":
        distinct, places = np.unique(flag_names(variable), return_inverse=True)
        numbers = variable.copy(data=places.reshape(variable.shape).astype(float))
        return [name_of(word) for word in distinct], numbers
    words = variable.attrs.get("flag_meanings", "").split()
    return [name_of(word) for word in words if word != EXCLUDED], variable


# ---- Names of values


def value_text(data: xr.DataArray | xr.Dataset, by: str) -> str:
    """A value along a dimension with its unit, or its word."""
    value = data[by].item()
    if isinstance(value, str):
        return WORDS.get(value, value)
    if by == "contact_compliance":
        return f"{value * SHOWN[by].factor:.3g} µm/N" if value else "rigid contact"
    if by == "friction_offset":
        height = f"{value * SHOWN[by].factor:g} mm above the middle plane"
        return f"friction {height}" if value else "friction in the middle plane"
    label, factor = label_of(data[by])
    name, _, unit = label.rpartition(" (")
    unit, factor = UNITS.get().get(by, (unit.rstrip(")"), factor))
    return f"{value * factor:g} {unit}" if name else f"{value * factor:g}"


def named_value(data: xr.DataArray | xr.Dataset, by: str) -> str:
    """The name of a dimension, and a value along it; a word stands for itself."""
    text = value_text(data, by)
    value = data[by].item()
    if by == "contact_compliance" and value:
        return f"compliance {text}"
    if isinstance(value, str) or by in ("contact_compliance", "friction_offset"):
        return text
    return f"{quantity_of_label(label_of(data[by])[0])} = {text}"


def rank_of(value: Any) -> Any:
    """Place of a value in an order: words as in `WORDS`, or by the number that they begin with."""
    if not isinstance(value, str):
        return value
    leading = re.match(r"\d+", value)
    known = [*WORDS]
    return (known.index(value) if value in known else 0, float(leading[0]) if leading else np.inf)


# ---- Heads of figures


def what_case(values: Mapping[str, Any]) -> str:
    """Values of parameters for titles: N, Omega, and those that differ from Table 1."""
    words = [
        MODELS[value] for value in values.values() if isinstance(value, str) and value in MODELS
    ]
    if values.get("normalization") == "orthonormal":
        words.append(MODES["orthonormal"])
    numbers = {name: value for name, value in values.items() if not isinstance(value, str)}
    return ", ".join(filter(None, [variables.values_text(numbers, UNITS.get()), *words]))


def head_text(width: float, title: str, values: str) -> str:
    """A title and values of parameters, in lines that fit a width in inches; a value stays on the
    line of its name."""
    unbroken = [value.replace(" ", "\u00a0") for value in typeset(values).split(", ")]
    texts = [text for text in (title, ", ".join(unbroken)) if text]
    lines = [fill(text, round(width / CHARACTER)) for text in texts]
    return "\n".join(lines).replace("\u00a0", " ")
