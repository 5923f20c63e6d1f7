"""Every analysis of a block on a rigid disc, the textbook friction oscillator, against closed forms."""

import math

import numpy as np
import pytest

import disc_model as dm
from disc_model.stability.frequencies import frequencies
from tests.blocks import RIG
from tests.references import block

pytestmark = pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")

LEINE = dm.Parameters(
    n_diameters=-1, m=1, k=0, k_p=1, N=1, r_0=1, a=0.5, b=2, Omega=0.2, mu_s=1, mu_k=0, friction_decay=3
)  # fmt: skip
JUMP = dm.Parameters(n_diameters=-1, N=30, Omega=0.5, m=0.2, k=0, k_p=2e3, mu_s=0.5, mu_k=0.3)
STRIBECK = RIG.replace(friction_law="exponential", viscous_friction=0.1)
END_OF_STICK_SLIP = 2.305984645  # rad/s, by an integration of the rig's block with scipy


def test_the_cycle_with_a_jump_of_friction_is_that_in_closed_form() -> None:
    expected = block.undamped_stick_slip(JUMP)
    cycle = dm.floquet(JUMP)
    assert cycle.period == pytest.approx(expected.period, rel=1e-11)
    assert cycle.stick_fraction == pytest.approx(expected.stick / expected.period, rel=1e-10)
    stretch = cycle.state.psi * JUMP.r_0
    friction = JUMP.mu_s * JUMP.N
    assert stretch == pytest.approx(friction / JUMP.k_p, rel=1e-14)


def test_leine_s_cycle_has_its_published_times_and_stretch() -> None:
    cycle = dm.floquet(LEINE)
    stick = cycle.stick_fraction * cycle.period
    assert cycle.period - stick == pytest.approx(block.LEINE.slip, abs=2e-10)
    assert stick == pytest.approx(block.LEINE.stick, abs=2e-10)
    run = dm.simulate(LEINE, cycle.period, initial_state=cycle.state, tol=1e-13)
    stop = run.events[run.events["kind"] == "slip_to_stick"].iloc[0]
    assert stop["psi"] == pytest.approx(block.LEINE.stretch_at_stop, abs=2e-10)


@pytest.mark.parametrize("p", [LEINE, JUMP, RIG])
def test_stick_erases_all_so_that_the_only_multiplier_is_zero(p) -> None:
    cycle = dm.floquet(p)
    assert cycle.multipliers.tolist() == [0]
    assert cycle.growth_rate == -math.inf
    assert cycle.stable
    assert cycle.residual == 0


def test_the_cycle_near_a_simulated_state_is_the_same() -> None:
    cycle = dm.floquet(RIG)
    late = dm.simulate(RIG, 1.0).final_state
    assert dm.floquet(RIG, guess=late).period == pytest.approx(cycle.period, rel=1e-11)


@pytest.mark.parametrize("p", [LEINE, RIG, RIG.replace(Omega=1.0), STRIBECK])
def test_steady_sliding_has_the_eigenvalues_of_its_quadratic(p) -> None:
    sliding = dm.steady_sliding(p)
    expected = block.sliding_eigenvalues(p)
    ours = sliding.eigenvalues[np.argsort(sliding.eigenvalues.imag)]
    scale = np.abs(expected).max()
    np.testing.assert_allclose(ours, expected[np.argsort(expected.imag)], atol=1e-13 * scale)


@pytest.mark.parametrize("law", ["hyperbolic", "exponential"])
@pytest.mark.parametrize("viscous", [0.0, 0.3])
def test_steady_sliding_loses_stability_at_the_hopf_speed(law: str, viscous: float) -> None:
    p = RIG.replace(friction_law=law, viscous_friction=viscous)
    hopf = block.hopf_speed(p) / p.r_0
    rates = []
    for share in (-1e-10, 1e-10):
        rates.append(dm.steady_sliding(p.replace(Omega=hopf * (1 + share))).growth_rate)
    assert rates[0] > 0 > rates[1]


def test_the_branch_of_stick_slip_has_closed_periods_and_no_special_points() -> None:
    branch = dm.continue_cycle(JUMP, "Omega", (0.2, 1.0))
    for i in range(len(branch)):
        expected = block.undamped_stick_slip(branch.case_at(i))
        assert branch.period[i] == pytest.approx(expected.period, rel=1e-10)
    assert set(branch.special_points["kind"]) == {"end"}
    assert set(branch.diameters) == {-1}


def test_the_branch_of_stick_slip_ends_where_the_motion_slips_on() -> None:
    branch = dm.continue_cycle(RIG, "Omega", (1.0, 3.0))
    assert branch.values.max() == pytest.approx(END_OF_STICK_SLIP, abs=2e-6)
    assert branch.ended.endswith("grazing")


def test_both_attractors_are_found_where_they_coexist() -> None:
    cycle = dm.floquet(RIG)
    assert cycle.stable
    assert cycle.sliding.stable
    known = dm.basins(RIG, horizon=60)
    assert known["kind"].item() == "stick_slip"
    assert known["attractor_period"][0].item() == pytest.approx(dm.floquet(RIG).period, rel=1e-9)
    sliding = dm.outcome(RIG, 60, start={"f": RIG.Omega})
    assert sliding["outcome"].item() == "steady_sliding"


@pytest.mark.parametrize(("Omega", "outcome"), [(1.0, "stick_slip"), (2.4, "steady_sliding")])
def test_the_outcome_is_the_only_attractor(Omega, outcome) -> None:
    assert dm.outcome(RIG.replace(Omega=Omega), 200)["outcome"].item() == outcome


def test_a_slow_cycle_that_is_not_released_in_the_last_seconds_is_found() -> None:
    known = dm.basins(LEINE, horizon=400)
    assert known["attractor_period"][0].item() == pytest.approx(block.LEINE.period, rel=1e-9)


def test_critical_finds_no_loss_of_stability_of_stick_slip() -> None:
    assert not len(dm.critical(RIG, "Omega", (1.0, 2.2), points=5).crossings)


def test_lyapunov_exponents_are_minus_infinity_but_that_along_the_motion() -> None:
    exponents = dm.lyapunov_exponents(RIG, 20.0, count=1)
    assert exponents.exponents.tolist() == [-math.inf]


def test_frequencies_are_those_of_sliding_alone() -> None:
    _, modes, columns = frequencies(RIG)
    assert modes.diameters.tolist() == [-1]
    assert np.all(np.isnan(columns))
