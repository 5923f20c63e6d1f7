"""A frequency is one of turns, and what has a unit without an angle is given in none with one."""

from typing import Any

import numpy as np
import pint
import pytest
import xarray as xr

from disc_model.units import in_si

OTHER = "must be a number in"


@pytest.mark.parametrize(("text", "unit"), [("3 deg", "1"), ("15 ms/turn", "s"), ("1 rad", "1")])
def test_an_angle_stands_for_no_plain_number(text: str, unit: str) -> None:
    faults: list[Any] = []
    in_si(text, unit, faults, ("x",))
    assert len(faults) == 1


def test_quantities_and_arrays_with_units_are_read_alike() -> None:
    units = pint.UnitRegistry()
    assert in_si(units.Quantity(60, "rpm"), "Hz", [], ()) == 1.0
    marked = xr.DataArray([60.0, 120.0], attrs={"units": "rpm"})
    assert np.asarray(in_si(marked, "Hz", [], ())) == pytest.approx([1.0, 2.0])
