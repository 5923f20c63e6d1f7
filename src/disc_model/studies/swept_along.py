"""Sweeps up and down along any number of a case, as `hysteresis` makes them: what they need before, and
what their variables are called."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from disc_model.data.swept_speeds import SPEED, edges_along
from disc_model.data.variables import OF_QUANTITIES, attributes_of_number, unit_of_parameter
from disc_model.errors import Fault, raise_faults, require
from disc_model.parameters import foreign_case
from disc_model.simulation.states import mode_arrays
from disc_model.stability.continuation import free_faults, values_in_si


def scan_along(case: Any, name: Any, bounds: Any, step: Any) -> dict[str, Any]:
    """The range of a sweep along a number of a case, in SI units; raises `ParameterError` where a value at
    its bounds makes no case, or other modes, in which no motion goes on."""
    require(
        (np.shape(bounds) == (2,), "bounds", bounds, "must be the lowest and the highest value")
    )
    faults: list[Fault] = []
    ends = values_in_si(name, bounds, faults, "bounds")
    [length] = values_in_si(name, [step], faults, "step")
    raise_faults(foreign_case(case) or [*free_faults(case, [name]), *faults])
    low, high = (mode_arrays(case.replace(**{name: end})).psi for end in ends)
    same = low.shape == high.shape and np.allclose(low, high, rtol=1e-9)
    require((same, "name", name, "must be a number that does not change the shapes of the modes"))
    return {"start": ends[0], "stop": ends[1], "step": length}


def unit_along(name: str) -> str:
    """The unit of values along a sweep with the space before, as texts have it."""
    return f" {unit_of_parameter(name)}".rstrip()


def value_along(name: str, value: str) -> str:
    """A value along a sweep with its unit, and with the name of what is swept unless that is the
    speed."""
    shown = f"{value}{unit_along(name)}"
    return shown if name == SPEED else f"{name} = {shown}"


def named_along(sweep: xr.Dataset, name: str) -> xr.Dataset:
    """A sweep along another number than the speed, with its values under the name of that number."""
    along = f"sweep_{name}"
    onset, end = edges_along(name)
    onset_speed, end_speed = edges_along(SPEED)
    renamed = sweep.rename({f"sweep_{SPEED}": along, onset_speed: onset, end_speed: end})
    number = attributes_of_number(name)
    renamed[along].attrs = {**number, "parameter": name}
    for edge in (onset, end):
        known = OF_QUANTITIES["hysteresis"]["added"][edge]
        renamed[edge].attrs = {"units": number.get("units", "1"), **known.texts()}
    return renamed
