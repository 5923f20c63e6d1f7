"""Numbers of single modes of a disc, such as omega_2_0, and their units."""

from __future__ import annotations

import math
import re
from typing import Any

from disc_model.errors import Fault, raise_faults
from disc_model.units import NUMBER, number, size_of_unit

UNCERTAIN = ("omega", "amplitude", "damping_ratio", "tangential")  # columns of numbers of modes

UNITS = {"omega": "Hz, kHz or rad/s", "amplitude": "kg^-1/2", "tangential": "kg^-1/2"}
"""Units of numbers of modes, for messages."""
OF_COLUMNS = {"omega": "rad/s", "amplitude": "kg^-1/2", "tangential": "kg^-1/2"}
"""SI units of the numbers of modes."""

_OF_A_MODE = re.compile(r"(.*)_\d+_\d+")
_WITH_UNIT = re.compile(rf"\s*({NUMBER})\s*(\S.*)?")
_PER_ROOT_MASS = {"kg^-1/2": 1.0, "kg^-0.5": 1.0, "kg**-0.5": 1.0, "1/sqrt(kg)": 1.0, "1/√kg": 1.0}


def _factor_to_si(quantity: str, unit: str) -> float:
    """Factor from a unit to the SI unit of a quantity of modes; 0 for a unit of another kind."""
    if quantity == "omega" and "hz" in unit.lower():
        return size_of_unit(unit, "Hz") * math.tau
    if quantity == "omega":
        return size_of_unit(unit, "rad/s")
    if quantity in ("amplitude", "tangential"):
        return _PER_ROOT_MASS.get(unit.replace(" ", ""), 0.0)
    return {"1": 1.0, "%": 0.01}.get(unit, 0.0)


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
    factor = _factor_to_si(quantity, unit)
    if not factor:
        units = UNITS.get(quantity, "none or %")
        raise ValueError(f"the unit of {quantity} must be {units}, not {unit}")
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
        try:
            found[name] = number(mode_number(column_of(name), value))
        except ValueError as error:
            faults.append(Fault.of((name,), value, str(error)))
    raise_faults(faults)
    return found
