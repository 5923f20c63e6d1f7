"""Numbers of modes, splits, pushes and measured functions may be texts with units, as parameters may."""

import math
import re
from typing import Any

import pytest

import disc_model as dm
from tests.refusals import refusal

MODES: dict[str, Any] = {"diameters": [0, 2], "omega": [5837.0, 7615.0], "amplitude": [0.43, 0.54]}
DISC = dm.Disc(**MODES, damping_ratio=[1e-3, 1e-3])
CASE = dm.Parameters(N=385, Omega=14, disc=DISC, r_0=0.1)


def test_a_disc_takes_texts_with_units() -> None:
    """They were refused."""
    disc = dm.Disc(
        diameters=[0, 2],
        omega=["929 Hz", "1.212 kHz"],
        amplitude=["0.43 kg^-1/2", "0.54"],
        damping_ratio=["0.1 %", "0.1 %"],
        tangential=[0, "-0.13 1/sqrt(kg)"],
        static_compliance="42 nm/N",
        radii=["80 mm", "0.1 m"],
        shapes=[[0.3, 0.43], [0.4, 0.54]],
    )
    assert disc.omega == pytest.approx((929 * math.tau, 1212 * math.tau))
    assert disc.amplitude == (0.43, 0.54)
    assert disc.damping_ratio == (1e-3, 1e-3)
    assert disc.tangential == (0.0, -0.13)
    assert disc.static_compliance == pytest.approx(42e-9)
    assert disc.radii == (0.08, 0.1)


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("omega_2_0", "1.2 kHz", 1200 * math.tau),
        ("omega_2_0", "7600", 7600.0),
        ("damping_ratio_2_0", "0.2 %", 0.002),
        ("amplitude_0_0", "0.5 1/sqrt(kg)", 0.5),
    ],
)
def test_a_changed_copy_takes_texts_with_units(name: str, text: str, value: float) -> None:
    assert CASE.replace(**{name: text}).numbers[name] == pytest.approx(value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"omega_2_0": "5 kg"}, "omega_2_0='5 kg': the unit of omega must be Hz, kHz, rad/s"),
        ({"omega_2_0": "fast"}, "omega_2_0='fast': must be a number"),
        ({"amplitude_0_0": "3 m"}, "amplitude_0_0='3 m': the unit of amplitude must be kg^-1/2"),
    ],
)
def test_texts_of_other_kinds_are_refused(changes: dict[str, str], message: str) -> None:
    with refusal(re.escape(message)):
        CASE.replace(**changes)


def test_a_disc_names_the_row_of_another_kind() -> None:
    with refusal(re.escape("omega.1='5 kg': the unit of omega must be Hz")):
        dm.Disc(diameters=[0, 2], omega=[5837, "5 kg"], amplitude=[0.4, 0.5])
