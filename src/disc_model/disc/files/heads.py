"""Heads of the columns of a table of modes: the quantity that each names, and its unit.

A head is a name of this package, such as ``frequency_Hz``, or a name with its unit as laboratories
write it: "Natural frequency (kHz)", "omega [rad/s]", "damping in %".
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import NamedTuple

from disc_model.disc.files.rows import number_in
from disc_model.errors import Fault, ParameterError, suggestion
from disc_model.mode_units import UNIT_NEEDED, factor_to_si, unit_rule
from disc_model.units import NUMBER

COLUMNS = {
    "diameters": ("diameters", 1.0),
    "frequency_Hz": ("omega", math.tau),
    "omega_rad_per_s": ("omega", 1.0),
    "amplitude_per_sqrt_kg": ("amplitude", 1.0),
    "damping_ratio": ("damping_ratio", 1.0),
    "circles": ("circles", 1.0),
    "tangential_per_sqrt_kg": ("tangential", 1.0),
    "frequency_split": ("split", 1.0),
}
"""Field of a `Disc` that each column of this package's tables gives, and the factor on its values;
shapes have further columns."""

NAMES = {
    "diameters": "diameters nodal_diameters n_diameters nodal_diameter nd l",
    "circles": "circles nodal_circles n_circles nodal_circle nc",
    "omega": (
        "frequency natural_frequency eigenfrequency freq f f_n fn omega omega_n angular_frequency"
    ),
    "amplitude": "amplitude normal_amplitude axial_amplitude",
    "tangential": "tangential tangential_amplitude",
    "damping_ratio": "damping_ratio damping modal_damping zeta xi loss_factor eta",
    "split": "frequency_split split",
    "q_factor": "q q_factor quality_factor",
    "log_decrement": "log_decrement logarithmic_decrement log_dec",
    "decay_rate": "decay_rate decay_constant",
    "modal_mass": "modal_mass generalised_mass generalized_mass",
    "pole": "pole poles eigenvalue",
    "pole_real": "pole_real real_pole re_pole pole_re real_part eigenvalue_real",
    "pole_imag": "pole_imag imag_pole im_pole pole_im imaginary_part imag_part eigenvalue_imag",
}
"""Words for each quantity, in lower case with "_" between words."""
QUANTITIES: dict[str, str] = {}
for _name, _words in NAMES.items():
    QUANTITIES.update(dict.fromkeys(_words.split(), _name))
OTHER_COLUMNS = (
    "pole (rad/s)",
    "loss_factor",
    "q_factor",
    "log_decrement",
    "decay_rate (1/s)",
    "modal_mass (kg)",
    "shape_at_0.08_m",
    "comment",
)
"""Examples of further columns, for messages."""
SHORT = {"n": "diameters", "m": "modal_mass (kg)", "m_kg": "modal_mass (kg)"}
"""Symbols of laboratories, in lower case, that may stand for something else too: what they may
mean, for messages."""
LOSS_FACTORS = ("loss_factor", "eta")  # twice the damping ratio

_SHAPE_AT = re.compile(r"shape[ _]+at[ _]+(\d*\.?\d+(?:e-?\d+)?)[ _]*([a-zµμ]*m)", re.IGNORECASE)
_BRACKETS = re.compile(r"(.*?)\s*(?:\((.*)\)|\[(.*)\])")
_WORD_IN = re.compile(r"(.*?)\s+in\s+(\S.*)")
_CELL = re.compile(rf"({NUMBER})\s*([%A-Za-zµ].*)")
_PER_METRE = {"m": 1.0, "mm": 1e3, "cm": 1e2}


class Head(NamedTuple):
    """A column: its head as it is written, its quantity, the factor to SI units (rad/s, kg^-1/2,
    1), and the radius in m if it is a shape."""

    text: str
    quantity: str
    factor: float
    radius: float = math.nan


def read_head(text: str) -> Head:
    """Read the head of a column; raises `ParameterError` if its name or unit is not known."""
    if text in COLUMNS:
        quantity, factor = COLUMNS[text]
        return Head(text, quantity, factor)
    name, unit = _name_and_unit(text)
    if match := _SHAPE_AT.fullmatch(name):
        return _shape(text, match, unit)
    word, unit = _word(name, unit)
    if not word:
        rule = f"unknown column{_meant(text, name)}"
        raise ParameterError(Fault.of(("columns",), text, rule))
    factor = _factor(text, QUANTITIES[word], unit)
    if word in LOSS_FACTORS:
        factor /= 2
    return Head(text, QUANTITIES[word], factor)


def _meant(text: str, name: str) -> str:
    """What the head of an unknown column may mean, by the name in it, and the known heads."""
    known = [*COLUMNS, *OTHER_COLUMNS]
    if name.lower() in SHORT:
        return f", did you mean {SHORT[name.lower()]}? (known: {', '.join(known)})"
    return suggestion(text, known)


def with_unit(text: str, unit: str) -> str:
    """A head with a unit that stands in a row of its own, in brackets or not; as it is if the head
    states one."""
    if match := _BRACKETS.fullmatch(unit):
        before, round_brackets, square_brackets = match.groups()
        unit = unit if before else (round_brackets or square_brackets or "")
    if text in COLUMNS or unit in ("", "-"):
        return text
    _, stated = _word(*_name_and_unit(text))
    return text if stated else f"{text} ({unit})"


def with_units_of_cells(
    names: list[str], body: list[list[str]]
) -> tuple[list[str], list[list[str]]]:
    """Heads with the units that cells of their columns have, and cells without these, all in the
    unit of their head."""
    found = [*names]
    cells = [[*row] for row in body]
    for i, name in enumerate(names):
        texts = [row[i] if i < len(row) else "" for row in body]
        found[i], numbers = _in_one_unit(name, texts)
        for row, number in zip(cells, numbers, strict=True):
            if i < len(row):
                row[i] = number
    return found, cells


def _in_one_unit(name: str, texts: Sequence[str]) -> tuple[str, Sequence[str]]:
    """A head with the first unit that is in its cells, and the cells in that unit; both as they are
    if no cell has a unit, or one has none that fits the head."""
    matches = [_CELL.fullmatch(text) for text in texts]
    units = [match[2] if match else "" for match in matches]
    if not any(units):
        return name, texts
    heads = [_with_unit_of_cells(name, unit) for unit in units]
    factors = [*map(_known_factor, heads)]
    if any(map(math.isnan, factors)):
        return name, texts
    first = next(i for i, unit in enumerate(units) if unit)
    numbers = []
    for match, text, factor in zip(matches, texts, factors, strict=True):
        number = match[1] if match else text
        numbers.append(_times(number, factor / factors[first]))
    return heads[first], numbers


def _times(number: str, factor: float) -> str:
    """The text of a number times a factor; other text as it is."""
    value = number_in(number, factor)
    return number if factor == 1 or isinstance(value, str) else repr(value)


def _with_unit_of_cells(name: str, unit: str) -> str:
    """The head of a column for a cell that has a unit, or none; "" if the head states another one."""
    if not unit:
        return name
    stated = f"{name} ({unit})"
    if not math.isnan(_known_factor(stated)):
        return stated
    word, _ = _word(*_name_and_unit(name))
    is_same = word != "" and _known_factor(f"{word} ({unit})") == _known_factor(name)
    return name if is_same else ""


def _known_factor(text: str) -> float:
    """The factor of a head to SI units; nan if the head is not known."""
    try:
        return read_head(text).factor
    except ParameterError:
        return math.nan


def _name_and_unit(text: str) -> tuple[str, str]:
    """The name in a head, and its unit in brackets or after the word in."""
    if match := _BRACKETS.fullmatch(text):
        name, round_brackets, square_brackets = match.groups()
        return name, (round_brackets or square_brackets or "").strip()
    if match := _WORD_IN.fullmatch(text):
        return match[1], match[2].strip()
    return text, ""


def _shape(text: str, match: re.Match[str], unit: str) -> Head:
    """A column with the displacement of the shapes at a radius."""
    length = match[2].lower()
    if length not in _PER_METRE:
        raise ParameterError(Fault.of(("columns",), text, "must give the radius in m, cm or mm"))
    factor = _factor(text, "amplitude", unit or "kg^-1/2")
    radius = float(match[1]) / _PER_METRE[length]
    return Head(text, "shape", factor, radius)


def _word(name: str, unit: str) -> tuple[str, str]:
    """The word of `QUANTITIES` in a name, "" if there is none, and the unit, which may end the
    name: frequency_kHz."""
    words = re.sub(r"[\s_-]+", "_", name.strip())
    if words.lower() in QUANTITIES:
        return words.lower(), unit
    parts = words.split("_")
    for count in range(len(parts) - 1, 0, -1):
        word = "_".join(parts[:count]).lower()
        if word in QUANTITIES and not unit:
            return word, "_".join(parts[count:])
    return "", unit


def _factor(text: str, quantity: str, unit: str) -> float:
    """Factor from the unit of a head to the SI unit of its quantity."""
    units, examples = UNIT_NEEDED.get(quantity, ("", ""))
    if not unit and examples:
        rule = f"must give its unit, {units}, as in {examples}"
        raise ParameterError(Fault.of(("columns",), text, rule))
    factor = factor_to_si(quantity, unit)
    if math.isnan(factor):
        raise ParameterError(Fault.of(("columns",), text, unit_rule(quantity, unit)))
    return factor
