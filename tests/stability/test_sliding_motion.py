"""Motions near steady sliding: whether they come to it."""

import pytest

from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.states import perturb
from disc_model.stability.sliding import steady_sliding
from disc_model.stability.sliding_motion import approaches_sliding

pytestmark = pytest.mark.compiled

SLIDES = Parameters(N=50, Omega=15, c_p=0.5)


def test_a_motion_approaches_sliding_however_late_it_is_asked() -> None:
    for time in (2.0, 20.0, 200.0):
        assert approaches_sliding(SLIDES, simulate(SLIDES, time).final_state)
    # it sticks, it is not near, and it departs
    assert not approaches_sliding(SLIDES, simulate(SLIDES, 1e-4).final_state)
    end = simulate(SLIDES, 20.0).final_state
    assert not approaches_sliding(SLIDES, perturb(SLIDES, end, f=-10.0))
    unstable = SLIDES.replace(N=385, c_p=2.0)
    assert not steady_sliding(unstable).stable
    assert not approaches_sliding(unstable, simulate(unstable, 5.0).final_state)


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
    assert approaches_sliding(p, beside) is near
