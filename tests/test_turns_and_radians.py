"""A frequency is one of turns, and what has a unit without an angle is given in none with one."""

import re
from typing import Any

import numpy as np
import pint
import pytest
import xarray as xr

import disc_model as dm
from disc_model.units import in_si, si_unit_of
from tests.refusals import refusal

OTHER = "must be a number in"


@pytest.mark.parametrize(
    ("quantity", "text", "hertz"),
    [
        ("frequency_2_0", "1850 rad/s", 1850 / (2 * np.pi)),
        ("frequency_2_0", "17640 rpm", 294.0),
        ("coupled_frequency_1", "294 rev/s", 294.0),
        ("sliding_frequency", "0.3 kHz", 300.0),
        ("frequency_0_0", "17640 1/min", 294.0),
        ("frequency_0_0", "360 deg/s", 1.0),
    ],
)
def test_a_frequency_in_angles_is_one_in_turns(quantity: str, text: str, hertz: float) -> None:
    """1850 rad/s were taken for 1850 Hz."""
    measured = dm.Measurement(quantity, text, text)
    assert measured.value == pytest.approx(hertz, rel=1e-12)
    assert measured.uncertainty == measured.value


@pytest.mark.parametrize("quantity", ["growth_rate", "sliding_growth_rate"])
@pytest.mark.parametrize("text", ["60 rpm", "1 Hz", "2 kHz", "3 rad/s"])
def test_a_growth_rate_in_turns_is_refused(quantity: str, text: str) -> None:
    with refusal(re.escape(f"value='{text}': {OTHER} 1/s")):
        dm.Measurement(quantity, text, 1.0)


def test_a_growth_rate_per_minute_has_one_meaning() -> None:
    assert dm.Measurement("growth_rate", "60 1/min", "1 1/ms").value == 1.0


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


@pytest.mark.parametrize(
    ("text", "unit"),
    [("3 mm", "m"), ("2 kHz", "Hz"), ("17 rpm", "rad/s"), ("2 %", "1"), ("3", ""), ("3 xy", "")],
)
def test_a_unit_has_an_si_unit_of_its_kind(text: str, unit: str) -> None:
    assert si_unit_of(text) == unit
