"""Numbers of single modes of a disc, such as omega_2_0, and their units."""

from __future__ import annotations

import math
import re
from typing import Any

from disc_model.errors import Fault
from disc_model.units import NUMBER, number

_MASS = {"kg^-1/2": 1.0, "1/sqrt(kg)": 1.0}
# factors from units to SI ones, of the columns of numbers of modes
_FACTORS = {
    "omega": {"Hz": math.tau, "kHz": 1e3 * math.tau, "rad/s": 1.0},
    "amplitude": _MASS,
    "damping_ratio": {"%": 0.01},
    "tangential": _MASS,
}
UNCERTAIN = tuple(_FACTORS)  # columns of numbers of modes
_SI = {"omega": "rad/s", "amplitude": "kg^-1/2", "tangential": "kg^-1/2"}
_OF_A_MODE = re.compile(rf"({'|'.join(UNCERTAIN)})_\d+_\d+")
_WITH_UNIT = re.compile(rf"\s*({NUMBER})\s*(.*?)\s*")


def column_of(name: Any) -> str:
    """What a name such as omega_2_0 is of a mode: omega; "" if it is no such name."""
    match = _OF_A_MODE.fullmatch(name) if isinstance(name, str) else None
    return match[1] if match else ""


def si_unit_of_mode(name: str) -> str:
    """The SI unit of a number of a mode by its name, "" of a share or another name."""
    return _SI.get(column_of(name), "")


def mode_number(quantity: str, value: Any) -> Any:
    """A number of a mode in SI units where it is a text, as it is where not. Raises `ValueError` for
    a unit of another kind."""
    match = _WITH_UNIT.fullmatch(value) if isinstance(value, str) else None
    if match is None or not match[2]:
        return value
    factors = _FACTORS[quantity]
    if match[2] not in factors:
        raise ValueError(f"the unit of {quantity} must be {', '.join(factors)}, not {match[2]}")
    return float(f"{float(match[1]) * factors[match[2]]:.15g}")


def mode_number_in_si(name: str, value: Any, faults: list[Fault]) -> Any:
    """The value of a number such as omega_2_0, read as `mode_number` does; what is no number is a
    fault."""
    try:
        return number(mode_number(column_of(name), value))
    except ValueError as error:
        faults.append(Fault.of((name,), value, str(error)))
        return value
