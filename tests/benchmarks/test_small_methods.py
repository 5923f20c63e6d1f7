"""What the rival methods do at switches, and how they end when they cannot go on: single steps and short spans."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numba
import numpy as np
import pytest

from disc_model import Parameters, simulate
from disc_model.benchmarks import flops, scenes
from disc_model.benchmarks.methods import METHODS, MethodUnavailable, Outcome, kernels
from disc_model.benchmarks.methods import regularised as regularised_module
from disc_model.benchmarks.methods import solve_ivp as solve_ivp_module
from disc_model.benchmarks.methods.base import Meter, Problem
from disc_model.benchmarks.methods.phases import Ended, IntegrationFailed, Phase, run_phases, switches
from disc_model.benchmarks.methods.physics import Physics
from disc_model.benchmarks.methods.regularised import Law, Regularised
from disc_model.benchmarks.scenes import Verdict, errors
from tests.references.printed import MOTIONS, P, Printed, lively

BONDED = P.replace(contact="bonded")
PHASES = ("stick", "slip", "separation")
SHORT = [name for name in ("RK45", "DOP853", "heyoka", "CVODE") if not METHODS[name].unavailable()]


def vector(start, p=P):
    physics = Physics(p)
    return physics, physics.pack(start), *kernels.tables(physics)


def switched(start, cause, p=P):
    """Phase, direction and kinds after a switch, and the state."""
    _, y, modes, c = vector(start, p)
    kinds = np.full(2, -1, np.int64)
    phase, direction, count = kernels.switch(modes, c, PHASES.index(start.phase), cause, y, kinds)
    return (PHASES[phase], direction, list(kinds[:count])), y


# ------------------------------------------------------------------------------------- conditions and switches
@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
@pytest.mark.parametrize("p", [P, BONDED], ids=["separable", "bonded"])
def test_switch_functions_are_those_in_numpy(p, phase, direction):
    physics, y, modes, c = vector(lively(phase, direction, p), p)
    wanted = [switch.value(y) for switch in switches(physics, Phase(phase, direction))]
    out = np.full(3, np.nan)
    kernels.switch_values(modes, c, PHASES.index(phase), direction, y, out)
    np.testing.assert_allclose(out[: len(wanted)], wanted, rtol=1e-10)
    assert np.isnan(out[len(wanted) :]).all()
    assert min(wanted) > 0
    assert kernels.violated(modes, c, PHASES.index(phase), direction, y) == 0


def test_violations_are_told_apart():
    def violated(start, **changes):
        physics, y, modes, c = vector(start)
        for name, value in changes.items():
            y[getattr(physics, name)] = value
        return kernels.violated(modes, c, PHASES.index(start.phase), start.direction, y)

    assert violated(lively("separation"), u=-1.0) == 1
    assert violated(lively("slip", 1), f=-1e-3) == 2
    assert violated(lively("stick"), psi=1.0) == 2
    lifted = lively("slip", 1)
    assert violated(lifted.replace(a=lifted.a - 0.01 * np.sign(Physics(P).shape))) in (0, 1)
    assert violated(lifted.replace(a=lifted.a + 0.01 * np.sign(Physics(P).shape))) == 1  # the disc pulls away


def test_at_rest_the_spring_decides():
    start = lively("slip", 1)
    assert switched(start.replace(psi=0.004), 2)[0] == ("stick", 0, [kernels.SLIP_TO_STICK])
    (after, y) = switched(start.replace(psi=-1.0), 2)
    assert after == ("slip", -1, [kernels.SLIP_REVERSAL])
    assert y[Physics(P).f] == 0
    assert switched(start.replace(psi=1.0), 2)[0] == ("slip", 1, [kernels.SLIP_REVERSAL])


def test_contact_that_would_pull_is_lost_at_once():
    """At rest, where stick breaks, and after an impact."""
    shape = Physics(P).shape
    start = lively("slip", 1)
    pulling = start.replace(a=start.a + 0.01 * np.sign(shape), psi=0.004)
    assert switched(pulling, 2)[0] == ("separation", 0, [kernels.LOSS_OF_CONTACT])
    assert switched(pulling, 2, BONDED)[0] == ("slip", 1, [kernels.SLIP_REVERSAL])
    falling = lively("separation").replace(u_velocity=-1.0)
    assert switched(falling, 1)[0][0] in ("slip", "separation")
    falling = falling.replace(a=falling.a + 0.01 * np.sign(shape))
    kinds = [kernels.REATTACHMENT, kernels.LOSS_OF_CONTACT]
    assert switched(falling, 1)[0] == ("separation", 0, kinds)
    (after, y) = switched(start, 1)
    assert after == ("separation", 0, [kernels.LOSS_OF_CONTACT])
    assert y[Physics(P).u] == pytest.approx(start.u, rel=1e-12)
    assert y[Physics(P).v] == pytest.approx(start.u_velocity, rel=1e-12)


def test_amplification_is_one_at_the_limit():
    assert kernels.largest_amplification(1000.0, 2 * math.sqrt(2) / 1000) == pytest.approx(1.0, rel=1e-12)
    assert kernels.largest_amplification(1000.0, 2.9e-3) > 1
    assert kernels.largest_amplification(1000.0, 2.7e-3) < 1


# ------------------------------------------------------------------------------------- how methods end
def task(phase="slip", direction=1, span=1e-4, p=P):
    return Problem(p, lively(phase, direction, p), span)


def test_fixed_steps_end_as_they_must():
    _, y, modes, c = vector(lively("slip", 1))

    def run(t_end, h, max_steps, room=4, y=y):
        return kernels.rk4_run(
            modes, c, kernels.SLIP, 1, y.copy(), t_end, h, max_steps, np.empty(room), np.empty(room, np.int64)
        )

    assert run(1e-4, 1e-5, 3)[0] == kernels.STEP_LIMIT
    assert run(1e-4, 1e-5, 99)[0] == kernels.FINISHED
    assert run(1.0, 0.5, 99)[0] == kernels.NON_FINITE
    assert run(0.02, 1e-5, 9999, room=0)[0] == kernels.STALLED


@pytest.mark.parametrize("name", SHORT)
def test_a_short_flight_is_the_printed_one(name):
    """Shorter than the time for which no reattachment is looked for, and longer."""
    for span in (1e-5, 1e-4):
        problem = task("separation", 0, span)
        result = METHODS[name].solve(problem, 1e-9)
        assert result.outcome is Outcome.FINISHED
        assert result.kinds == ()
        end = Printed(P, problem.start).at(span)
        for quantity in ("a", "alpha", "u", "psi"):
            size = np.max(np.abs(end[quantity]))
            np.testing.assert_allclose(getattr(result.final, quantity), end[quantity], rtol=0, atol=1e-6 * size)


@pytest.mark.parametrize("name", SHORT)
@pytest.mark.parametrize(("phase", "direction"), MOTIONS[:3])
def test_a_short_motion_in_contact_is_the_printed_one(name, phase, direction):
    problem = task(phase, direction)
    result = METHODS[name].solve(problem, 1e-9)
    assert (result.outcome, result.kinds) == (Outcome.FINISHED, ())
    end = Printed(P, problem.start).at(problem.t_end)
    for quantity in ("a", "b", "alpha", "beta", "psi", "f", "u", "u_velocity"):
        size = max(np.max(np.abs(end[quantity])), 1e-12)
        np.testing.assert_allclose(getattr(result.final, quantity), end[quantity], rtol=0, atol=1e-6 * size)


@pytest.mark.parametrize("name", SHORT)
@pytest.mark.parametrize("side", [1, -1])
def test_stick_breaks_on_both_sides(name, side):
    """With the spring near its limit, and a drive so slow that the contact force decides."""
    p = P.replace(Omega=0.5)
    start = lively("stick", p=p)
    start = start.replace(psi=side * 0.98 * p.mu_s * Printed(p, start).force() / (p.r_0 * p.k_p))
    expected = simulate(p, 5e-3, tol=1e-13, initial_state=start).events.iloc[0]
    result = METHODS[name].solve(Problem(p, start, float(expected["time"]) + 1e-6), 1e-10)
    assert result.kinds == ("stick_to_slip",)
    assert result.times[0] == pytest.approx(expected["time"], abs=1e-8)
    assert result.final.direction == side


@pytest.mark.parametrize("name", SHORT)
def test_a_falling_slider_lands_when_it_must(name):
    start = lively("separation")
    start = start.replace(u=start.u - 1e-3 + 5e-5, u_velocity=start.u_velocity - 0.5)
    expected = simulate(P, 4e-4, tol=1e-13, initial_state=start)
    result = METHODS[name].solve(Problem(P, start, 4e-4), 1e-10)
    assert result.kinds == tuple(expected.events["kind"]) == ("reattachment",)
    assert result.times[0] == pytest.approx(expected.events["time"][0], abs=1e-9)
    assert result.final.f == pytest.approx(expected.final_state.f, rel=1e-6)


@pytest.mark.parametrize("name", SHORT)
def test_a_budget_of_nothing_is_used_up(name):
    assert METHODS[name].solve(task(span=0.05), 1e-12, budget=0.0).outcome is Outcome.TOO_SLOW


def test_missing_packages_are_named(monkeypatch):
    monkeypatch.setattr("disc_model.benchmarks.methods.base.importlib.util.find_spec", lambda name: None)
    with pytest.raises(MethodUnavailable, match="heyoka needs heyoka: install the extra `bench`"):
        METHODS["heyoka"].solve(task(), 1e-6)


@pytest.mark.parametrize(
    ("what", "outcome", "words"),
    [
        ("fails", Outcome.FAILED, "gave up"),
        ("overflows", Outcome.NON_FINITE, "no longer finite"),
        ("crowds", Outcome.STALLED, "more than 50 events at one instant"),
    ],
)
def test_what_ends_a_run_of_phases(what, outcome, words):
    problem = task()

    def advance(phase, t, y, t_end):
        if what == "fails":
            raise IntegrationFailed("gave up")
        if what == "overflows":
            return Ended(None, t, y * math.nan)
        return Ended(1 if phase.name == "slip" else 0, t, y)  # one switch after the other, at once

    result = run_phases(problem, Physics(P), advance, Meter(math.inf))
    assert result.outcome is outcome
    assert words in result.message


def test_an_integrator_that_gives_up_is_reported(monkeypatch):
    def failing(function, span, y, **_):
        return SimpleNamespace(
            t=np.array([0.0]), y=y[:, None], status=-1, message="step too small", t_events=([], []), y_events=([], [])
        )

    monkeypatch.setattr(solve_ivp_module, "solve_ivp", failing)
    result = METHODS["RK45"].solve(task(), 1e-6)
    assert (result.outcome, result.message) == (Outcome.FAILED, "step too small")
    monkeypatch.setattr(regularised_module, "solve_ivp", failing)
    result = METHODS["regularised"].solve(task(), 1.0)
    assert (result.outcome, result.message) == (Outcome.FAILED, "step too small")

    def overflowing(function, span, y, **_):
        return SimpleNamespace(
            t=np.array([0.0, 1.0]),
            y=np.full((len(y), 2), np.nan),
            status=0,
            message="",
            t_events=([], []),
            y_events=([], []),
        )

    monkeypatch.setattr(regularised_module, "solve_ivp", overflowing)
    assert METHODS["regularised"].solve(task(), 1.0).outcome is Outcome.NON_FINITE


# ------------------------------------------------------------------------------------- the regularised model
def test_the_penalty_force_is_the_contact_force_at_the_start():
    problem = task()
    law = Law(Physics(P), 0.1)
    y = Regularised._start(problem, law.physics, law)
    assert law.force(y) == pytest.approx(Printed(P, problem.start).force(), rel=1e-9)
    flying = task("separation", 0)
    np.testing.assert_array_equal(Regularised._start(flying, law.physics, law), law.physics.pack(flying.start))
    assert law.force(law.physics.pack(flying.start)) < 0


@pytest.mark.parametrize("direction", [1, -1])
def test_the_penalty_acts_on_disc_and_slider_alike(direction):
    """What the contact adds to the free motion: on the disc down, on the slider up, friction against the slip."""
    law = Law(Physics(P), 0.1)
    y = Regularised._start(task("slip", direction), law.physics, law)
    added, physics = law.rate(y) - law.physics.rate("separation", 0, y), law.physics
    force = law.force(y)
    np.testing.assert_allclose(added[physics.alpha], -physics.shape * force, rtol=1e-9)
    assert added[physics.v] == pytest.approx(force / P.m, rel=1e-9)
    assert added[physics.f] == pytest.approx(-direction * P.mu_k * force / (P.m * P.r_0), rel=1e-3)
    assert law.stiffness(force) == pytest.approx(P.mu_s * force / (P.m * P.r_0 * 0.1))


def test_crossings_are_read_as_switches():
    law = Law(Physics(P), 0.1)
    physics = law.physics
    y = Regularised._start(task(), physics, law)
    sticking, flying = y.copy(), physics.pack(lively("separation"))
    sticking[physics.f] = 0.0
    assert regularised_module._state(law, 0.0, y).phase == "slip"
    assert regularised_module._state(law, 0.0, sticking).phase == "stick"
    assert regularised_module._state(law, 0.0, flying).phase == "separation"
    times, kinds = regularised_module._read_off(law, [np.array([1.0, 2.0]), np.empty(0)], [np.array([y, flying]), []])
    assert times.tolist() == [1.0]  # in flight f may cross zero: no switch
    assert kinds[0] in ("stick_to_slip", "slip_to_stick")
    passing = [(1.0, "slip_to_stick"), (1.0 + 5e-7, "stick_to_slip"), (2.0, "separation")]
    assert regularised_module._without_reversals(passing) == [(1.0, "slip_reversal"), (2.0, "separation")]


# ------------------------------------------------------------------------------------- scenes
def test_the_rigid_cycle_goes_through_all_its_phases(monkeypatch):
    """In stick and in slip at the end: against the single degree of freedom, integrated."""
    whole = scenes.problem("rigid")
    p = whole.parameters
    w = math.sqrt(p.k_p / p.m)
    for t_end in (0.004, 0.012, whole.t_end):
        answer = scenes.rigid_cycle(Problem(p, whole.start, t_end))
        final = answer.final
        assert final.time == t_end
        if final.phase == "stick":
            assert final.f == 0
            continue
        # energy of the oscillation about sliding at the drive's speed
        kinetic = p.mu_k * p.N / (p.k_p * p.r_0)
        released = p.mu_s * p.N / (p.k_p * p.r_0)
        now = (w * (final.psi - kinetic)) ** 2 + (p.Omega - final.f) ** 2
        assert now == pytest.approx((w * (released - kinetic)) ** 2 + p.Omega**2, rel=1e-9)
    assert {scenes.rigid_cycle(Problem(p, whole.start, t)).final.phase for t in np.linspace(1e-3, 0.02, 20)} == {
        "stick",
        "slip",
    }


def test_scenes_that_are_not_there():
    with pytest.raises(KeyError):
        scenes.problem("nowhere")


def test_a_result_without_events_has_no_event_time_error():
    right, problem = scenes.answer("rigid"), scenes.problem("rigid")
    nothing = METHODS["series"].solve(Problem(P, lively("slip", 1), 1e-5), 1e-9)
    assert math.isnan(scenes.event_time_error(right, nothing, problem.t_end))
    off = SimpleNamespace(
        final=right.final.replace(f=1e9), times=right.times.astype(float), kinds=right.kinds, outcome=Outcome.FINISHED
    )
    assert errors(problem, right, off).verdict is Verdict.UNSTABLE


@pytest.mark.skipif(not numba.config.DISABLE_JIT, reason="operations of compiled code cannot be counted")
def test_arithmetic_is_counted(monkeypatch):
    """A vector operation of each kind by hand; then a run of a few steps, each of which has some hundred of them."""
    from disc_model.engine import coasting, dense_output, polynomial, series

    for module in (dense_output, coasting, polynomial, series):
        for name in flops._OPERATIONS:
            if hasattr(module, name):
                monkeypatch.setattr(module, name, getattr(module, name))  # put back what counting replaces
    small = Parameters(N=200, Omega=50, n_diameters=1)
    start = simulate(small, 0.02).final_state
    monkeypatch.setattr(scenes, "problem", lambda name: Problem(small, start, start.time + 0.01))
    found = flops._count("any", 1e-9) * 0.01
    steps = simulate(small, 0.03, tol=1e-9, initial_state=start).statistics["steps"]
    assert 1000 * steps < found < 50_000 * steps
    assert found == pytest.approx(round(found), rel=1e-12)
