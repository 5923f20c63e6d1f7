"""What motions come to: attractors of 385 N, judged early and at the end of a long horizon."""

from __future__ import annotations

import math

import numpy as np
import pytest

from disc_model.parameters import Parameters
from disc_model.plate import mode_arrays
from disc_model.simulation.api import published_start
from disc_model.stability.basins import Basins, Reached, Signature, _left, random_kick

P14 = Parameters(N=385, Omega=14)


def kick_energy(p: Parameters, state, start) -> float:
    """Of the difference of two states: the modes', that of the slider's mass and of its spring."""
    omega = mode_arrays(p).omega
    modal = [
        omega * (state.a - start.a),
        omega * (state.b - start.b),
        state.alpha - start.alpha,
        state.beta - start.beta,
    ]
    slider = p.k * (state.u - start.u) ** 2 + p.m * (state.u_velocity - start.u_velocity) ** 2
    return 0.5 * (float(np.sum(np.square(modal))) + slider)


def test_a_kick_has_the_energy_asked_for_and_its_direction_hangs_on_its_key_alone() -> None:
    start = published_start(P14)
    one = random_kick(P14, start, 0.3, (1, 0, 5))
    # differences of the static deflection lose some of its 16 digits
    assert kick_energy(P14, one, start) == pytest.approx(0.3, rel=1e-12)
    # slider and disc go along
    assert one.u == pytest.approx(float(mode_arrays(P14).psi @ one.a), rel=1e-14)
    again, other = random_kick(P14, start, 0.3, (1, 0, 5)), random_kick(P14, start, 0.3, (1, 0, 6))
    assert np.array_equal(one.a, again.a)
    assert np.array_equal(one.beta, again.beta)
    assert not np.array_equal(one.a, other.a)
    # modes without nodal diameter have no second component
    assert not one.b[mode_arrays(P14).diameters == 0].any()
    assert random_kick(P14, start, 0.0, (1, 0, 5)) is start


def test_signatures_differ_by_their_largest_relative_difference() -> None:
    one = Signature(0.02, 135.0, 0.25, 0.10)
    assert one.difference(one, 1e-5) == 0
    assert one.difference(one._replace(range=0.019), 1e-5) == pytest.approx(0.05)
    assert one.difference(one._replace(separation_rate=0.0), 1e-5) == 1
    # ranges that are no motion at all are alike
    assert one._replace(range=1e-9).difference(one._replace(range=0.0), 1e-5) == 0


@pytest.mark.parametrize(
    ("values", "left"),
    [
        ([1 - 0.5**i for i in range(4)], 0.125),  # halves what is left each time
        ([1.5**i for i in range(4)], math.inf),  # grows
        ([1.0, 1.001, 0.999, 1.0], 0.0),  # no drift
        ([4.0, 3.0, 2.0, 1.0], math.inf),  # does not slow down
    ],
)
def test_a_drift_has_left_what_its_changes_add_up_to(values: list[float], left: float) -> None:
    assert _left(values) == pytest.approx(left)


def same(one: Reached, other: Reached) -> bool:
    if one.kind != other.kind or one.attractor is None or other.attractor is None:
        return False
    return one.kind == "quiet" or one.attractor.signature.difference(other.attractor.signature, 1e-5) < 0.05


def compared(p: Parameters, starts: range, horizon: float, longer: float) -> list[tuple[Reached, Reached]]:
    """What kicks come to as it is judged early, and at the end of a longer horizon."""
    early, late = Basins(p, horizon), Basins(p, longer, near=0)
    kicks = [random_kick(p, published_start(p), energy, (3, i)) for i in starts for energy in (0.05, 0.3, 2.0)]
    return [(early.reached(kick), late.reached(kick)) for kick in kicks]


@pytest.mark.compiled
def test_what_is_judged_early_comes_true() -> None:
    """At 14 rad/s disturbances of the quiet cycle die out at 0.067/s: after 200 s it is where it goes."""
    found = compared(P14, range(1, 2), 100.0, 200.0)
    assert all(same(*pair) for pair in found)
    assert {early.kind for early, _ in found} == {"quiet", "separating"}
    assert max(early.simulated for early, _ in found) < 100


@pytest.mark.compiled
@pytest.mark.slow
@pytest.mark.parametrize("Omega", [9.0, 10.0, 11.0, 13.0, 15.0])
def test_what_is_judged_early_comes_true_after_a_long_time(Omega: float) -> None:
    """What is undecided in one of the two says nothing.

    At 11 rad/s disturbances die out or grow by 0.0004/s, and at 9 rad/s one motion of 24 keeps its range for 40 s and
    goes on to another vibration: of the small vibrations there the kind is told, not the range.
    """
    found = compared(Parameters(N=385, Omega=Omega), range(8), 200.0, 800.0)
    decided = [pair for pair in found if "undecided" not in (pair[0].kind, pair[1].kind)]
    assert len(decided) > len(found) / 2
    if Omega in (9, 11):
        assert all(early.kind == late.kind for early, late in decided)
    else:
        assert all(same(*pair) for pair in decided)


@pytest.mark.compiled
def test_a_periodic_attractor_is_known_by_its_fixed_point() -> None:
    """The separating motion at 14 rad/s separates once between two releases of stick, again and again."""
    quiet, separating = Basins(P14, 100.0).known
    assert separating.kind == "separating"
    assert separating.releases == 1
    # one separation more or less in a leg of five seconds
    assert separating.period * separating.signature.separation_rate == pytest.approx(1, abs=1 / (5 * 135))
    assert separating.growth_rate < 0
    assert quiet.kind == "quiet"
    assert quiet.signature.separation_rate == 0
    assert quiet.growth_rate == pytest.approx(-0.0674, rel=1e-2)
    assert quiet.points is not None


@pytest.mark.compiled
@pytest.mark.slow
def test_what_stays_near_an_unstable_cycle_has_not_settled() -> None:
    """At 11 rad/s disturbances of the cycle grow by 0.0004/s: for a minute nothing is seen of it."""
    basins = Basins(Parameters(N=385, Omega=11), 60.0)
    assert basins.cycle is None
    assert basins.reached(published_start(basins.p)).kind == "undecided"


@pytest.mark.compiled
def test_a_motion_that_comes_to_steady_sliding_is_told() -> None:
    p = Parameters(N=50, Omega=15, c_p=0.5)
    assert Basins(p, 100.0).reached(published_start(p)).kind == "sliding"
