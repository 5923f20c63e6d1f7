"""Numbers of single modes of a disc, such as omega_2_0, from texts with units."""

import re
from typing import Any

from disc_model.disc.files.heads import read_head
from disc_model.errors import Fault, ParameterError
from disc_model.modal_disc import UNCERTAIN
from disc_model.units import NUMBER

_OF_A_MODE = re.compile(r"(.*)_\d+_\d+")
_WITH_UNIT = re.compile(rf"\s*({NUMBER})\s*(\S.*)?")


OF_COLUMNS = {"omega": "rad/s", "amplitude": "kg^-1/2", "tangential": "kg^-1/2"}
"""SI units of the numbers of modes."""


def column_of(name: Any) -> str:
    """What a name such as omega_2_0 is of a mode: omega; "" if it is no such name."""
    match = _OF_A_MODE.fullmatch(name) if isinstance(name, str) else None
    return match[1] if match and match[1] in UNCERTAIN else ""


def unit_of_mode(name: str) -> str:
    """The SI unit of a number of a mode by its name, "" of a share or another name."""
    return OF_COLUMNS.get(column_of(name), "")


def mode_number_in_si(name: str, value: Any, faults: list[Fault]) -> Any:
    """A number of a mode in SI units where it is a text, as it is where not; a unit of another kind
    is a fault. Hz are those of a natural frequency."""
    match = _WITH_UNIT.fullmatch(value) if isinstance(value, str) else None
    if match is None:
        return value
    if not match[2]:
        return float(match[1])
    try:
        factor = read_head(f"{column_of(name)} ({match[2].strip()})").factor
    except ParameterError as error:
        faults += [Fault.of((name,), value, fault.rule) for fault in error.faults]
        return value
    return float(f"{float(match[1]) * factor:.15g}")
