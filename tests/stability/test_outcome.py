"""Outcomes of motions whose slow departures from a cycle are extrapolated."""

import math

import numpy as np
import pytest

from disc_model.data.variables import Outcome
from disc_model.parameters import Parameters
from disc_model.stability import follower
from disc_model.stability.follower import NearCycle, cycle_of_static_start, find_outcome

pytestmark = pytest.mark.compiled
SLOW = Parameters(N=260, Omega=19)  # grows at 0.033/s and separates at 273 s


def near_start(p: Parameters) -> NearCycle:
    near = cycle_of_static_start(p)
    assert isinstance(near, NearCycle)
    return near


@pytest.mark.parametrize("latest", [60.0, 1000.0])
def test_a_departure_is_where_the_simulated_motion_is(latest: float) -> None:
    near = near_start(SLOW)
    departure = near.extrapolate(latest)
    assert departure is not None
    x, time = departure
    assert time < latest + near.cycle.period
    later = near.map.evaluate(
        near.x + near.distance,
        releases=round((time - near.time) / near.cycle.period),
        tangent=False,
    )
    assert later.returned
    # the part of the leading multiplier, since the distance rises and falls in a turn of it
    simulated = abs(near.leading @ (later.end - near.x))
    extrapolated = abs(near.leading @ (x - near.x))
    assert np.linalg.norm(x - near.x) <= follower.NEAR * near.map.deflection
    # the simulated motion has grown by what half the excess adds, of the second order in the
    # distance, which is a tenth at most
    assert simulated == pytest.approx(extrapolated, rel=0.1)


def test_the_excess_of_the_growth_rate_shifts_the_time_of_a_departure() -> None:
    """Without that first separations of many motions were late by 0.5 %."""
    p = Parameters(N=230, Omega=13)
    exact = find_outcome(p, 500.0)
    rough = find_outcome(p, 500.0, compared_with=(500.0,))
    assert rough.extrapolated
    # half of the time error of 0.44 % without the shift
    assert rough.first_separation == pytest.approx(exact.first_separation, rel=0.0022)
    assert math.isnan(rough.timed_separation)
    assert exact.timed_separation == exact.first_separation


TORUS = Parameters(
    N=600, Omega=12, D_star=1.041181e-05, k=49852.21, k_p=19510.2255, E=150.777994e9,
    m=0.1002965743, mu_s=0.36388613, mu_k=0.25421880, r_0=0.0967171342, h=0.00208291986,
)  # fmt: skip
"""The motion settles on a torus, although one that is twice as far from the cycle departs at the rate of the
multiplier again, and separates at 276 s."""
SETTLES = Parameters(N=483, Omega=15, normalization="orthonormal")
FIRST = 273.0915  # s, at which the slow one separates


@pytest.mark.parametrize(
    ("p", "horizon", "others", "outcome", "extrapolated"),
    [
        (SLOW, 500.0, (), Outcome.SEPARATION, True),
        (TORUS, 300.0, (), Outcome.GROWING, True),
        # it leaves the eigenspace within the test, and is back in it at the end
        (Parameters(N=500, Omega=14), 1000.0, (), Outcome.GROWING, True),
        # a separation near a time of comparison is simulated from the start
        (SLOW, 500.0, (0.995 * FIRST,), Outcome.SEPARATION, False),
        (SLOW, 500.0, (1.005 * FIRST,), Outcome.SEPARATION, False),
        (SLOW, 0.995 * FIRST, (), Outcome.GROWING, None),
        # so is a motion that settles: a small error decides to which attractor it comes
        (SETTLES, 500.0, (), Outcome.OTHER_CYCLE, False),
    ],
)
def test_an_extrapolated_motion_comes_to_the_same(
    p: Parameters,
    horizon: float,
    others: tuple[float, ...],
    outcome: Outcome,
    extrapolated: bool | None,
) -> None:
    exact = find_outcome(p, horizon)
    rough = find_outcome(p, horizon, compared_with=(*others, horizon))
    assert rough.outcome is exact.outcome is outcome
    assert not exact.extrapolated
    if extrapolated:
        assert rough.extrapolated
        assert rough.first_separation == pytest.approx(
            exact.first_separation, rel=follower.BORDER, nan_ok=True
        )
        assert rough.simulated < 0.9 * exact.simulated
    elif extrapolated is False:
        assert not rough.extrapolated
        assert rough.time == exact.time
        # what was extrapolated first is counted too
        assert rough.simulated > 1.2 * exact.simulated


def test_a_motion_that_is_linear_to_the_horizon_is_not_simulated() -> None:
    result = find_outcome(SLOW, 30.0, compared_with=(30.0,))
    assert result.outcome is Outcome.GROWING
    assert result.extrapolated
    assert result.simulated < 1.0  # what the shift in time leaves


def test_fast_departures_and_stable_cycles_are_not_extrapolated() -> None:
    fast = near_start(Parameters(N=450, Omega=20))
    assert fast.cycle.growth_rate > follower.SLOW_DEPARTURE
    assert fast.extrapolate(1000.0) is None
    stable = find_outcome(Parameters(N=50, Omega=15), 1000.0, compared_with=(1000.0,))
    assert stable.outcome is Outcome.STICK_SLIP
    assert not stable.extrapolated


def test_a_departure_whose_growth_rate_is_another_is_not_extrapolated() -> None:
    """Two pairs of multipliers are unstable, and neither is alone."""
    near = near_start(Parameters(N=300, Omega=11.25, k_p=4742.74741132))
    assert near.cycle.growth_rate < follower.SLOW_DEPARTURE
    assert near.extrapolate(500.0) is None


@pytest.mark.parametrize(
    ("load", "word"), [(4000, Outcome.STICK_SLIP), (6000, Outcome.OTHER_CYCLE)]
)
def test_a_quiet_motion_is_on_a_cycle_near_the_static_start(load: float, word: Outcome) -> None:
    """On a steel disc `floquet` finds an unstable cycle at both loads, and the motion is near another:
    only its distance from the static start decides, as the glossary says."""
    steel = {"E": 210e9, "rho": 7850, "nu": 0.3, "h": 6e-3, "damping_ratio": 5e-4}
    slider = {"m": 0.3, "k": 5e5, "k_p": 2e5, "c_p": 20, "mu_s": 0.45, "mu_k": 0.35}
    pad = {"contact_arc": 0.4, "friction_offset": "surface", "normalization": "orthonormal"}
    case = Parameters(N=load, Omega=10, n_diameters=6, **steel, **slider, **pad)
    near = find_outcome(case, 100).near
    assert near is not None
    assert near.kind is word
    start = near.map.first_release
    distance = np.linalg.norm(near.x - start.x) / near.map.deflection
    assert (distance <= follower.NEAR) == (word is Outcome.STICK_SLIP)
