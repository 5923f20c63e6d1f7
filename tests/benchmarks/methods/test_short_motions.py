"""Rival methods on short motions of every phase, and through single switches."""

from dataclasses import replace

import numpy as np
import pytest

from disc_model import simulate
from disc_model.benchmarks.methods import RunStatus
from disc_model.benchmarks.methods.base import Problem
from disc_model.benchmarks.methods.physics import Physics
from disc_model.benchmarks.registry import METHODS
from tests.benchmarks.methods.problems import task
from tests.references.printed import MOTIONS, P, Printed, lively

SHORT = [name for name in ("RK4", "RK45", "DOP853", "heyoka", "CVODE") if not METHODS[name].absent()]
UP = np.sign(Physics(P).shape)
"""Amplitudes that lift the disc under the slider."""


def solved(name, problem, tol):
    """What a method finds at a tolerance, or in steps that are as good."""
    return METHODS[name].solve(problem, 2e-6 if METHODS[name].setting == "step" else tol)


@pytest.mark.parametrize("name", SHORT)
@pytest.mark.parametrize(
    ("phase", "direction", "span", "p", "lifted"),
    [
        *((*motion, 1e-4, P, 0.0) for motion in MOTIONS),
        ("separation", 0, 1e-5, P, 0.0),  # shorter than the time for which no reattachment is looked for
        ("slip", 1, 1e-4, P.replace(contact="bonded"), 0.01),
    ],
)
def test_a_short_motion_is_the_printed_one(name, phase, direction, span, p, lifted):
    problem = task(phase, direction, span, p)
    problem = replace(problem, start=problem.start.replace(a=problem.start.a + lifted * UP))
    result = solved(name, problem, 1e-9)
    assert (result.outcome, result.kinds) == (RunStatus.FINISHED, ())
    printed = Printed(p, problem.start)
    assert bool(lifted) == (printed.force() < 0)
    end = printed.at(problem.t_end)
    for quantity in ("a", "b", "alpha", "beta", "psi", "f", "u", "u_velocity"):
        size = max(np.max(np.abs(end[quantity])), 1e-12)
        np.testing.assert_allclose(getattr(result.final, quantity), end[quantity], rtol=0, atol=1e-6 * size)


def meets(name, p, start, kind, span):
    """A method meets one switch, and when the engine does; its result and the engine's."""
    right = simulate(p, span, tol=1e-13, initial_state=start)
    result = solved(name, Problem(p, start, span), 1e-10)
    assert result.kinds == tuple(right.events["kind"]) == (kind,)
    assert result.times[0] == pytest.approx(right.events["time"][0], abs=1e-9)
    return result, right


@pytest.mark.parametrize("name", SHORT)
@pytest.mark.parametrize("side", [1, -1])
def test_stick_breaks_on_both_sides(name, side):
    """With the spring near its limit, and a drive so slow that the contact force decides."""
    p = P.replace(Omega=0.5)
    start = lively("stick", p=p)
    start = start.replace(psi=side * 0.98 * p.mu_s * Printed(p, start).force() / (p.r_0 * p.k_p))
    first = simulate(p, 5e-3, tol=1e-13, initial_state=start).events["time"][0]
    result, _ = meets(name, p, start, "stick_to_slip", first + 1e-6)
    assert result.final.direction == side


@pytest.mark.parametrize("name", SHORT)
def test_contact_is_lost_when_it_must(name):
    """The disc, thrown up, pulls away; the run ends before it is back."""
    start = lively("slip", 1)
    start = start.replace(a=start.a + 1e-4 * UP, alpha=start.alpha + 2.0 * UP)
    start = start.replace(u=Physics(P).disc_point(Physics(P).pack(start))[0])
    meets(name, P, start, "separation", 1e-4)


@pytest.mark.parametrize("name", SHORT)
def test_a_falling_slider_lands_when_it_must(name):
    start = lively("separation")
    start = start.replace(u=start.u - 1e-3 + 5e-5, u_velocity=start.u_velocity - 0.5)
    result, right = meets(name, P, start, "reattachment", 4e-4)
    assert result.final.f == pytest.approx(right.final_state.f, rel=1e-6)


@pytest.mark.parametrize("name", SHORT)
def test_a_budget_of_nothing_is_used_up(name):
    assert METHODS[name].solve(task(span=0.05), 1e-12, budget=0.0).outcome is RunStatus.TOO_SLOW
