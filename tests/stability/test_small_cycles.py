"""Cycles of a model with one pair of modes, which needs no compilation: found, followed, differentiated."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from disc_model import Parameters, Result, floquet, simulate
from disc_model.stability import return_map as return_map_module
from disc_model.stability.cycle import (
    CycleError,
    CycleStatus,
    FloquetResult,
    find_cycle,
    find_cycle_near,
    growth_rate,
    kind_of,
)
from disc_model.stability.floquet_batch import STATUS_NAMES, solve
from disc_model.stability.return_map import RETURNED, Flight, ReturnMap, newton
from tests.references.printed import Printed

P = Parameters(N=200, Omega=20, n_diameters=1)


def test_multipliers_agree_with_differences_of_the_return_map():
    result, cycle = floquet(P), find_cycle(P)
    x, h = cycle.solution.x, 3e-5 * np.linalg.norm(cycle.solution.x)

    def end(change):
        return cycle.map.evaluate(x + change, tangent=False)[1]

    columns = [(8 * (end(h * e) - end(-h * e)) - end(2 * h * e) + end(-2 * h * e)) / (12 * h) for e in np.eye(6)]
    expected = np.linalg.eigvals(np.array(columns).T)
    assert np.max(np.min(np.abs(result.multipliers[:, None] - expected[None, :]), axis=1)) < 1e-6
    assert result.growth_rate == pytest.approx(math.log(np.max(np.abs(expected))) / result.period, abs=1e-4)


def assert_closed(result: FloquetResult) -> Result:
    """A simulation over the period ends where it began; returns it."""
    run = simulate(result.parameters, result.period, initial_state=result.state, tol=1e-13)
    for name in ("a", "b", "alpha", "beta"):
        scale = np.max(np.abs(getattr(result.state, name)))
        assert np.allclose(getattr(run.final_state, name), getattr(result.state, name), atol=1e-9 * scale, rtol=0)
    assert run.final_state.psi == pytest.approx(result.state.psi, rel=1e-10)
    return run


def test_the_cycle_closes_in_a_simulation_and_is_found_again_from_there():
    result = floquet(P)
    assert_closed(result)
    later = simulate(P, 0.5 * result.period, initial_state=result.state, tol=1e-12).final_state
    again = find_cycle_near(P, later, releases=1)
    assert again.status is CycleStatus.OK
    assert again.message.endswith("with 1 release")
    np.testing.assert_allclose(again.solution.x, find_cycle(P).solution.x, atol=1e-9 * np.linalg.norm(again.solution.x))
    # run through twice it is the same cycle
    twice = find_cycle_near(P, later, releases=2)
    assert twice.solution.flight.period == pytest.approx(2 * result.period, rel=1e-9)
    assert twice.message.endswith("with 2 releases")


def test_no_cycle_near_a_state_is_said():
    state = simulate(P, 0.01, tol=1e-8).final_state
    assert find_cycle_near(P.replace(Omega=0), state, 1).status is CycleStatus.AT_REST
    slippery = P.replace(c_p=50.0)
    slipping = simulate(slippery, 0.01, tol=1e-8).final_state
    found = find_cycle_near(slippery, slipping, 1)
    assert found.status is CycleStatus.NO_STICK_SLIP
    assert re.fullmatch(r"the slider does not stick within 0\.0\d+ s of the given state", found.message)


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({"Omega": 0}, CycleStatus.AT_REST),
        ({"N": 0}, CycleStatus.NO_STICK_SLIP),
        ({"k_p": 0}, CycleStatus.AT_REST),
        ({"c_p": 5}, CycleStatus.NO_STICK_SLIP),
    ],
)
def test_batch_and_single_name_the_same_status(changes, status):
    p = P.replace(**changes)
    single, batch = floquet(p), solve([p])
    assert single.status is status
    assert STATUS_NAMES[batch["status"][0]] == status.value
    assert np.isnan(batch["growth_rate"][0])
    np.testing.assert_equal(batch["sliding_growth_rate"][0], single.sliding.growth_rate)


def test_batch_equals_the_single_result():
    single, batch = floquet(P), solve([P])
    assert batch["growth_rate"][0] == single.growth_rate
    assert batch["multiplier_re"][0] + 1j * batch["multiplier_im"][0] == single.multipliers[0]
    assert (batch["period"][0], batch["stick_fraction"][0]) == (single.period, single.stick_fraction)


#: What the second look says of a transient that ended so: (outcome of the map, status, words of the message).
ENDS = [
    ("time_over", CycleStatus.NO_STICK_SLIP, "slips on for 1 s"),
    ("lost_contact", CycleStatus.SEPARATES, "contact is lost"),
    ("off_section", CycleStatus.SEPARATES, "contact is lost"),
    ("non_finite", CycleStatus.NON_FINITE, "overflows"),
    ("stalled", CycleStatus.NO_CYCLE, "without the clock moving"),
    ("paradox", CycleStatus.PARADOX, "Painleve"),
]


@pytest.mark.parametrize(("outcome", "status", "words"), ENDS)
def test_what_the_transient_did_is_reported(monkeypatch, outcome, status, words):
    code = next(code for code, name in return_map_module.OUTCOMES.items() if name == outcome)
    flight = Flight(code, 1.0, 0.0, 1.0, 0.0, 0, 0, 0, 0, 0)

    def evaluate(self, x, **_):
        return flight, x, np.eye(self.size), np.zeros((self.size, 0))

    monkeypatch.setattr(ReturnMap, "evaluate", evaluate)
    result = floquet(P)
    assert result.status is status
    assert words in result.message
    with pytest.raises(CycleError, match=words):
        result.raise_for_status()
    started = simulate(P, 0.001, tol=1e-8).final_state
    monkeypatch.setattr(ReturnMap, "next_release", lambda self, start, **_: (code, self.static))
    assert (find_cycle_near(P, started, 1).status is CycleStatus.NO_STICK_SLIP) == (outcome == "time_over")


class Affine:
    """A return map x -> A x + d with a fixed point, which may fail to return at chosen calls."""

    def __init__(self, A, d, wrong=None, lost_at=()):
        self.A, self.d, self.size = np.asarray(A, float), np.asarray(d, float), len(d)
        self.static, self.scale, self.lost_at, self.calls = np.ones(self.size), np.ones(self.size), lost_at, 0
        self.wrong = self.A if wrong is None else np.asarray(wrong, float)

    def evaluate(self, x, **how):
        self.calls += 1
        code = RETURNED if self.calls not in self.lost_at else RETURNED + 1
        flight = Flight(code, 1.0, 0.3, 0.7, 0.0, 1, 0, 0, 0, 1)
        bent = self.A @ x + self.d + 0.01 * np.sin(x)
        return flight, bent, self.wrong + 0.01 * np.diag(np.cos(x)), np.zeros((self.size, 0))


def test_from_a_given_point_no_other_cycle_is_taken():
    far = 3 * ReturnMap(P).static
    assert find_cycle(P).status is CycleStatus.OK
    found = find_cycle(P, start=far)
    assert found.status is CycleStatus.NO_CYCLE
    assert found.message == "no cycle near the given point of the section"


def test_newton_finds_the_fixed_point():
    map_ = Affine([[0.3, 0.2], [-0.4, 0.1]], [1.0, 2.0])
    found = newton(map_, np.zeros(2))
    assert found.converged
    np.testing.assert_allclose(map_.evaluate(found.x)[1], found.x, rtol=1e-12)
    assert found.residual < 1e-11


@pytest.mark.parametrize(
    "map_",
    [
        Affine(np.eye(2), [1.0, 2.0]),  # no fixed point nearby, and a singular matrix on the way
        Affine([[0.3, 0.2], [-0.4, 0.1]], [1.0, 2.0], lost_at=(1,)),
        Affine([[0.3, 0.2], [-0.4, 0.1]], [1.0, 2.0], wrong=[[9.0, 0.0], [0.0, -9.0]], lost_at=range(2, 99)),
        Affine([[0.3, 0.2], [-0.4, 0.1]], [np.nan, 2.0]),
    ],
    ids=["singular", "lost at once", "lost on the way", "not finite"],
)
def test_newton_says_that_it_found_none(map_):
    assert not newton(map_, np.zeros(2), jacobians=3).converged


def test_a_multiplier_tells_the_bifurcation():
    assert [kind_of(mu) for mu in (1.1 + 0j, -1.1 + 0j, 0.8 + 0.8j)] == ["fold", "period_doubling", "neimark_sacker"]
    assert growth_rate(0j, 0.01) == -math.inf


def test_the_section_is_where_stick_is_released():
    """At a point of the section friction is at its limit, and the contact force is that of the motion from there."""
    map_ = ReturnMap(P.replace(c=0.3, c_p=0.1))
    p = map_.parameters
    x = map_.static * 1.1 + 0.01 * np.arange(6)
    state = map_.state(x)
    assert state.phase == "stick"
    force = map_.contact_force(x)
    assert force == pytest.approx(Printed(p, state).force(), rel=1e-10)
    assert p.r_0 * (p.k_p * state.psi + p.c_p * p.Omega) == pytest.approx(p.mu_s * force, rel=1e-12)
    events = simulate(p, 1e-6, initial_state=state.replace(psi=state.psi * (1 - 1e-9))).events
    assert events["kind"][0] == "stick_to_slip"
    with pytest.raises(ValueError, match="must be one of Omega, N"):
        ReturnMap(p, parameters=("rho",))
