"""Numbers of single modes of a disc, such as omega_2_0, and their units."""

from __future__ import annotations

import math
import re
from typing import Any

from disc_model.errors import Fault, raise_faults
from disc_model.units import NUMBER, number, size_of_unit

UNCERTAIN = ("omega", "amplitude", "damping_ratio", "tangential")  # columns of numbers of modes
POLES = ("pole", "pole_real", "pole_imag")  # quantities that stand for frequency and damping

UNIT_NEEDED = {
    "omega": ("Hz, kHz or rad/s", "frequency_Hz or frequency (Hz)"),
    "pole": ("rad/s or Hz", "pole (rad/s)"),
    "pole_real": ("1/s, rad/s or Hz", "pole real (1/s)"),
    "pole_imag": ("rad/s or Hz", "pole imag (rad/s)"),
    "decay_rate": ("1/s or rad/s", "decay_rate (1/s)"),
    "modal_mass": ("kg", "modal_mass (kg)"),
    "amplitude": ("kg^-1/2", "amplitude_per_sqrt_kg or amplitude (kg^-1/2)"),
    "tangential": ("kg^-1/2", "tangential_per_sqrt_kg or tangential (kg^-1/2)"),
}
"""Quantities whose heads must state a unit: which, and examples."""
OF_COLUMNS = {"omega": "rad/s", "amplitude": "kg^-1/2", "tangential": "kg^-1/2"}
"""SI units of the numbers of modes."""

_OF_A_MODE = re.compile(r"(.*)_\d+_\d+")
_WITH_UNIT = re.compile(rf"\s*({NUMBER})\s*(\S.*)?")
_ROOT = re.compile(r"(?:1/|/|m/)sqrt\(?([A-Za-z]+)\)?|([A-Za-z]+)\^\(?-(?:1/2|0?\.5)\)?")


# ---- Factors of units


def factor_to_si(quantity: str, unit: str) -> float:
    """Factor from a unit to the SI unit of a quantity of modes; nan for a unit of another kind."""
    plain = unit.replace("_per_", "/").replace("per_", "1/").replace("sqrt_", "sqrt ")
    if quantity in ("omega", "decay_rate", *POLES):
        return _rate(plain, quantity)
    if quantity == "modal_mass":
        return _converted(plain, "kg")
    if quantity in ("amplitude", "tangential"):
        return _per_root_mass(plain)
    return _share(plain, quantity)


def unit_rule(quantity: str, unit: str) -> str:
    """The rule that a unit of another kind breaks."""
    units, _ = UNIT_NEEDED.get(quantity, ("none or %", ""))
    return f"the unit of {quantity} must be {units}, not {unit}"


def _rate(unit: str, quantity: str) -> float:
    """Factor to rad/s; nan for other units. The real part of a pole in 1/s is in rad/s, and a decay
    rate in Hz may mean turns."""
    if quantity == "decay_rate":
        return 1.0 if unit.lower() == "rad/s" else _converted(unit, "1/s")
    known = {"hz": math.tau, "khz": 1e3 * math.tau, "rad/s": 1.0}
    if quantity == "pole_real":
        known["1/s"] = 1.0
    if unit.lower() in known:
        return known[unit.lower()]
    if "hz" in unit.lower():
        return _converted(unit, "Hz") * math.tau
    return _converted(unit, "rad/s")


def _per_root_mass(unit: str) -> float:
    """Factor to kg^-1/2 from texts such as kg^-0.5, 1/sqrt(kg) and t^-1/2; nan for other units."""
    text = unit.replace(" ", "").replace("**", "^").replace("√", "sqrt")
    match = _ROOT.fullmatch(text)
    if match is None:
        return math.nan
    mass = match[1] or match[2]
    if mass == "kg":
        return 1.0
    return _converted(mass, "kg") ** -0.5


def _share(unit: str, quantity: str) -> float:
    """Factor to a ratio or a count without unit; nan for other units."""
    if unit in ("", "-", "1"):
        share = 1.0
    elif unit in ("%", "percent", "per cent") and quantity in ("damping_ratio", "split"):
        share = 0.01
    else:
        share = math.nan
    return share


def _converted(unit: str, target: str) -> float:
    """One of a unit in another one; nan if it is not of its kind."""
    return size_of_unit(unit, target) or math.nan


# ---- Numbers


def column_of(name: Any) -> str:
    """What a name such as omega_2_0 is of a mode: omega; "" if it is no such name."""
    match = _OF_A_MODE.fullmatch(name) if isinstance(name, str) else None
    return match[1] if match and match[1] in UNCERTAIN else ""


def si_unit_of_mode(name: str) -> str:
    """The SI unit of a number of a mode by its name, "" of a share or another name."""
    return OF_COLUMNS.get(column_of(name), "")


def mode_number(quantity: str, value: Any) -> Any:
    """A number of a mode in SI units where it is a text, as it is where not. Hz are those of a
    natural frequency. Raises `ValueError` for a unit of another kind."""
    match = _WITH_UNIT.fullmatch(value) if isinstance(value, str) else None
    if match is None:
        return value
    if not match[2]:
        return float(match[1])
    unit = match[2].strip()
    factor = factor_to_si(quantity, unit)
    if math.isnan(factor):
        raise ValueError(unit_rule(quantity, unit))
    return float(f"{float(match[1]) * factor:.15g}")


def mode_number_in_si(name: str, value: Any, faults: list[Fault]) -> Any:
    """The value of a number such as omega_2_0, read as `mode_number` does; a unit of another kind
    is a fault."""
    try:
        return mode_number(column_of(name), value)
    except ValueError as error:
        faults.append(Fault.of((name,), value, str(error)))
        return value


def mode_numbers(values: dict[str, Any]) -> dict[str, float]:
    """The values of several such numbers, by their names. Raises `ParameterError` for what is no
    number."""
    faults: list[Fault] = []
    found = {}
    for name, value in values.items():
        read = mode_number_in_si(name, value, faults)
        try:
            found[name] = number(read)
        except ValueError as error:
            if not faults or faults[-1].path != (name,):
                faults.append(Fault.of((name,), value, str(error)))
    raise_faults(faults)
    return found
