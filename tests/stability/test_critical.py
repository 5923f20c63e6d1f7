"""Values of a parameter at which stability changes."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import disc_model as dm
from disc_model.data.variables import STABLE_CYCLES
from tests.refusals import refusal

ORTHONORMAL = {"normalization": "orthonormal"}
WINDOWS = {  # a case, what is searched, and within bounds the places of changes of stability
    # Neimark-Sacker points of `continue_cycle`: two stable stretches a hundredth of the range wide
    "tongues": (
        {"N": 302, "Omega": 11.3, "friction_offset": "surface", **ORTHONORMAL},
        ("N", (260, 400), 6),
        (260, 400),
        [274.843534, 276.503088, 370.465968, 371.635283],
        0,
    ),
    # by `floquet` stable at 267.5 N, on another cycle from there, and stable from 273.5 N on
    "jump": (
        {"N": 330, "Omega": 11.7, **ORTHONORMAL},
        ("N", (150, 650), 201),
        (260, 280),
        [267.9948, 273.3199],
        1,
    ),
    # a pair passes through 1 and comes back: its angle has the same sign at both ends
    "touch": (
        {"N": 182.84010057915575, "Omega": 9.219889478738258, **ORTHONORMAL},
        ("k_p", (10_100, 10_300), 3),
        (10_100, 10_300),
        [10_232.6, 10_234.9],
        1,
    ),
    "fold": ({"N": 385, "Omega": 12}, ("Omega", (14, 16), 5), (14, 16), [15.094912], 0),
}


@pytest.mark.compiled
@pytest.mark.parametrize("name", WINDOWS)
def test_windows_narrower_than_a_step_are_seen(name: str) -> None:
    case, (along, bounds, points), (low, high), places, jumps = WINDOWS[name]
    p = dm.Parameters(**case)
    found = dm.critical(p, along, bounds, points=points)
    seen = (found.crossings > low) & (found.crossings < high)
    assert_allclose(found.crossings[seen], places, rtol=1e-4 if jumps else 2e-6)
    assert ((found.jumps > low) & (found.jumps < high)).sum() == jumps
    assert ("to another cycle" in found.message) == bool(jumps)
    apart = 2e-6 * (bounds[1] - bounds[0])
    for crossing, unstable in zip(found.crossings, found.unstable_above, strict=True):
        sides = [dm.floquet(p.replace(**{along: float(crossing + x)})) for x in (-apart, apart)]
        assert [side.motion in STABLE_CYCLES for side in sides] == [unstable, not unstable]
    assert found.resolution == np.diff(found.values).max()


@pytest.mark.compiled
def test_steady_sliding_in_the_place_of_a_cycle_is_told() -> None:
    """A damper in the plane ends the cycle: steady sliding takes its place, and grows."""
    case = dm.Parameters(N=385, Omega=16)
    damped = dm.critical(case, "c_p", (0, "120 N s/m"), points=7)
    assert "steady sliding is unstable, without a cycle" in damped.message
    place = damped.values.tolist().index(40.0)
    sliding = dm.steady_sliding(case.replace(c_p=40.0))
    assert damped.sliding_growth_rate[place] == sliding.growth_rate
    assert math.isnan(damped.growth_rate[place])
    assert math.isnan(damped.sliding_growth_rate[0])


@pytest.mark.compiled
def test_critical_values_are_data(tmp_path: Path) -> None:
    found = dm.critical(dm.Parameters(N=385, Omega=12), "Omega", ("14 rad/s", 16), points=5)
    assert "unstable from Omega = 15.0949 rad/s" in repr(found)
    dm.save(found, tmp_path / "critical.nc")
    data = dm.load(tmp_path / "critical.nc")
    assert data.identical(found.to_dataset())
    assert data["growth_rate"].dims == ("Omega",)
    assert data["value"].attrs["units"] == data["Omega"].attrs["units"] == "rad s-1"
    assert data["crossings"].values.tolist() == found.crossings.tolist()

    case = dm.Parameters(N=385, Omega=15)
    bounds = {"name": "Omega", "bounds": (15.2, 16), "points": 3}
    swept = dm.sweep(dm.critical, case, N=[385.0, 400.0], **bounds)
    expected = "already unstable at the lower bound, Omega = 15.2 rad/s"
    assert swept["message"].values[0] == expected
    assert swept["value"].values[0] == 15.2
    assert swept["at_lower_bound"].values.tolist() == [True, False]
    assert swept["border"].attrs["units"] == "rad s-1"


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"bounds": ("5 kg", 15)}, r"^bounds\.0='5 kg': must be a number in rad/s"),
        ({"name": "mu_s", "bounds": (0.1, 0.9)}, r"^mu_k=0\.24: must be <= mu_s=0\.1$"),
        ({"points": 1}, "points=1"),
    ],
)
def test_wrong_arguments_are_refused(changed: dict[str, Any], told: str) -> None:
    asked = {"name": "Omega", "bounds": (14, 16), **changed}
    with refusal(told):
        dm.critical(dm.Parameters(N=385, Omega=14.95), **asked)


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize("name", ["N", "Omega", "k", "mu_k"])
def test_no_window_of_two_quarters_of_a_step_is_overlooked(name: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    case = {"N": rng.uniform(200, 500), "Omega": rng.uniform(9, 18), "mu_k": rng.uniform(0.2, 0.3)}
    modes = str(rng.choice(["as_published", "orthonormal"]))
    p = dm.Parameters(**case, normalization=modes)
    bounds = {"N": (150, 650), "Omega": (8, 20), "k": (15e3, 75e3), "mu_k": (0.15, 0.35)}[name]
    found = dm.critical(p, name, bounds, points=51)
    values = np.linspace(*bounds, 201)
    motions = [dm.floquet(p.replace(**{name: value})).motion for value in values.tolist()]
    overlooked = np.array([motion not in STABLE_CYCLES for motion in motions])
    for low, high in found.unstable:
        overlooked &= (values < low) | (values > high)
    for start in np.flatnonzero(overlooked[:-2] & overlooked[1:-1] & overlooked[2:]):
        nearby = np.abs(found.jumps - values[start]) < values[4] - values[0]
        assert nearby.any(), (p, name, values[start])
