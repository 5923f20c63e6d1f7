"""Numbers with units: what is accepted, and what it amounts to in SI."""

import json
import math
from typing import Any

import numpy as np
import pint
import pytest
import xarray as xr

from disc_model import Parameters, Ramp, Window, deflection, floquet, simulate, snapshots
from disc_model.errors import Fault
from disc_model.units import in_si
from tests.refusals import refusal
from tests.studies.refused import parse_grid


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("150 GPa", "Pa", 1.5e11),
        ("7.2 g/cm^3", "kg/m^3", 7200.0),
        ("190 rpm", "rad/s", 190 * math.pi / 30),
        ("-30 deg", "rad", -math.pi / 6),
        ("0.3 N*s/mm", "N s/m", 300.0),
        ("40 %", "1", 0.4),
        ("2 \u00b5m", "m", 2e-6),  # the sign micro
        ("2 \u03bcm", "m", 2e-6),  # the Greek letter, by which Unicode's normal form replaces it
        ("150 kN/mm²", "Pa", 1.5e11),
        ("150 kN/mm2", "Pa", 1.5e11),
        ("7.2 g/cm³", "kg/m^3", 7200.0),
        ("7200 kg m-3", "kg/m^3", 7200.0),
        ("7200 kg·m⁻³", "kg/m^3", 7200.0),
        ("0.3 N·s/mm", "N s/m", 300.0),
        ("3 rev/s", "rad/s", 6 * math.pi),
        ("190 rev/min", "rad/s", 190 * math.pi / 30),
        ("190 RPM", "rad/s", 190 * math.pi / 30),
        ("190 1/min", "rad/s", 190 * math.pi / 30),
        ("190 min⁻¹", "rad/s", 190 * math.pi / 30),
        ("90 1/min", "Hz", 1.5),
        ("0.30000000000000004 N", "N", 0.30000000000000004),
    ],
)
def test_a_number_with_a_unit_is_that_in_si(text: str, unit: str, value: float) -> None:
    converted = in_si(text, unit, [], ())
    if unit.startswith("rad"):  # pi is rounded to 15 digits
        assert converted == pytest.approx(value, rel=1e-14)
    else:  # decimals are exact
        assert converted == value


@pytest.mark.parametrize(
    ("text", "unit", "meant"),
    [
        ("100 gr", "kg", "g"),
        ("1 Ns/m", "N s/m", "N s"),
        ("1 Kg", "kg", "kg"),
        ("1 ton", "kg", "t"),
        ("30 grad", "rad", "deg"),
        ("1 Nm", "N m", "N m"),
    ],
)
def test_a_unit_that_is_another_than_it_seems_is_refused_with_what_is_meant(
    text: str, unit: str, meant: str
) -> None:
    """100 gr were 6.5 g: the grain."""
    faults: list[Fault] = []
    in_si(text, unit, faults, ("x",))
    assert [str(fault) for fault in faults] == [
        f"x='{text}': must be a number in {unit}, or with a unit of its kind, did you mean {meant}?"
    ]


@pytest.mark.parametrize("text", ["2 Hz", "2 1/s", "2 s-1", "2 kHz", "2 min"])
def test_a_speed_of_rotation_says_whether_it_counts_turns_or_radians(text: str) -> None:
    with refusal(r"Omega=.* such as rpm; Hz may mean turns or radians"):
        Parameters(N=1, Omega=text)


UNITS = pint.UnitRegistry()
SINGLE = {
    "float32": (np.float32(385), 385.0),
    "array": (np.array(385.0), 385.0),
    "whole array": (np.array(385), 385.0),
    "DataArray": (xr.DataArray(385.0), 385.0),
    "DataArray with a unit": (xr.DataArray(0.385, attrs={"units": "kN"}), 385.0),
    "quantity": (UNITS.Quantity(0.385, "kN"), 385.0),
    "quantity in SI": (UNITS.Quantity(0.1 + 0.2, "N"), 0.1 + 0.2),
}


@pytest.mark.parametrize("kind", SINGLE)
def test_a_single_number_of_another_library_is_a_number(kind: str) -> None:
    value, expected = SINGLE[kind]
    found = Parameters(N=value, Omega=15).N
    assert type(found) is float
    assert found == expected
    assert Ramp(parameter="N", to=value, start=0, end=1).to == expected


def test_units_of_other_libraries_count() -> None:
    p = Parameters(N=1, Omega=UNITS.Quantity(145, "rpm"), rho=UNITS.Quantity(7.2, "g/cm**3"))
    assert p.Omega == pytest.approx(145 * math.pi / 30, rel=1e-14)
    assert p.rho == 7200.0
    assert Parameters(N=1, Omega=xr.DataArray(9.0, attrs={"units": "rad s-1"})).Omega == 9.0
    assert Parameters(N=1, Omega=1, n_diameters=np.array(3)).n_diameters == 3
    assert Parameters(N=1, Omega=1, mu_k_over_mu_s=UNITS.Quantity(60, "percent")).mu_k == 0.24
    # a quantity, unlike a text, is in the unit that was meant: here grains
    assert Parameters(N=1, Omega=1, m=UNITS.Quantity(1e3, "gr")).m == pytest.approx(0.06479891)
    for name, wrong in (
        ("N", UNITS.Quantity(1, "m")),
        ("N", xr.DataArray(1.0, attrs={"units": "s"})),
        ("Omega", UNITS.Quantity(2, "Hz")),
    ):
        with refusal(rf"^{name}=.* or with a unit of its kind"):
            Parameters(**{"N": 1, "Omega": 1, name: wrong})
    for wrong in (np.array([1.0]), np.array(True), np.array("x"), UNITS.Quantity([1.0, 2.0], "N")):
        with refusal(r"^N=.*: must be a number"):
            Parameters(N=wrong, Omega=1)


def test_arguments_of_functions_are_such_numbers_too() -> None:
    """With float32 the check of a number ended in an OverflowError, and numpy dropped units."""
    p = Parameters(N=200, Omega=20)
    ms = UNITS.Quantity([1.0, 2.0], "ms")
    for time in (np.float32(0.25), np.array(0.25), UNITS.Quantity(250, "ms"), "250 ms"):
        assert simulate(p, time, tol=np.float16(1e-6)).t_end == 0.25
    states = snapshots(p, ms)
    assert [state.time for state in states] == [1e-3, 2e-3]
    assert [state.time for state in snapshots(p, xr.DataArray([1.0, 2.0], attrs=MS))] == [
        1e-3,
        2e-3,
    ]
    assert type(states[0].replace(psi=np.float32(0.5)).psi) is float
    at = deflection(p, states, UNITS.Quantity(10, "cm"), UNITS.Quantity(90, "deg"))
    assert at.equals(deflection(p, states, 0.1, 1.5707963267949))
    run = simulate(p, 0.01, ramps=Ramp(parameter="N", to=100, start=0, end=0.01))
    assert run.value_at("N", UNITS.Quantity(5, "ms")) == pytest.approx(150)
    with refusal(r"^times=.*: must be finite"):
        snapshots(p, UNITS.Quantity([1.0], "kg"))
    short = np.float32(1e-10)
    of_numpy = floquet(p, tol=short)
    of_python = floquet(p, tol=float(short))
    assert repr(of_numpy) == repr(of_python)


MS = {"units": "ms"}


def test_python_takes_units_everywhere() -> None:
    assert Parameters(N="0.2 kN", Omega=20, E="150 GPa").key == Parameters(N=200, Omega=20).key
    assert simulate(Parameters(N=200, Omega=20), "10 ms").t_end == 0.01
    with refusal("t_end='10 kg': must be finite, in s or as '2 min'"):
        simulate(Parameters(N=200, Omega=20), "10 kg")
    assert Window(last="30 ms", rate="2 kHz") == Window(last=0.03, rate=2000)
    assert Ramp(parameter="N", to="1 kN", start="1 min", end="2 min") == Ramp(
        parameter="N", to=1e3, start=60, end=120
    )


def grid(E: Any, h: Any, Omega: Any, **options: Any) -> dict[str, Any]:
    raw = {"study": "s", "quantity": "outcome", "base": {"N": 200, "E": E}}
    options["perturbation"] = {"u": options.pop("u")}
    return raw | {"options": options, "axes": {"Omega": Omega, "h": h}}


def test_spelling_with_units_runs_nothing_anew() -> None:
    plain = grid(
        1.5e11,
        {"start": 1e-3, "stop": 3e-3, "count": 5, "extra": [2.7e-3]},
        [10, 20],
        horizon=60,
        u=1e-4,
    )
    units = grid(
        "150 GPa",
        {"start": "1 mm", "stop": "3 mm", "count": 5, "extra": ["2.7 mm"]},
        ["10 rad/s", "20 rad/s"],
        horizon="1 min",
        u="0.1 mm",
    )
    assert parse_grid(units).batches == parse_grid(plain).batches
    samples = {"k": {"distribution": "uniform", "low": "40 N/mm", "high": "50 N/mm"}}
    raw = {"study": "s", "quantity": "sensitivity", "base": {"Omega": 15}, "axes": {"N": [200]}}
    (text,) = parse_grid(
        raw | {"options": {"distributions": samples, "samples": 2}}
    ).batches.values()
    assert json.loads(text)["options"]["distributions"]["k"]["high"] == 5e4
    curves = {
        "x_range": ["50 rpm", "100 rpm"],
        "y_lines": {"start": "0.1 kN", "stop": "0.2 kN", "count": 2},
    }
    options = parse_grid(
        {"study": "s", "quantity": "stability_curves", "options": curves, "axes": {"c": [0]}}
    ).options
    # type: ignore[attr-defined]
    assert options.y_lines.stop == 200.0
    assert round(options.x_range[0], 6) == round(50 * math.pi / 30, 6)
