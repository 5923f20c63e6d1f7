"""Numbers with units: what is accepted, and what it amounts to in SI."""

import math
from typing import Any

import numpy as np
import pint
import pytest
import xarray as xr

from disc_model import Parameters, Window, deflection, simulate, snapshots
from disc_model.units import in_si
from tests.refusals import refusal

UNITS = pint.UnitRegistry()
RPM = math.pi / 30


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [
        ("150 GPa", "Pa", 1.5e11),
        ("150 kN/mm²", "Pa", 1.5e11),
        ("7.2 g/cm^3", "kg/m^3", 7200.0),
        ("7200 kg·m⁻³", "kg/m^3", 7200.0),
        ("0.3 N*s/mm", "N s/m", 300.0),
        ("190 rpm", "rad/s", 190 * RPM),
        ("3 rev/s", "rad/s", 6 * math.pi),
        ("-30 deg", "rad", -math.pi / 6),
        ("90 1/min", "Hz", 1.5),
        ("40 %", "1", 0.4),
        ("2mm", "m", 2e-3),
        ("2 \u00b5m", "m", 2e-6),  # the sign micro
        ("2 \u03bcm", "m", 2e-6),  # the Greek letter
        ("0.30000000000000004 N", "N", 0.30000000000000004),
        ("385", "N", "385"),  # a plain number stays a text
        ("residual", "m/N", "residual"),
        ({"start": "1 mm", "count": 5}, "m", {"start": 1e-3, "count": 5}),
        (("10 rpm", 2.0), "rad/s", (10 * RPM, 2.0)),
        ({"u": "0.1 mm", "f": "1 x"}, {"u": "m"}, {"u": 1e-4, "f": "1 x"}),
        (UNITS.Quantity(0.385, "kN"), "N", 385.0),
        (UNITS.Quantity(0.1 + 0.2, "N"), "N", 0.1 + 0.2),
        (UNITS.Quantity([1.0, 2.0], "ms"), "s", [1e-3, 2e-3]),
        (xr.DataArray([60.0], attrs={"units": "rpm"}), "rad/s", [60 * RPM]),
        (xr.DataArray(9.0, attrs={"units": "rad s-1"}), "rad/s", 9.0),
    ],
)
def test_a_number_with_a_unit_is_that_in_si(value: Any, unit: Any, expected: Any) -> None:
    found = in_si(value, unit)
    assert found == (pytest.approx(expected, rel=1e-14) if "rad" in unit else expected)


@pytest.mark.parametrize(
    ("value", "unit"),
    [
        ("2 Hz", "rad/s"),
        ("2 rad/s", "Hz"),
        ("3 deg", "1"),
        ("15 ms/turn", "s"),
        ("5 kg", "N"),
        ("1 nonsense", "N"),
        ("2,5 N", "N"),
        (xr.DataArray(1.0, attrs={"units": "s"}), "N"),
    ],
)
def test_a_unit_of_another_kind_is_refused(value: Any, unit: str) -> None:
    with refusal(r"^x\.0=.*: must be a number"):
        in_si({"x": [value]}, unit)


@pytest.mark.parametrize(
    "value",
    [np.float32(385), np.array(385.0), np.array(385), xr.DataArray(385.0), "3.85e2", "0.385 kN"],
)
def test_a_single_number_of_another_library_is_a_number(value: Any) -> None:
    found = Parameters(N=value, Omega=15).N
    assert type(found) is float
    assert found == 385


@pytest.mark.parametrize(
    "value", [np.array([1.0]), np.array(True), np.array("x"), UNITS.Quantity([1.0, 2.0], "N"), True]
)
def test_what_is_no_number_is_refused(value: Any) -> None:
    with refusal(r"^N.*: must be a number"):
        Parameters(N=value, Omega=1)


def test_arguments_of_functions_may_have_units_too() -> None:
    p = Parameters(N=200, Omega="20 rad/s")
    for time in (np.float32(0.25), UNITS.Quantity(250, "ms"), "250 ms"):
        assert simulate(p, time, tol=np.float16(1e-6)).t_end == 0.25
    states = snapshots(p, UNITS.Quantity([1.0, 2.0], "ms"))
    assert [state.time for state in states] == [1e-3, 2e-3]
    at = deflection(p, states, UNITS.Quantity(10, "cm"), UNITS.Quantity(90, "deg"))
    assert at.equals(deflection(p, states, 0.1, 1.5707963267949))
    assert Window(last="30 ms", rate="2 kHz") == Window(last=0.03, rate=2000)
    with refusal("^t_end='10 kg': .* s,"):
        simulate(p, "10 kg")
