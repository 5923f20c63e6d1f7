"""Names of values along the dimensions of a study."""

import re
from textwrap import fill
from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.variables import SHOWN, typeset
from disc_model.figures.words import KINDS, MISSING, UNITS, WORDS, is_truth, known_name, named
from disc_model.parameters import NUMBER_OR_WORD

MODELS = {
    "normal": WORDS["normal"],
    "exponential": WORDS["exponential"],
    "residual": "residual flexibility",
    "surface": "friction on the surface",
    "bilateral": "bilateral contact",
    "bonded": "bilateral contact",  # its name in older files of results
}
AT_ZERO = {
    "contact_compliance": "rigid contact",
    "contact_arc": "contact at a point",
    "friction_offset": "friction in the middle plane",
}
"""What parameters mean that are zero: they name themselves."""
OF_SIZE = {
    "contact_compliance": "compliance {:.3g} µm/N",
    "contact_arc": "a pad over {:g} rad",
    "friction_offset": "friction {:g} mm above the middle plane",
}
"""What these parameters mean otherwise, by their sizes in the units that are shown."""
BY_SIZE = {"exponent_number": "exponent {}"}
"""Names of the values along a dimension of descending numbers, but for the first, the largest."""
ROUNDING = 1e-9  # relative, of a number in another unit
LONGEST_NAME = 22  # characters of a line of the name of a class beside the panel


def value_text(data: xr.DataArray | xr.Dataset, by: str, *, short: bool = False) -> str:
    """A value along a dimension with its unit, or its word; a short one has four digits if six do not give
    it exactly, as that of a sample."""
    value = data[by].item()
    if isinstance(value, str) and by in NUMBER_OR_WORD:
        value = number_or_text(value)
        value = MODELS.get(value, value)
    if isinstance(value, str):
        words = KINDS if by == "kind" else WORDS
        return words.get(value, value)
    if isinstance(value, float) and np.isnan(value):
        return MISSING
    if by in AT_ZERO and not value:
        return AT_ZERO[by]
    if by in BY_SIZE:
        return BY_SIZE[by].format(value + 1) if value else f"largest {by.partition('_')[0]}"
    return _number_text(data[by], value, short=short)


def _number_text(along: xr.DataArray, value: float, *, short: bool) -> str:
    """A number along a dimension with its unit, or what it means as the size of a parameter that names
    itself."""
    name = str(along.name)
    is_usual = known_name(along) == name
    if is_usual and name in OF_SIZE:
        return OF_SIZE[name].format(value * SHOWN[name].factor)
    _, unit, factor = named(along)
    if is_usual:
        unit, factor = UNITS.get().get(name, (unit, factor))
    number = _short_number(value * factor) if short else f"{value * factor:g}"
    return f"{number} {unit}".strip()


def number_or_text(part: str) -> Any:
    """The number that a text says, or the text."""
    try:
        return float(part)
    except ValueError:
        return part


def _short_number(value: float) -> str:
    """A number with up to six digits, or with four if six do not give it exactly."""
    text = f"{value:g}"
    short = f"{value:.4g}"
    is_exact = np.isclose(float(text), value, rtol=ROUNDING, atol=0)
    return text if is_exact or "e" in short else short


def named_value(data: xr.DataArray | xr.Dataset, by: str, *, short: bool = False) -> str:
    """The name of a dimension, and a value along it; a word stands for itself."""
    text = value_text(data, by, short=short)
    value = data[by].item()
    if by in AT_ZERO or by in BY_SIZE or (isinstance(value, str) and not is_truth(data[by])):
        return text
    return f"{typeset(named(data[by]).name)} = {text}"


def symbol_of(name: str) -> str:
    """The symbol of a parameter; any other number has its name."""
    return SHOWN[name].symbol if name in SHOWN else name


def stated_value(name: str, value: Any) -> str:
    """The value of a parameter by its symbol, whether it is that of Table 1 or not."""
    text = value_text(xr.Dataset(coords={name: value}), name)
    if name == "contact":
        return f"{text} contact"
    if isinstance(value, str) or name in AT_ZERO:
        return text
    return f"{symbol_of(name)} = {text}"


def rank_of(value: Any) -> Any:
    """Place of a value in an order: words as in `WORDS`, or by the number that they begin with."""
    if not isinstance(value, str):
        return value
    known = {word: place for place, word in enumerate(WORDS)}
    leading = re.match(r"\d+", value)
    number = np.inf
    if leading:
        number = float(leading[0])
    return known.get(value, 0), number


def in_lines(name: str) -> str:
    """The name of a class beside a panel, or words in it, in lines that leave this its room."""
    return fill(name, LONGEST_NAME)
