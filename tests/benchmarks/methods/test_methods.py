"""The rival methods: that each is right where it should be, and wrong where it must be."""

import dataclasses
import functools

import numpy as np
import pytest

from disc_model.benchmarks import scenes
from disc_model.benchmarks.methods import RunStatus
from disc_model.benchmarks.methods.base import Problem
from disc_model.benchmarks.methods.physics import Physics
from disc_model.benchmarks.registry import METHODS, MethodUnavailable
from disc_model.benchmarks.scenes import Verdict, answer, errors, problem
from disc_model.benchmarks.work_precision import fitted_order
from tests import needs
from tests.benchmarks.methods.problems import BASE as P
from tests.benchmarks.methods.problems import judge

INSTALLED = [name for name, method in METHODS.items() if not method.absent()]


@functools.cache
def _smooth(duration=0.1):
    """Slip without any switch: steady sliding with the disc set ringing; the drive point stays ahead."""
    start = scenes.static_start(P)
    ring = 2e-4 * Physics(P).omega
    psi = P.mu_k * P.N / (P.k_p * P.r_0)
    y = Physics(P).pack(start.replace(psi=psi, f=P.Omega, alpha=ring))
    task = Problem(P, Physics(P).unpack(0.0, "slip", 1, y), duration)
    exact = METHODS["series"].solve(task, 1e-15)
    assert exact.kinds == ()
    return task, exact.final


@pytest.mark.parametrize(
    ("name", "values", "order", "margin"),
    [
        ("RK4", (2e-4, 1e-4, 5e-5, 2.5e-5), 4, 0.3),
        ("RK45", (1e-5, 1e-6, 1e-7, 1e-8), 5, 0.6),
        ("DOP853", (1e-6, 1e-7, 1e-8, 1e-9), 8, 1.2),
        ("Radau", (1e-3, 1e-4, 1e-5), 5, 1.2),
    ],
)
def test_theoretical_order_on_smooth_motion(name, values, order, margin):
    task, exact = _smooth(0.05)
    results = [METHODS[name].solve(task, value) for value in values]
    assert all(result.kinds == () for result in results)
    found = [Physics(P).distance(result.final, exact) for result in results]
    work = np.array([result.work for result in results], float)
    assert fitted_order(work, np.array(found)) == pytest.approx(order, abs=margin)


@pytest.mark.parametrize("name", [name for name in ("heyoka", "LSODA", "CVODE") if name in INSTALLED])
def test_methods_of_variable_order_follow_their_tolerance(name):
    task, exact = _smooth()
    errors_ = [Physics(P).distance(METHODS[name].solve(task, tol).final, exact) for tol in (1e-5, 1e-7, 1e-9)]
    assert errors_[2] < 0.1 * errors_[1] < 0.01 * errors_[0]
    assert errors_[2] < 1e-5


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("name", "scene", "value", "allowed"),
    [
        ("series", "stick_slip", 1e-15, 2e-14),
        ("series", "separating", 1e-15, 2e-14),
        pytest.param("series", "many_modes", 1e-15, 2e-14, marks=pytest.mark.slow),  # compiles for a minute
        ("RK4", "stick_slip", 1e-5, 1e-10),
        ("RK45", "stick_slip", 1e-6, 1e-6),
        ("DOP853", "stick_slip", 1e-8, 1e-8),
        ("LSODA", "stick_slip", 1e-6, 1e-5),
        ("Radau", "stick_slip", 1e-4, 1e-4),
        ("heyoka", "stick_slip", 1e-10, 1e-10),
        ("CVODE", "stick_slip", 1e-8, 1e-7),
        # with roots of its own where a separation begins: triple ones
        ("heyoka", "separating", 1e-10, 1e-10),
        ("CVODE", "separating", 1e-11, 1e-9),
        ("LSODA", "rigid", 1e-7, 1e-7),
        ("RK4", "rigid", 6e-8, 1e-10),
    ],
)
def test_every_method_finds_all_switches(name, scene, value, allowed):
    if name not in INSTALLED:
        pytest.skip(needs.RIVALS.reason)
    result, found = judge(name, scene, value)
    assert (result.outcome, result.kinds) == (RunStatus.FINISHED, answer(scene).kinds)
    assert found.event_time < allowed
    if name == "series":
        assert found.state < 1e-11


@pytest.mark.parametrize(("name", "most"), [("RK45", 100), ("DOP853", 60), ("LSODA", 20)])
def test_default_steps_jump_over_losses_of_contact(name, most):
    task = dataclasses.replace(problem("separating"), max_step=np.inf)
    result = METHODS[name].solve(task, 1e-3, 30.0)  # scipy's defaults
    found = errors(task, answer("separating"), result)
    assert found.verdict is Verdict.WRONG_EVENTS
    assert result.separations < most  # of 131
    assert result.longest_step > scenes.shortest_phase(answer("separating"))


def test_a_method_out_of_time_says_so():
    result = METHODS["RK45"].solve(problem("many_modes"), 1e-6, budget=0.05)
    assert result.outcome is RunStatus.TOO_SLOW
    assert "0.05 s" in result.message
    assert result.seconds < 5.0


def test_a_missing_package_is_named():
    missing = METHODS["CVODE"].model_copy(update={"requires": ("no_such_package",)})
    with pytest.raises(MethodUnavailable, match="no_such_package: install the extra `bench`"):
        missing.solve(problem("stick_slip"), 1e-6)
