"""Motions near steady sliding: whether they come to it, or depart from it."""

import numpy as np
import pytest

from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.states import perturb
from disc_model.stability.follower import find_outcome, follows_sliding, slips_on
from disc_model.stability.segments import stick_share
from disc_model.stability.sliding import height_of_slider, steady_sliding

pytestmark = pytest.mark.compiled

SLIDES = Parameters(N=50, Omega=15, c_p=0.5)
STICKS = Parameters(N=385, Omega=15)
SQUEALS = Parameters(
    N=5000,
    Omega=50,
    E=210e9,
    rho=7850,
    nu=0.3,
    h=6e-3,
    m=0.3,
    k=5e5,
    k_p=2e5,
    c_p=20,
    mu_s=0.45,
    mu_k=0.35,
    damping_ratio=5e-4,
    normalization="orthonormal",
    friction_offset="surface",
    contact_arc=0.4,
    n_diameters=6,
)
"""The case of docs/howto/critical_speed.md at a speed at which steady sliding is unstable."""


def test_a_motion_follows_sliding_however_late_it_is_asked() -> None:
    for time in (2.0, 20.0, 200.0):
        assert follows_sliding(SLIDES, simulate(SLIDES, time).final_state)
    # it sticks, it is not near, and it departs
    assert not follows_sliding(SLIDES, simulate(SLIDES, 1e-4).final_state)
    end = simulate(SLIDES, 20.0).final_state
    assert not follows_sliding(SLIDES, perturb(SLIDES, end, f=-10.0))


@pytest.mark.parametrize(("share", "near"), [(0.02, True), (0.2, False)])
def test_near_sliding_on_a_rigid_disc_is_a_tenth_of_friction_s_limit(
    share: float, near: bool
) -> None:
    """Of the spring's stretch under the greatest friction, mu_s N / k_p."""
    p = Parameters(N=200, Omega=20, n_diameters=-1, mu_s=0.4, mu_k=0.4, c_p=2.0)
    sliding = steady_sliding(p)
    stretch = p.mu_s * p.N / p.k_p
    end = simulate(p, 30.0).final_state
    beside = end.replace(psi=sliding.psi + share * stretch / p.r_0, f=p.Omega)
    assert beside.phase == "slip"
    assert follows_sliding(p, beside) is near


def test_a_motion_departs_from_unstable_sliding_as_its_eigenvalue_says() -> None:
    """The envelope of its height grows at that rate, found by simulation alone."""
    sliding = steady_sliding(SQUEALS)
    end = simulate(SQUEALS, 5.0).final_state
    assert not sliding.stable
    assert follows_sliding(SQUEALS, end)

    windows = {
        "early": Window(start=12, stop=13, rate=1e4),
        "late": Window(start=13, stop=14, rate=1e4),
    }
    samples = simulate(SQUEALS, 14.0, windows).samples
    early, late = (np.ptp(samples[name]["u"]) for name in windows)
    # within 2 %: a mode that grows at 0.43/s still takes part
    assert np.log(late / early) == pytest.approx(sliding.growth_rate, rel=0.02)


@pytest.mark.parametrize("horizon", [5.0, 10.0])
def test_a_motion_that_follows_sliding_grows_until_it_separates(horizon: float) -> None:
    assert find_outcome(SQUEALS, horizon).outcome == "growing"
    separated = find_outcome(SQUEALS, 20.0)
    assert separated.outcome == "separation"
    assert separated.first_separation > 10.0


def test_slip_between_two_sticks_is_no_departure_from_sliding() -> None:
    leg = simulate(STICKS, 5.0)
    assert stick_share(leg) > 0
    assert not slips_on(leg)


def test_rest_on_unstable_sliding_is_no_departure() -> None:
    sliding = steady_sliding(SQUEALS)
    at_rest = simulate(SQUEALS, 5.0).final_state.replace(
        a=sliding.a,
        alpha=sliding.alpha,
        b=sliding.b,
        beta=sliding.beta,
        psi=sliding.psi,
        f=SQUEALS.Omega,
        u=height_of_slider(SQUEALS, sliding),
    )
    assert not follows_sliding(SQUEALS, at_rest)
