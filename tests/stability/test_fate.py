"""What becomes of the published start: multipliers against simulation."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.stats import qmc

from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Record
from disc_model.stability import fate as module
from disc_model.stability.fate import Near, fate, published_start_near
from disc_model.stability.settling import follow

pytestmark = pytest.mark.compiled


@pytest.mark.parametrize(
    ("N", "Omega", "outcome", "rate"), [(50, 15, "stable", -0.0083), (100, 20, "unstable", 0.0008)]
)
def test_where_multipliers_tell_nothing_is_simulated(N: float, Omega: float, outcome: str, rate: float) -> None:
    """A stable cycle keeps the start, and slow growth goes on until the horizon; rates of docs/model.md."""
    found = fate(Parameters(N=N, Omega=Omega), 1000)
    assert (found.outcome, found.simulated) == (outcome, 0.0)
    assert found.cycle is not None
    assert found.cycle.growth_rate == pytest.approx(rate, abs=3e-4)


def test_a_departure_by_multipliers_ends_as_the_simulated_one() -> None:
    p = Parameters(N=300, Omega=20)
    found = fate(p, 400)
    whole = simulate(p, 400, record=Record(events=False), stop_at="first_separation").first_separation
    assert found.outcome == "separation"
    # a tenth of the distance (AGREES) is a growth of ln(1.1) / 0.046 s = 2 s
    assert found.first_separation == pytest.approx(whole, abs=2)
    assert found.simulated < 0.6 * whole


def test_a_departure_is_followed_where_its_phase_drifts() -> None:
    """Long before growth changes, the frequency does: the amplitude of the leading part alone is asked for."""
    p = Parameters(N=200, Omega=13.4375)
    found, early = fate(p, 1000), fate(p, 1000, furthest=0.005)
    assert found.departed is not None
    assert found.simulated < 0.7 * early.simulated
    # the rate is taken to within a quarter (DEPARTS), and the cubic term of that is corrected for
    assert found.first_separation == pytest.approx(early.first_separation, abs=0.25 / found.departed.growth_rate)


REST = {
    # there since 220 s; the contact force stays within 9 % of the preload
    "a motion on a torus is followed to the horizon": (516.666666667, 12.734375, "unstable"),
    # told of a fifth of the static deflection, multipliers lead past the torus on which the motion stays
    "a departure is not followed as far as another attractor": (541.666666667, 11.328125, "unstable"),
    # the contact force ranges over a third of the preload from about 200 s on, for minutes; then it separates. How much
    # later turns on roundings: between 190 s and 610 s were seen. To call its growth saturated was wrong.
    "a torus that is unstable": (550, 12.7, "separation"),
    "another one": (516.666666667, 12.03125, "separation"),
    # at 96 % of the preload, and 1 % more in 20 s: it separates at 847 s, and is not left before
    "a slow rise": (216.666666667, 11.328125, "separation"),
}


@pytest.mark.parametrize("which", REST)
def test_what_looks_like_rest_is_followed(which: str) -> None:
    N, Omega, outcome = REST[which]
    found = fate(Parameters(N=N, Omega=Omega), 1000)
    assert found.outcome == outcome
    assert found.state is not None
    assert found.state.time == (1000 if outcome == "unstable" else found.first_separation)
    assert found.state.time > 150


def test_without_a_cycle_the_motion_is_simulated_from_its_start() -> None:
    p = Parameters(N=385, Omega=15.1)
    assert not isinstance(published_start_near(p), Near)
    found = fate(p, 100)
    assert (found.outcome, found.cycle) == ("separation", None)
    assert found.first_separation == pytest.approx(54.4189, abs=1e-3)  # docs/model.md
    assert found.simulated == pytest.approx(found.first_separation, abs=1e-9)


def test_steady_sliding_is_known_by_its_eigenvalues() -> None:
    found = fate(Parameters(N=50, Omega=15, c_p=0.5), 1000)
    assert (found.outcome, found.sliding, found.cycle) == ("stable", True, None)
    assert found.simulated < 50


def test_a_start_far_from_a_cycle_follows_it_once_it_has_come_near() -> None:
    """Beside the fold the motion from the start is not linear: its size tells."""
    p = Parameters(N=385, Omega=15)
    near = published_start_near(p)
    assert isinstance(near, Near)
    at = near.map.static
    assert not module.follows(near, at)
    assert near.own
    assert 1 < near.waited < 20
    # the distance is the one that is left by then
    count = round(near.waited / near.cycle.period)
    *_, later = near.map.returns(at, count)
    assert np.linalg.norm(later - near.x - near.distance) < 1e-6 * np.linalg.norm(at)


def test_a_start_that_comes_to_another_cycle_does_not_follow_the_one_nearby() -> None:
    """Newton's method finds an unstable cycle here; the motion comes to a stable one of another period."""
    p = Parameters(N=450, Omega=12.03125, normalization="orthonormal")
    near = published_start_near(p)
    assert isinstance(near, Near)
    assert not near.own
    assert not near.cycle.stable
    found = fate(p, 1000)
    assert found.outcome == "stable"
    assert found.cycle is not None
    assert found.cycle.period != pytest.approx(near.cycle.period, rel=1e-3)


def test_the_leading_part_of_a_distance_grows_by_its_multiplier() -> None:
    near = published_start_near(Parameters(N=200, Omega=20))
    leading = module._left_vector(near.jacobian)
    part, later = leading @ near.distance, leading @ (near.jacobian @ near.distance)
    assert abs(later / part) == pytest.approx(abs(near.cycle.multipliers[0]), rel=1e-9)


PLANES = (
    {"N": (50, 600), "Omega": (5, 50)},
    {"N": (50, 600), "Omega": (5, 50), "normalization": "orthonormal"},
    {"N": 300, "Omega": (5, 50), "k_p": (5e3, 1e5)},
    {"Omega": 15, "N": (50, 600), "c_p": (0, 1)},
)
MOST_WRONG = 0.05
"""Share of points at which shortcut and simulation may disagree: those where the outcome hangs on the last digit of a
long motion. At the 1304 points of the former coarse maps there was none."""


@pytest.mark.slow
def test_shortcuts_agree_with_brute_force() -> None:
    """Points spread over four planes: simulated throughout, to a horizon at which all outcomes occur."""
    horizon, disagree, points, simulated = 400.0, [], 0, 0.0
    for number, plane in enumerate(PLANES):
        varied = {name: bounds for name, bounds in plane.items() if isinstance(bounds, tuple)}
        for share in qmc.Halton(len(varied), seed=number).random(10):
            at = {name: a + s * (b - a) for (name, (a, b)), s in zip(varied.items(), share, strict=True)}
            p = Parameters(**{**plane, **at})
            found = fate(p, horizon)
            whole = follow(p, horizon, tol=1e-10, settled=0.0, near=0.0)
            separates = math.isfinite(whole.first_separation)
            points, simulated = points + 1, simulated + found.simulated
            if separates != (found.outcome == "separation"):
                disagree.append((at, found.outcome, whole.first_separation))
            if found.outcome == "stable" and found.simulated == 0.0:
                assert not whole.settling.growing, at
    assert len(disagree) <= MOST_WRONG * points, disagree
    assert simulated < 0.5 * points * horizon
