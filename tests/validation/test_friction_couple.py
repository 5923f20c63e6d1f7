"""The couple of friction on the disc's surface: the package against references, and these against
each other."""

import numpy as np
import pytest

from disc_model import Disc, Parameters, simulate, steady_sliding
from disc_model.simulation.states import static_start
from tests.contact_laws import LAWS
from tests.references import taylor
from tests.references.growth import steady_eigenvalues

EACH_LAW = {"default": {}} | LAWS


def eigenvalues(p):
    """Of steady sliding, by the reference, with the modes of `plate_modes`."""
    q = taylor.problem_of(p)
    values = p.model_dump() | {"contact_compliance": q.C}
    return steady_eigenvalues(values, np.sqrt(q.w2), q.s, q.l, q.d, q.t)


ORTHONORMAL = {"normalization": "orthonormal", "friction_offset": "surface"}
BRAKE = Disc(
    diameters=[2, 3, 0, 2], omega=[7264.0, 14880.0, 5100.0, 21000.0], amplitude=[0.83, -0.71, 0.5, 0.42],
    damping_ratio=[1e-4] * 4, tangential=[-0.11, 0.14, 0.0, -0.05],
)  # fmt: skip
"""Modes as of a brake disc; signs of the amplitudes differ."""
SLIDER = {"k": 1e6, "k_p": 1e6, "m": 0.5, "mu_s": 0.45, "mu_k": 0.35, "r_0": 0.115}


# ------------------------------------------------------------------------ the package
@pytest.mark.parametrize("law", EACH_LAW)
@pytest.mark.parametrize("N", [50.0, 600.0])
def test_growth_rates_of_the_paper_s_disc(law, N):
    """All eigenvalues of nine modes at three speeds, to 1e-8 of a growth rate of 1/s."""
    for Omega in (2.0, 15.1, 50.0):
        p = Parameters(N=N, Omega=Omega, **ORTHONORMAL, **EACH_LAW[law])
        compare_sliding(p)


@pytest.mark.parametrize("offset", ["surface", 0.006])
@pytest.mark.parametrize("law", ["default", "compliant_normal"])
def test_growth_rates_of_a_disc_by_its_modes(law, offset):
    """With tangential amplitudes of a table, and with a height in their place."""
    for Omega in (5.0, 20.0, 80.0):
        compare_sliding(
            Parameters(
                N=8000, Omega=Omega, disc=BRAKE, friction_offset=offset, **SLIDER, **EACH_LAW[law]
            )
        )


def compare_sliding(p):
    sliding = steady_sliding(p)
    wanted, (_, R, _) = eigenvalues(p)
    assert sliding.contact_force == pytest.approx(R, rel=1e-10)
    apart = np.abs(sliding.eigenvalues[:, None] - wanted)
    assert len(wanted) == len(sliding.eigenvalues)
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-8
    assert sliding.growth_rate == pytest.approx(wanted.real.max(), abs=1e-8)


@pytest.mark.slow
def test_the_surface_s_speed_is_that_over_the_drive_s():
    p = Parameters(N=200, Omega=10, n_diameters=1, friction_offset=0.02)
    q = taylor.problem_of(p)
    start = static_start(p)
    beta = start.beta.copy()
    beta[-1] = -3.0 / q.t[-1]
    start = start.replace(beta=beta, f=-3.0 / p.r_0)
    result = simulate(p, 1e-9, initial_state=start)
    assert q.surface_speed(beta) == pytest.approx(-3.0)
    assert result.statistics["surface_speed"] == pytest.approx(3.0 / (p.r_0 * p.Omega), rel=1e-14)
