"""Seeds of curves of stability."""

import math

import pytest

from disc_model import ParameterError, Parameters, continue_cycle, floquet
from disc_model.stability import curves
from disc_model.stability.return_map import ReturnMap


@pytest.mark.compiled
def test_a_seed_met_on_the_way_to_another_modulus_is_a_cycle_there():
    """E scales the coordinates of the section."""
    seed = curves._border(Parameters(N=385, Omega=15), "E", 1.4e11, 1e-12, [])
    assert seed is not None
    assert seed.kind == "fold"
    # twice the stick-slip rate meets the mode's frequency, sqrt(E), at Omega = 15.0949 for 150 GPa
    assert pytest.approx(149.42e9, rel=1e-4) == seed.case.E
    map_ = ReturnMap(seed.case)
    # rounding, and what a corrector leaves; with the coordinates of 150 GPa it is 1e-4
    assert map_.evaluate(seed.point).residual < 1e-9 * map_.deflection


@pytest.mark.compiled
def test_a_fold_is_followed_across_its_line():
    """The gradient at the former place leads the corrector astray here, unless each step corrects
    it."""
    bounds = {"Omega": (9.5, 11.0), "N": (350.0, 400.0)}
    found = curves.neutral_curves(Parameters(N=375, Omega=10), bounds, [375.0], points=2)
    assert found.failures == ()
    fold = next(curve for curve in found if curve.kind == "fold")
    assert fold.values[:, 1].min() < 375 < fold.values[:, 1].max()
    assert len(fold.values) < 30  # short steps are a sign of a corrector that fails


@pytest.mark.compiled
def test_a_narrow_tongue_between_two_values_is_seen():
    """From 20.124 to 20.169 rad/s, between the first two of eleven values from 20 to 60."""
    p = Parameters(
        N=385,
        Omega=33,
        E=70e9,
        rho=2700,
        nu=0.33,
        h=0.004,
        normalization="orthonormal",
        mu_k_over_mu_s=0.6,
    )
    found = curves.critical(p, "Omega", (20, 60), points=11, precision=1e-4)
    assert found.value == found.crossings[0] == pytest.approx(20.1239, abs=2e-4)
    assert found.unstable_above.tolist() == [True, False, True]
    for crossing, unstable in zip(found.crossings, found.unstable_above, strict=True):
        below, above = (floquet(p.replace(Omega=crossing + move)).stable for move in (-2e-4, 2e-4))
        assert (below, above) == (unstable, not unstable)
    assert 0 < found.resolution < 1


@pytest.mark.compiled
def test_bounds_may_have_units_and_those_of_another_kind_are_refused():
    p = Parameters(N=385, Omega=14.95, mu_k_over_mu_s=0.6)
    found = curves.critical(p, "Omega", ("142.5 rpm", 15), points=3)
    assert found.values[[0, -1]].tolist() == pytest.approx([142.5 * math.tau / 60, 15])
    branch = continue_cycle(p, "Omega", ("142.5 rpm", "15 rad/s"))
    assert "the bound Omega = 14.9226 rad/s was reached" in branch.ended
    plane = curves.neutral_curves(
        p, {"Omega": ("142.5 rpm", 15), "h": ("2 mm", "2.1 mm")}, [0.00205], points=2
    )
    assert plane.bounds["h"] == pytest.approx((2e-3, 2.1e-3))
    with pytest.raises(
        ParameterError, match=r"^bounds=\('5 kg', 15\): must be two ascending finite numbers$"
    ):
        curves.critical(p, "Omega", ("5 kg", 15))
    with pytest.raises(ParameterError, match=r"^mu_k=0\.24: must be <= mu_s=0\.1$"):
        curves.critical(Parameters(N=385, Omega=14.95), "mu_s", (0.1, 0.9))
