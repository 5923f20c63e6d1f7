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


def test_a_stable_cycle_keeps_the_start_and_nothing_is_simulated() -> None:
    found = fate(Parameters(N=50, Omega=15), 1000)
    assert (found.outcome, found.simulated) == ("stable", 0.0)
    assert found.cycle is not None
    assert found.cycle.growth_rate == pytest.approx(-0.0083, abs=3e-4)  # docs/model.md


def test_slow_growth_until_the_horizon_is_not_simulated() -> None:
    found = fate(Parameters(N=100, Omega=20), 1000)  # +0.0008/s
    assert (found.outcome, found.simulated) == ("unstable", 0.0)


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


def test_growth_that_has_saturated_is_not_simulated_to_the_horizon() -> None:
    """On a torus since 220 s; simulated to 1000 s the contact force stays within 9 % of the preload."""
    p = Parameters(N=516.666666667, Omega=12.734375)
    found = fate(p, 1000)
    assert (found.outcome, found.saturated) == ("unstable", True)
    assert found.state is not None
    assert found.state.time < 500
    on = simulate(p, found.state.time + 20, initial_state=found.state, stop_at="first_separation")
    assert math.isnan(on.first_separation)


def test_a_patient_look_sees_what_leaves_a_torus_that_is_unstable() -> None:
    """The contact force ranges over a third of the preload from 190 s to 300 s and longer; then it separates.

    How much longer turns on roundings: a look that is not patient sees rest on most processors, and is not asked here.
    """
    p = Parameters(N=550, Omega=12.7)
    found = fate(p, 1000, furthest=0.02, patient=True)
    assert (found.outcome, found.saturated) == ("separation", False)


def test_a_slow_rise_is_no_rest() -> None:
    """At 96 % of the preload, and 1 % more each leg: it separates at 847 s, and is not left before."""
    found = fate(Parameters(N=216.666666667, Omega=11.328125), 1000)
    assert found.outcome == "separation"


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


def test_a_start_far_from_a_cycle_does_not_follow_it() -> None:
    """Beside the fold the motion from the start is not linear: its size tells."""
    p = Parameters(N=385, Omega=15)
    near = published_start_near(p)
    assert isinstance(near, Near)
    far = near.x + 100 * near.distance
    assert not module._near(near.map, near.cycle, far).own


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


def test_what_grows_is_told_from_what_falls() -> None:
    assert module._growing([1e-4, 1e-5, 2e-5, 3e-5])
    assert not module._growing([1e-4, 1e-5, 1.2e-5, 1e-5])
    assert not module._growing([1e-9, 1e-12, 1e-11, 1e-10])  # noise
    assert not module._growing([np.nan])
