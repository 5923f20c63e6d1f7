"""The regularised model: its law, its contact, its order, its stiffness."""

import numpy as np
import pytest

from disc_model.benchmarks import scenes
from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import Problem
from disc_model.benchmarks.methods.physics import Physics
from disc_model.benchmarks.methods.regularised import Law, solve
from disc_model.benchmarks.registry import METHODS
from disc_model.benchmarks.scenes import answer
from disc_model.benchmarks.work_precision import fitted_order
from tests.benchmarks.methods.problems import BASE, task
from tests.references.printed import P, Printed, lively


def test_the_penalty_force_is_the_contact_force_at_the_start():
    problem = task()
    law = Law(Physics(P), 0.1)
    y = law.start(problem.start)
    assert law.force(y) == pytest.approx(Printed(P, problem.start).force(), rel=1e-9)
    flying = task("separation", 0)
    np.testing.assert_array_equal(law.start(flying.start), law.physics.pack(flying.start))
    assert law.force(law.physics.pack(flying.start)) < 0


@pytest.mark.parametrize("direction", [1, -1])
def test_the_penalty_acts_on_disc_and_slider_alike(direction):
    """What the contact adds to the free motion: on the disc down, on the slider up, friction against the slip."""
    law = Law(Physics(P), 0.1)
    y = law.start(task("slip", direction).start)
    free, physics = np.empty_like(y), law.physics
    kernels.rate(law.modes, law.c, kernels.SEPARATION, 0, y, free)
    added = law.rate(y) - free
    force = law.force(y)
    np.testing.assert_allclose(added[physics.alpha], -physics.shape * force, rtol=1e-9)
    assert added[physics.v] == pytest.approx(force / P.m, rel=1e-9)
    assert added[physics.f] == pytest.approx(-direction * P.mu_k * force / (P.m * P.r_0), rel=1e-3)


def test_the_phase_is_read_from_the_state():
    law = Law(Physics(P), 0.1)
    y = law.start(task().start)
    assert law.state(0.0, y).phase == "slip"
    assert law.state(0.0, law.physics.pack(lively("separation"))).phase == "separation"
    y[law.physics.f] = 0.0
    assert law.state(0.0, y).phase == "stick"


def test_the_regularised_law_has_the_static_friction_as_its_maximum():
    law = Law(Physics(BASE), 0.1)
    friction = [kernels.smooth_friction(law.c, law.constants, f) for f in np.linspace(-10.0, 10.0, 40_001)]
    assert max(friction) == pytest.approx(BASE.mu_s, rel=1e-6)
    assert friction[-1] == pytest.approx(BASE.mu_k, rel=1e-3)
    assert friction[0] == -friction[-1]


def test_the_regularised_model_is_of_order_two_thirds_in_eps():
    """Stick breaks by slow passage through the maximum of the law, a fold: late by eps^(2/3)."""
    task = Problem(BASE, scenes.static_start(BASE), 0.01)
    first = answer("stick_slip").times[0]
    eps = np.array([0.3, 0.1, 0.03])
    results = [METHODS["regularised"].solve(task, value) for value in eps]
    assert all(result.kinds == ("stick_to_slip",) for result in results)
    late = np.array([float(result.times[0] - first) for result in results])
    assert fitted_order(1.0 / eps, late) == pytest.approx(2 / 3, abs=0.12)


def test_the_regularised_model_is_stiff_in_proportion_to_its_sharpness():
    task = Problem(BASE, scenes.static_start(BASE), 0.004)  # stick: nothing moves but the drive
    coarse, fine = (solve(task, eps, np.inf, "RK45").work for eps in (0.1, 0.01))
    assert fine > 4 * coarse
