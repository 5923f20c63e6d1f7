"""The rival methods: that each is right where it should be, and wrong where it must be."""

import dataclasses

import numpy as np
import pytest

from disc_model import simulate
from disc_model.benchmarks import scenes
from disc_model.benchmarks.methods import METHODS, kernels, scipy_ivp
from disc_model.benchmarks.methods.base import Problem, RunStatus
from disc_model.benchmarks.methods.kernels import Physics
from disc_model.benchmarks.scenes import answer, problem
from disc_model.benchmarks.work_precision import fitted_order
from tests import needs
from tests.benchmarks.problems import BASE, judge, task
from tests.references.printed import MOTIONS, P, Printed, lively

SHORT = [name for name in ("RK4", "RK45", "DOP853", "heyoka", "CVODE") if not METHODS[name].absent()]
SEPARATING = [name for name, method in METHODS.items() if method.settings.get("separating") and not method.absent()]
UP = np.sign(Physics(P).shape)
"""Amplitudes that lift the disc under the slider."""


# ----------------------------------------------------------------------------------------------------
# Scenes


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
        # the all but rigid disc gives way by 3e-9 of what the slider's spring does: it is left out
        ("series-fewest", "rigid", 1e-8, 1e-8),
    ],
)
def test_every_method_finds_all_switches(name, scene, value, allowed):
    if METHODS[name].absent():
        pytest.skip(needs.RIVALS.reason)
    result, off = judge(name, scene, value)
    assert (result.outcome, result.kinds) == (RunStatus.FINISHED, answer(scene).kinds)
    assert off.event_time < allowed
    if name == "series":
        assert off.state < 1e-11
    if name == "series-fewest":
        assert result.work < 100
        assert result.final.a.shape == problem(scene).start.a.shape


# ----------------------------------------------------------------------------------------------------
# Short motions of every phase, and single switches


def solved(name, motion, tol):
    """What a method finds at a tolerance, or in steps that are as good."""
    return METHODS[name].solve(motion, 2e-6 if METHODS[name].setting == "step" else tol)


@pytest.mark.parametrize("name", SHORT)
@pytest.mark.parametrize(
    ("phase", "direction", "span", "p", "lifted"),
    [
        *((*motion, 1e-4, P, 0.0) for motion in MOTIONS),
        ("separation", 0, 1e-5, P, 0.0),  # shorter than the time for which no reattachment is looked for
        ("slip", 1, 1e-4, P.replace(contact="bilateral"), 0.01),
    ],
)
def test_a_short_motion_is_the_printed_one(name, phase, direction, span, p, lifted):
    motion = task(phase, direction, span, p)
    motion = dataclasses.replace(motion, start=motion.start.replace(a=motion.start.a + lifted * UP))
    result = solved(name, motion, 1e-9)
    assert (result.outcome, result.kinds) == (RunStatus.FINISHED, ())
    printed = Printed(p, motion.start)
    assert bool(lifted) == (printed.force() < 0)
    end = printed.at(motion.t_end)
    for quantity in ("a", "b", "alpha", "beta", "psi", "f", "u", "u_velocity"):
        size = max(np.max(np.abs(end[quantity])), 1e-12)
        np.testing.assert_allclose(getattr(result.final, quantity), end[quantity], rtol=0, atol=1e-6 * size)


def meets(name, p, start, kind, span):
    """A method meets one switch, and when the engine does; its final state and the engine's."""
    right = simulate(p, span, tol=1e-13, initial_state=start)
    result = solved(name, Problem(p, start, span), 1e-10)
    assert result.kinds == tuple(right.events["kind"]) == (kind,)
    assert result.times[0] == pytest.approx(right.events["time"][0], abs=1e-9)
    return result.final, right.final_state


@pytest.mark.parametrize("name", SHORT)
def test_each_switch_is_met_when_it_must_be(name):
    # stick breaks on both sides: with the spring near its limit, and a drive so slow that the contact force decides
    slow = P.replace(Omega=0.5)
    for side in (1, -1):
        start = lively("stick", p=slow)
        start = start.replace(psi=side * 0.98 * P.mu_s * Printed(slow, start).force() / (P.r_0 * P.k_p))
        first = simulate(slow, 5e-3, tol=1e-13, initial_state=start).events["time"][0]
        assert meets(name, slow, start, "stick_to_slip", first + 1e-6)[0].direction == side
    # the disc, thrown up, pulls away; the run ends before it is back
    start = lively("slip", 1)
    start = start.replace(a=start.a + 1e-4 * UP, alpha=start.alpha + 2.0 * UP)
    start = start.replace(u=Physics(P).disc_point(Physics(P).pack(start))[0])
    meets(name, P, start, "separation", 1e-4)
    # a falling slider lands
    start = lively("separation")
    start = start.replace(u=start.u - 1e-3 + 5e-5, u_velocity=start.u_velocity - 0.5)
    ours, engines = meets(name, P, start, "reattachment", 4e-4)
    assert ours.f == pytest.approx(engines.f, rel=1e-6)


# ----------------------------------------------------------------------------------------------------
# Orders


@pytest.mark.parametrize(
    ("name", "values", "order", "margin"),
    [
        ("RK4", (2e-4, 1e-4, 5e-5, 2.5e-5), 4, 0.3),
        ("RK45", (1e-5, 1e-6, 1e-7, 1e-8), 5, 0.6),
        ("DOP853", (1e-6, 1e-7, 1e-8, 1e-9), 8, 1.2),
        ("Radau", (1e-3, 1e-4, 1e-5), 5, 1.2),
        *((name, (1e-5, 1e-7, 1e-9), 0, 0) for name in ("heyoka", "LSODA", "CVODE")),
    ],
)
def test_theoretical_order_on_smooth_motion(name, values, order, margin):
    """Slip without any switch: steady sliding with the disc set ringing. Methods of variable order follow their tol."""
    if METHODS[name].absent():
        pytest.skip(needs.RIVALS.reason)
    physics = Physics(BASE)
    start = scenes.static_start(BASE)
    psi = BASE.mu_k * BASE.N / (BASE.k_p * BASE.r_0)
    y = physics.pack(start.replace(psi=psi, f=BASE.Omega, alpha=2e-4 * physics.omega))
    motion = Problem(BASE, physics.unpack(0.0, "slip", 1, y), 0.05)
    exact = METHODS["series"].solve(motion, 1e-15)
    results = [METHODS[name].solve(motion, value) for value in values]
    assert all(result.kinds == () for result in (exact, *results))
    off = np.array([physics.distance(result.final, exact.final) for result in results])
    if order:
        assert fitted_order(np.array([result.work for result in results]), off) == pytest.approx(order, abs=margin)
    else:
        assert off[2] < 0.1 * off[1] < 0.01 * off[0]
        assert off[2] < 1e-5


# ----------------------------------------------------------------------------------------------------
# The regularised model: its law, its contact, its order, its stiffness


@pytest.mark.parametrize("direction", [1, -1])
def test_the_penalty_acts_on_disc_and_slider_alike(direction):
    """What the contact adds to the free motion: on the disc down, on the slider up, friction against the slip."""
    law, start = scipy_ivp.Law(Physics(P), 0.1), task("slip", direction).start
    y = law.start(start)
    force = law.force(y)
    assert force == pytest.approx(Printed(P, start).force(), rel=1e-9)
    leaving = y + 0.1 * (np.arange(len(y)) == law.physics.v)  # the damper holds what moves away, at 0.1 m/s
    assert law.force(leaving) == pytest.approx(force - 0.1 * law.constants[3], rel=1e-9)
    free, physics = np.empty_like(y), law.physics
    kernels.rate(law.modes, law.c, kernels.SEPARATION, 0, y, free)
    added = law.rate(y) - free
    np.testing.assert_allclose(added[physics.alpha], -physics.shape * force, rtol=1e-9)
    assert added[physics.v] == pytest.approx(force / P.m, rel=1e-9)
    assert added[physics.f] == pytest.approx(-direction * P.mu_k * force / (P.m * P.r_0), rel=1e-3)


def test_the_regularised_law_has_the_static_friction_as_its_maximum():
    law = scipy_ivp.Law(Physics(BASE), 0.1)
    friction = [kernels.smooth_friction(law.c, law.constants, f) for f in np.linspace(-10.0, 10.0, 40_001)]
    assert max(friction) == pytest.approx(BASE.mu_s, rel=1e-6)
    assert friction[-1] == pytest.approx(BASE.mu_k, rel=1e-3)
    assert friction[0] == -friction[-1]


def test_the_regularised_model_is_of_order_two_thirds_in_eps_and_stiff_in_proportion_to_its_sharpness():
    """Stick breaks by slow passage through the maximum of the law, a fold: late by eps^(2/3)."""
    start = scenes.static_start(BASE)
    eps = np.array([0.3, 0.1, 0.03])
    results = [METHODS["regularised"].solve(Problem(BASE, start, 0.01), value) for value in eps]
    assert all(result.kinds == ("stick_to_slip",) for result in results)
    late = np.array([float(result.times[0] - answer("stick_slip").times[0]) for result in results])
    assert fitted_order(1.0 / eps, late) == pytest.approx(2 / 3, abs=0.12)
    stuck = Problem(BASE, start, 0.004)  # nothing moves but the drive
    coarse, fine = (scipy_ivp.solve_regularised(stuck, value, np.inf, "RK45").work for value in (0.1, 0.01))
    assert fine > 4 * coarse
