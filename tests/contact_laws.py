"""The laws of contact beside the paper's, as tests name them; and what of them is left to the long
tests."""

import math
from typing import Any

import numba
import numpy as np
import pytest

from disc_model import Ramp
from tests.references import taylor

LAWS: dict[str, dict[str, Any]] = {
    "compliant": {"contact_compliance": taylor.COMPLIANCE},
    "normal": {"contact_force": "normal"},
    "compliant_normal": {"contact_compliance": taylor.COMPLIANCE, "contact_force": "normal"},
}

COUPLE: dict[str, Any] = {"friction_offset": 0.02}
"""Ten times the plate's thickness, so that the couple shows at once."""
COUPLED = {f"{name or 'vertical'}_coupled": law | COUPLE for name, law in {"": {}, **LAWS}.items()}
"""Each law with friction above the middle plane."""

FALLING = {
    f"{name or 'vertical'}_falling": law | {"friction_decay": 2.0}
    for name, law in {"": {}, **LAWS}.items()
}
FALLING["compliant_normal_falling"] |= COUPLE
FALLING["vertical_coupled_falling"] = FALLING["vertical_falling"] | COUPLE
EXPONENTIAL: dict[str, Any] = {"friction_decay": 2.0, "friction_law": "exponential"}
VISCOUS: dict[str, Any] = {"viscous_friction": 0.005}
FALLING |= {
    "vertical_viscous": VISCOUS,
    "vertical_falling_viscous": FALLING["vertical_falling"] | VISCOUS,
    "vertical_exponential": EXPONENTIAL | VISCOUS,
    "normal_exponential": LAWS["normal"] | EXPONENTIAL,
    "compliant_normal_exponential": LAWS["compliant_normal"] | EXPONENTIAL | VISCOUS | COUPLE,
    "vertical_coupled_exponential": EXPONENTIAL | VISCOUS | COUPLE,
}
"""Each law with friction that depends on the speed, some of them with the couple."""
ALL_LAWS = LAWS | COUPLED | FALLING

if numba.config.DISABLE_JIT:
    COMPILES = ()
else:
    COMPILES = (pytest.mark.slow,)
"""Marks of what has kernels of its own, which compile for a minute; without compilation it is quick."""


def by_series(p):
    """A ramp of one unit in the last place of N: on ramps stick is followed by its series, and not
    in closed form."""
    return Ramp(parameter="N", to=math.nextafter(p.N, math.inf), start=0.0, end=1e3)


def course_of(p, ramps):
    """Corners of Omega and N on ramps, (time, Omega, N), from 0 on."""
    lines = {name: ([0.0], [getattr(p, name)]) for name in ("Omega", "N")}
    for ramp in ramps:
        times, values = lines[ramp.parameter]
        lines[ramp.parameter] = [*times, ramp.start, ramp.end], [*values, values[-1], ramp.to]
    corners = sorted({time for times, _ in lines.values() for time in times})
    return [(t, *(float(np.interp(t, *line)) for line in lines.values())) for t in corners]


def turned(course, t):
    """Angle, rad, by which the drive has turned since the time 0."""
    times, speeds, _ = zip(*course, strict=True)
    corners = [*(time for time in times if time < t), t]
    return np.trapezoid(np.interp(corners, times, speeds), corners)
