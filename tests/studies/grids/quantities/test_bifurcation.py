"""What a motion settles to, sampled at switches or once a turn of the drive."""

import math
from typing import Any

import numpy as np
import pytest

from disc_model.data.variables import Outcome
from disc_model.errors import ParameterError
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Poincare, Record, Start
from disc_model.studies.document import BifurcationOptions
from disc_model.studies.grids.points import Point
from disc_model.studies.grids.quantities import bifurcation
from tests.stability.test_attractor import SMALL, paradox

APART = {"parameters": {"N": 385, "Omega": 15.1}, "time": 70}


def test_samples_are_those_of_the_simulator() -> None:
    p = Parameters(N=200, Omega=50, n_diameters=1)
    values, _ = bifurcation.compute_point(Point(p), BifurcationOptions(transient=0.1, samples=2, tol=1e-9))
    turn = 2 * math.pi / p.Omega
    run = simulate(p, 2.6 * turn, tol=1e-9, record=Record(poincare=Poincare(start=0.9 * turn)))
    np.testing.assert_allclose(values["psi"], run.poincare["psi"], rtol=0, atol=1e-7)
    assert values["status"] == "ok"


@pytest.mark.parametrize("section", ["stroboscopic", "event"])
def test_samples_that_are_not_reached_are_missing(monkeypatch: pytest.MonkeyPatch, section: str) -> None:
    p, start = paradox()
    monkeypatch.setattr(bifurcation, "make_initial_state", lambda *_: start)
    options = BifurcationOptions(transient=0.1, samples=2, section=section)
    values, message = bifurcation.compute_point(Point(p), options)
    assert (values["status"], len(values.get("psi", ())), len(values.get("phase", ()))) == ("paradox", 0, 0)
    assert message == "the simulation ended early: paradox"


def test_without_a_drive_there_is_no_turn_to_sample_once() -> None:
    p = Parameters(N=200, Omega=0, n_diameters=1)
    with pytest.raises(ParameterError, match="Omega=0: must be > 0, because samples are taken once a turn"):
        bifurcation.compute_point(Point(p), BifurcationOptions(transient=0.1, samples=2))


def test_stretches_of_one_motion_are_alike() -> None:
    two = np.tile([1.0, 2.0], 100)
    assert bifurcation.alike(two, two[1:])  # the median is another of the two
    assert not bifurcation.alike(two, np.tile([1.0, 2.0, 3.0], 67))
    assert not bifurcation.alike(two, two + 0.3)
    many = np.random.default_rng(1).uniform(size=(3, 4000))
    assert bifurcation.alike(many[0], many[1])
    assert not bifurcation.alike(many[0], 1.2 * many[1])
    assert not bifurcation.alike(many[0], many[1][:2000])
    # a slow drift of one point is told from rest
    assert bifurcation.alike(np.full(50, 2.0), np.full(50, 2.0 + 1e-6))
    assert not bifurcation.alike(np.full(50, 2.0), np.full(50, 2.1))


GOLDEN = (5**0.5 - 1) / 2
NUMBERS = np.arange(600)
LOGISTIC = [0.3]
for _ in NUMBERS[1:]:
    LOGISTIC.append(3.9 * LOGISTIC[-1] * (1 - LOGISTIC[-1]))
NO_PERIODS = {
    "quasi-periodic": np.sin(2 * np.pi * GOLDEN * NUMBERS),
    "slow beat": np.sin(2e-4 * NUMBERS),
    "falling part of a slow beat": np.cos(1e-3 * NUMBERS + 1),
    "slow beat over two points": (-1.0) ** NUMBERS + 0.05 * np.sin(0.01 * NUMBERS),
    "chaotic": np.array(LOGISTIC),
    "chaotic bands": (-1.0) ** NUMBERS + 0.05 * np.array(LOGISTIC),
    "growing": 1e-1 * np.exp(0.005 * NUMBERS),
}
"""Intervals, in units of the differences between them; those below REPEATS are no differences."""


@pytest.mark.parametrize("size", [1e-9, 1e-7, 1e-5, 1e-3])
@pytest.mark.parametrize("name", NO_PERIODS)
def test_what_does_not_repeat_is_not_called_periodic_however_small_its_differences(name: str, size: float) -> None:
    assert bifurcation.repeats(0.015 + size * NO_PERIODS[name]) == 0


@pytest.mark.parametrize("period", [1, 2, 45, 238])
def test_what_repeats_to_rounding_needs_no_cycle(period: int) -> None:
    rng = np.random.default_rng(period)
    intervals = np.resize(0.015 + 1e-5 * rng.uniform(size=period), 600) + 1e-13 * rng.uniform(-1, 1, size=600)
    assert bifurcation.repeats(intervals) == period


def at_switches(Omega: float, samples: int = 50, **how: float) -> dict[str, Any]:
    """What the separating motion at 385 N settles to; one that is steady says nothing besides."""
    options = BifurcationOptions(section="event", samples=samples, **how)
    values, message = bifurcation.compute_point(Point(Parameters(N=385, Omega=Omega), Start(prerun=APART)), options)
    assert (message == "") == (values["stationary"] == "yes")
    return values


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("p", "kind", "transient"),
    [
        (SMALL, Outcome.QUIET, 2.0),
        (Parameters(N=200, Omega=0), Outcome.AT_REST, 2.0),
        (Parameters(N=50, Omega=15, c_p=0.5), Outcome.STEADY_SLIDING, 2.0),
        # contact is first lost at 11 s: of 2, 4 and 8 s, the first transient after whose two stretches it has been
        (Parameters(N=800, Omega=40, n_diameters=2), Outcome.SEPARATING, 8.0),
    ],
)
def test_a_transient_is_doubled_until_the_motion_has_settled(p: Parameters, kind: Outcome, transient: float) -> None:
    options = BifurcationOptions(section="event", transient=2, max_transient=20, samples=5)
    values, message = bifurcation.compute_point(Point(p), options)
    assert (values["kind"], values["transient_time"], message) == (kind, transient, "")
    assert len(values["psi"]) == (0 if kind in (Outcome.AT_REST, Outcome.STEADY_SLIDING) else 5)


def test_on_a_rigid_disc_the_slider_is_released_where_the_spring_has_friction_s_limit() -> None:
    p = Parameters(N=385, Omega=15.1, n_diameters=-1)
    values, _ = bifurcation.compute_point(Point(p), BifurcationOptions(section="event", transient=2, samples=5))
    assert (values["period_events"], values["stationary"]) == (1, "yes")
    assert values["psi"] == pytest.approx([p.mu_s * p.N / (p.r_0 * p.k_p)] * 5, rel=1e-9)  # at a tolerance of 1e-10


@pytest.mark.compiled
def test_a_motion_on_a_torus_has_no_period() -> None:
    """At rest there since 220 s, see `tests.stability.test_attractor`: the cycle within the torus is unstable."""
    options = BifurcationOptions(transient=300, section="event", max_transient=300, samples=50)
    values, _ = bifurcation.compute_point(Point(Parameters(N=516.666666667, Omega=12.734375)), options)
    assert (values["separations"], values["period_events"], values["stationary"]) == (0, 0, "yes")
    assert values["kind"] is Outcome.QUASI_PERIODIC


@pytest.mark.compiled
@pytest.mark.slow
def test_a_slow_approach_to_a_cycle_is_not_taken_for_a_torus() -> None:
    """At 200 N disturbances die out by 0.009/s; the 0-1 test takes what is left of them for a torus."""
    options = BifurcationOptions(section="event", transient=120, max_transient=120)
    values, _ = bifurcation.compute_point(Point(Parameters(N=200, Omega=15), Start(prerun=APART)), options)
    assert (values["period_events"], values["kind"]) == (0, Outcome.SEPARATING)


@pytest.mark.compiled
def test_a_slow_drift_with_equal_intervals_is_not_steady() -> None:
    """At 120 s intervals repeat to 1e-12 s, and the angle still drifts, by 1e-5 rad/s: it takes minutes more."""
    early, late = (at_switches(7.5, transient=transient, max_transient=transient) for transient in (120, 480))
    assert (early["stationary"], early["period_events"]) == ("no", 0)
    assert (late["stationary"], late["period_events"]) == ("yes", 1)


@pytest.mark.compiled
def test_a_long_period_is_found_before_the_motion_has_come_to_it() -> None:
    """Of 21 separations and 5 releases; simulated to 240 s its intervals repeat to 1e-13 s."""
    values = at_switches(20, transient=15)
    assert (values["period_events"], values["stationary"]) == (21, "yes")
    assert values["transient_time"] < 100
    assert 1e-11 < values["period_residual"] < 1e-6
    # what is shown is the cycle itself
    assert np.ptp(np.reshape(values["psi"][-42:], (2, 21)), axis=0).max() < 1e-9


@pytest.mark.compiled
@pytest.mark.parametrize(("Omega", "period", "phase"), [(9.5, 1, "stick"), (14.5, 2, "separation")])
def test_a_periodic_motion_has_as_many_points_as_its_period_has_switches(Omega: float, period: int, phase: str) -> None:
    values = at_switches(Omega, transient=60, samples=100)
    assert (values["stationary"], values["period_events"]) == ("yes", period)
    assert len(np.unique(np.round(values["psi"], 5))) == period
    assert set(values["phase"]) == {phase}


@pytest.mark.compiled
@pytest.mark.slow
def test_a_motion_that_repeats_after_a_thousand_separations_is_periodic() -> None:
    """It was said to have no period: a stretch of 5 s has 677 separations, and cycles were looked for in half of it."""
    start = Start(prerun={"parameters": {"N": 385, "Omega": 15.1, "c_p": 0}, "time": 70})
    options = BifurcationOptions(section="event", transient=120, max_transient=120)
    values, _ = bifurcation.compute_point(Point(Parameters(N=385, Omega=15, c_p=0.15), start), options)
    assert (values["period_events"], values["stationary"], values["kind"]) == (1066, "yes", Outcome.SEPARATING)
    assert values["period_residual"] < 1e-8


@pytest.mark.compiled
def test_the_period_of_a_motion_that_sticks_rarely_was_missed() -> None:
    """It sticks for 1.6 % of the time, with more between two releases than a quiet motion needs for several."""
    values = at_switches(22.25, transient=30, max_transient=30)
    assert (values["period_events"], values["stationary"]) == (40, "yes")
