"""Numbers with units: what is accepted, and what it amounts to in SI."""

import json
import math
from typing import Any

import pytest

from disc_model import ParameterError, Parameters, Ramp, Window, simulate
from disc_model.units import in_si
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
    ],
)
def test_a_number_with_a_unit_is_that_in_si(text: str, unit: str, value: float) -> None:
    # decimals are exact; pi is rounded to 15 digits
    converted = in_si(text, unit, [], ())
    assert converted == (
        pytest.approx(value, rel=1e-14) if "rpm" in text or "deg" in text else value
    )


def test_python_takes_units_everywhere() -> None:
    assert Parameters(N="0.2 kN", Omega=20, E="150 GPa").key == Parameters(N=200, Omega=20).key
    assert simulate(Parameters(N=200, Omega=20), "10 ms").t_end == 0.01
    with pytest.raises(ParameterError, match="t_end='10 kg': must be finite, in s or as '2 min'"):
        simulate(Parameters(N=200, Omega=20), "10 kg")
    assert Window(last="30 ms", rate="2 kHz") == Window(last=0.03, rate=2000)
    assert Ramp(parameter="N", to="1 kN", start="1 min", end="2 min") == Ramp(
        parameter="N", to=1e3, start=60, end=120
    )


def grid(E: Any, h: Any, Omega: Any, **options: Any) -> dict[str, Any]:
    raw = {"study": "s", "quantity": "outcome", "base": {"N": 200, "E": E}}
    raw |= {"starts": {"k": {"perturbation": {"u": options.pop("u")}}}, "options": options}
    return raw | {"axes": {"Omega": Omega, "h": h, "start": ["static", "k"]}}


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
    assert (options.y_lines.stop, round(options.x_range[0], 6)) == (
        200.0,
        round(50 * math.pi / 30, 6),
    )  # type: ignore[attr-defined]
