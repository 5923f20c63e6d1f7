"""Following motions until they settle, on a model with few modes and with probes a hundred times shorter than usual."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from disc_model import Parameters, floquet, simulate
from disc_model.stability import settling
from disc_model.stability.settling import Settling, follow, late_stretch

DAMPED = Parameters(N=200, Omega=20, n_diameters=1, c=20.0, D_star=1e-3)
LATE = 0.1


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """First probe after 0.2 s."""
    monkeypatch.setattr(settling, "FIRST_PROBE", 0.2)


@pytest.mark.usefixtures("impatient")
def test_a_damped_motion_settles_on_its_stable_cycle() -> None:
    found = follow(DAMPED, 3.0, tol=1e-9, settled=1e-9, near=1e-4, late=LATE)
    assert found.settled
    assert found.simulated < 3.0
    assert found.result.final_state.time == found.simulated
    assert math.isnan(found.first_separation)
    cycle = floquet(DAMPED)
    assert cycle.stable
    assert found.settling.distance <= 1e-4
    assert found.orbit == found.settling.cycle.state
    assert found.settling.rate == pytest.approx(cycle.growth_rate, rel=0.5)
    assert not found.settling.growing
    assert found.late.share_stick == pytest.approx(cycle.stick_fraction, abs=0.05)
    assert found.late.P_min < DAMPED.N < found.late.P_max


@pytest.mark.usefixtures("impatient")
def test_patience_zero_follows_to_the_horizon() -> None:
    found = follow(DAMPED, 0.5, tol=1e-9, settled=0.0, near=0.0, late=LATE)
    assert not found.settled
    assert found.simulated == 0.5
    assert found.orbit is None
    assert len(found.settling.times) == len(found.settling.differences) > 2
    assert found.settling.times[-1] == 0.5


@pytest.mark.usefixtures("impatient")
def test_a_separation_ends_it() -> None:
    p = Parameters(N=700, Omega=50, n_diameters=1, mu_s=1.4, mu_k=0.2, k=0)
    found = follow(p, 2.0, tol=1e-8, settled=1e-9, near=1e-4, late=LATE)
    assert found.late is None
    assert found.first_separation == pytest.approx(found.simulated, abs=1e-9)
    assert found.first_separation == pytest.approx(
        simulate(p, 2.0, tol=1e-8, stop_at="first_separation").first_separation, abs=1e-5
    )


@pytest.mark.parametrize("late", [0.5, 1.0, 4.0, 5.0, 20.0])
def test_long_late_stretches_do_not_reach_back_before_the_last_probe(late: float) -> None:
    """With more than 1.75 s the second probe began before the end of the first, and every such study failed."""
    probes = settling._probes(300.0, late)
    assert probes[-1][1] == 300.0
    for (_, stop), (start, end) in itertools.pairwise(probes):
        assert stop <= start < end
        assert end - start >= late * (1 - 1e-12)


def made_of(differences: list[float], cycle: object = None) -> Settling:
    """Differences found at 5 s, 10 s and so on; ``cycle`` stands for what there is near the start."""
    made = Settling(DAMPED, [5.0 * (i + 1) for i in range(len(differences))], differences)
    made.__dict__["cycle"] = cycle
    return made


def test_what_counts_as_settled() -> None:
    falling = [1e-4, 1e-5, 1e-8, 1e-10]
    assert made_of(falling).settled(1e-9, 1e-4)
    assert not made_of(falling[:3]).settled(1e-9, 1e-4), "too few probes"
    assert not made_of([1e-4, 1e-5, 1e-8, 1e-7]).settled(1e-9, 0.0), "not below the tolerance"
    assert not made_of([1e-10, 1e-4, 1e-10, 1e-9]).settled(0.9e-9, 1e-3), "rises"
    assert not made_of([1e-9, 5e-10, 1e-10, 9e-11]).settled(1e-9, 0.0), "has hardly fallen"
    unstable = floquet(Parameters(N=200, Omega=20, n_diameters=1))
    assert not unstable.stable
    on_it = made_of(falling, unstable)
    on_it.releases = np.zeros((0, 4))
    assert on_it.distance == math.inf
    assert on_it.settled(1e-9, 1e-4), "on something else"


def test_growth_is_seen_and_noise_is_not() -> None:
    assert made_of([1e-4, 1e-5, 3e-5, 4e-5]).growing
    assert not made_of([1e-4, 1e-5, 1.2e-5, 1e-5]).growing
    assert not made_of([1e-4, 1e-10, 3e-10, 4e-10]).growing
    assert not made_of([math.nan]).growing
    assert not made_of([1e-4, 2e-4]).growing
    assert made_of([math.exp(-i) for i in range(6)]).rate == pytest.approx(-0.2)
    assert math.isnan(made_of([1.0, 0.5]).rate)
    assert math.isnan(made_of([1.0, 0.5, 0.0, 0.1]).rate)


def test_a_slider_that_never_sticks_is_judged_by_its_contact_force() -> None:
    p = Parameters(N=100, Omega=10, mu_s=0, mu_k=0, n_diameters=1)
    moving = simulate(p, 0.01, tol=1e-8).final_state  # the release at the very start left out
    result = simulate(p, 0.06, tol=1e-8, initial_state=moving, record=settling._watching(0.01, 0.06))
    assert settling.releases(result).shape == (0, 4)
    force = result.samples[0]["P"]
    expected = (force.max() - force.min()) / 100
    assert settling.return_difference(result, settling.releases(result)) == expected
    assert math.isnan(settling.return_difference(result, np.zeros((1, 4)))), "too few to compare"
    weightless = simulate(p.replace(N=0), 0.01, tol=1e-8, record=settling._watching(0.0, 0.01))
    assert settling.return_difference(weightless, np.zeros((0, 4))) == 0


def test_what_has_not_slipped_yet_has_not_settled() -> None:
    """In stick at rest nothing differs from cycle to cycle: the first release comes at 0.4 s."""
    slow = Parameters(N=200, Omega=0.1, n_diameters=1)
    stuck = simulate(slow, 0.1, tol=1e-8, record=settling._watching(0.0, 0.1))
    assert math.isnan(settling.return_difference(stuck, settling.releases(stuck)))
    held = simulate(slow.replace(k_p=0), 0.1, tol=1e-8, record=settling._watching(0.0, 0.1))
    # for ever, but for roundings of the force
    assert settling.return_difference(held, settling.releases(held)) < 1e-14
    assert made_of([math.nan, 1e-4, 1e-5, 1e-8, 1e-10]).settled(1e-9, 1e-4), "released after the first probe"


def test_a_late_stretch_goes_on_from_a_state() -> None:
    start = simulate(DAMPED, 0.1, tol=1e-8).final_state
    result, late = late_stretch(DAMPED, start, 0.1, 0.05, 1e-8)
    whole = simulate(DAMPED, 0.2, tol=1e-8)
    assert result.final_state.time == pytest.approx(0.2)
    assert result.final_state.psi == pytest.approx(whole.final_state.psi, abs=1e-6)
    assert late.share_stick + late.share_slip + late.share_separation == pytest.approx(1)
    short, _ = late_stretch(DAMPED, None, 0.05, 0.05, 1e-8)
    assert short.final_state.time == pytest.approx(0.05)
    tilted = paradox()
    failed, nothing = late_stretch(*tilted, 0.1, 0.05, 1e-8)
    assert failed.status.value == "paradox"
    assert nothing is None


def paradox():
    """A case and a state from which rigid friction has no solution."""
    p = Parameters(N=100, Omega=20, mu_k=50, mu_s=60, k_p=2e7, n_diameters=1)
    start = simulate(p, 1e-6).final_state
    return p, start.replace(phase="slip", direction=1, f=10.0, b=np.array([0.0, -2.0]))
