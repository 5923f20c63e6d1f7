"""What a motion settles to, sampled at switches or once a turn of the drive."""

import dataclasses
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

from disc_model.analysis.classify import Settling
from disc_model.data.variables import Outcome
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.simulation import api
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Poincare, Start
from disc_model.simulation.starts import make_initial_state
from disc_model.stability import attractors
from disc_model.studies.quantities import bifurcation
from disc_model.studies.quantities.bifurcation import Bifurcation
from disc_model.studies.quantity import Point
from tests.stability.test_attractor import SMALL

APART = {"parameters": {"N": 385, "Omega": 15.1}, "time": 70}


def at_switches(Omega: float, samples: int = 50, **how: float) -> dict[str, Any]:
    """What the separating motion at 385 N settles to; one that is steady says nothing besides."""
    options = Bifurcation(section="event", samples=samples, **how)
    values, message = options.compute_point(
        Point(Parameters(N=385, Omega=Omega), Start(prerun=APART))
    )
    assert (message == "") == (values["settled"] == "settled")
    return values


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("p", "kind", "transient"),
    [
        (SMALL, Outcome.STICK_SLIP, 2.0),
        (Parameters(N=200, Omega=0), Outcome.AT_REST, 2.0),
        (Parameters(N=50, Omega=15, c_p=0.5), Outcome.STEADY_SLIDING, 2.0),
        # contact is first lost at 11 s; the cycle that it comes to has 86 separations
        (Parameters(N=800, Omega=40, n_diameters=2), Outcome.SEPARATING, 32.0),
    ],
)
def test_a_transient_is_doubled_until_the_motion_has_settled(
    p: Parameters, kind: Outcome, transient: float
) -> None:
    options = Bifurcation(section="event", transient=2, max_transient=600, samples=5)
    values, message = options.compute_point(Point(p))
    assert values["kind"] == kind
    assert values["transient_time"] == transient
    assert message == ""
    calm = (Outcome.AT_REST, Outcome.STEADY_SLIDING)
    count = 5
    if kind in calm:
        count = 0
    assert len(values["psi"]) == count


def test_on_a_rigid_disc_the_slider_is_released_where_the_spring_has_friction_s_limit() -> None:
    p = Parameters(N=385, Omega=15.1, n_diameters=-1)
    values, _ = Bifurcation(
        section="event", transient=600, max_transient=600, samples=5
    ).compute_point(Point(p))
    assert values["period_events"] == 1
    assert values["settled"] == "settled"
    assert values["psi"] == pytest.approx(
        [p.mu_s * p.N / (p.r_0 * p.k_p)] * 5, rel=1e-9
    )  # at a tolerance of 1e-10
    # the drive point moves ahead of the slider, which still rests on the disc
    assert values["psi_velocity"] == pytest.approx([p.Omega] * 5, rel=1e-9)


@pytest.mark.compiled
@pytest.mark.parametrize(("turns_left_out", "first"), [(0.3, 1), (1.0, 1), (1.7, 2)])
def test_samples_once_a_turn_begin_with_the_first_after_the_transient(
    turns_left_out: float, first: int
) -> None:
    p = Parameters(N=200, Omega=20, n_diameters=0)
    turn = 2 * np.pi / p.Omega
    options = Bifurcation(transient=turns_left_out * turn, samples=3, theta=2.0)
    values, message = options.compute_point(Point(p))
    assert message == ""
    start = make_initial_state(p, Start(), options.tol)
    turns = {"turns": Poincare(theta=2.0)}
    run = simulate(p, 4.5 * turn, turns, tol=options.tol, initial_state=start)
    # both runs end between two turns, half a turn apart
    end = (first + 2.5) * turn
    own = simulate(p, end, tol=options.tol, initial_state=start).statistics
    assert values["stick_fraction"] == pytest.approx(own["time_stick"] / end, rel=1e-6)
    every = run["turns"]
    for name in ("psi", "u", "P", "w_point"):
        expected = every[name].values[first : first + 3]
        # both runs stop elsewhere, which leaves the error of events
        assert values[name] == pytest.approx(expected, rel=1e-6, abs=1e-9)


@pytest.mark.compiled
def test_samples_once_a_turn_of_a_motion_that_had_not_settled_say_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """They were undecided without a word."""
    monkeypatch.setattr(attractors, "arrival", lambda p, legs: attractors.Arrival(Settling()))
    options = Bifurcation(transient=0.1, samples=1)
    values, message = options.compute_point(Point(Parameters(N=200, Omega=20, n_diameters=0)))
    assert values["kind"] == Outcome.UNDECIDED
    assert message.startswith("not settled after 0.47")
    assert message.endswith("; raise transient")


@pytest.mark.compiled
def test_a_motion_on_a_torus_has_no_period() -> None:
    """At rest there since 220 s, see `tests.stability.test_attractor`: the cycle within the torus
    is unstable."""
    options = Bifurcation(transient=600, section="event", max_transient=600, samples=50)
    values, _ = options.compute_point(Point(Parameters(N=516.666666667, Omega=12.734375)))
    assert values["separations"] == 0
    assert values["period_events"] == 0
    assert values["settled"] == "settled"
    assert values["kind"] is Outcome.QUASI_PERIODIC


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("Omega", "period", "phase"),
    # the last one sticks for 1.6 % of the time, with more between two releases than a quiet motion
    # needs for several
    [(9.5, 1, "stick"), (14.5, 2, "separation"), (22.25, 40, "separation")],
)
def test_a_periodic_motion_has_as_many_points_as_its_period_has_switches(
    Omega: float, period: int, phase: str
) -> None:
    values = at_switches(Omega, transient=60, samples=100)
    assert values["settled"] == "settled"
    assert values["period_events"] == period
    assert len(np.unique(np.round(values["psi"], 5))) == period
    assert set(values["phase"]) == {phase}


@pytest.mark.compiled
@pytest.mark.slow
@pytest.mark.parametrize(
    "N", np.random.default_rng(55).choice(np.linspace(100, 600, 201), 10, False).tolist()
)
def test_2000_seconds_more_change_nothing_where_the_motion_is_said_to_have_settled(
    N: float,
) -> None:
    """Ten points of the diagram over preload: 74 of its 201 were transients, which two stretches of
    5 s hid."""
    p = Parameters(N=N, Omega=15.1)
    start = Start(prerun=APART)
    options = Bifurcation(section="event", transient=15, max_transient=1920, samples=200)
    values, _ = options.compute_point(Point(p, start))
    if values["settled"] != "settled":
        return
    later = simulate(
        p, values["transient_time"] + 2000, initial_state=make_initial_state(p, start, 1e-10)
    ).final_state
    events = simulate(p, later.time + 5, initial_state=later).events
    kind = {"separation": "separation", "stick": "stick_to_slip"}[values["phase"][0]]
    psi = events["psi"][events["kind"] == kind].to_numpy()[-200:]
    ends = [(angles.min(), angles.max()) for angles in (psi, values["psi"])]
    # settled: the width changes by less than 5 % in 1000 s, or is below a thousandth of the angle
    first, last = ends
    span = np.ptp(values["psi"])
    largest = psi.max()
    tolerance = max(0.1 * span, 1e-3 * largest)
    assert first == pytest.approx(last, abs=tolerance)


@pytest.mark.compiled
def test_samples_at_events_are_the_last_of_the_five_seconds_after_the_transient(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The drive point runs ahead of the slider as it slips: its angle grows by Omega - f."""
    monkeypatch.setattr(attractors, "arrival", lambda p, legs: attractors.Arrival(Settling()))
    p = Parameters(N=385, Omega=14, n_diameters=1)
    options = Bifurcation(section="event", transient=0.5, max_transient=0.9, samples=4)
    values, message = options.compute_point(Point(p))
    assert message.startswith("not settled after 0.5 s: undecided")
    begun = simulate(p, 0.5, tol=options.tol)
    later = simulate(p, 5.5, tol=options.tol, initial_state=begun.final_state).events
    released = later[later["kind"] == "stick_to_slip"].iloc[-4:]
    assert values["psi"] == pytest.approx(released["psi"].to_numpy(), rel=1e-9)
    assert values["P"] == pytest.approx(released["P"].to_numpy(), rel=1e-9)
    speed = p.Omega - released["f"].to_numpy()
    assert values["psi_velocity"] == pytest.approx(speed, rel=1e-9)
    assert values["phase"] == ["stick"] * 4
    assert values["kind"] is Outcome.UNDECIDED
    assert values["stick_fraction"] == pytest.approx(begun.statistics["time_stick"] / 0.5, rel=1e-9)


@pytest.mark.parametrize(("releases", "residual"), [(4, 1e-3), (3, np.nan)])
def test_a_residual_needs_an_interval_more_than_the_period(releases: int, residual: float) -> None:
    """Of a cycle of two releases, whose second interval has changed by 1 ms."""
    times = np.array([0.0, 0.1, 0.201, 0.302])[:releases]
    run = SimpleNamespace(
        events=pd.DataFrame({"time": times, "kind": "stick_to_slip"}),
        final_state=SimpleNamespace(time=0.5),
    )
    cycle = SimpleNamespace(releases=2, separations=0)
    near = SimpleNamespace(cycle=cycle, kind=Outcome.STICK_SLIP)
    reached = attractors.Arrival(Settling(), near=near)
    found = bifurcation._motion_reached(SMALL, reached, run, 1e-10)
    assert found.period == 2
    assert found.closure == pytest.approx(residual, nan_ok=True)


def test_all_separations_of_a_transient_are_counted_whatever_its_legs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Contact is lost in each of three legs."""
    p = Parameters(N=385, Omega=15.1, n_diameters=1)
    start = Start(perturbation={"u": 0.02})
    options = Bifurcation(section="event", transient=0.05, max_transient=0.2, samples=1)
    unsettled = attractors.Arrival(Settling())
    monkeypatch.setattr(attractors, "arrival", lambda p, legs: unsettled)
    values, _ = options.compute_point(Point(p, start))
    initial = make_initial_state(p, start, options.tol)
    first = simulate(p, 0.05, tol=options.tol, initial_state=initial)
    whole = simulate(p, 0.2, tol=options.tol, initial_state=initial)
    assert values["transient_time"] == 0.2
    record = simulate(p, 5.2, tol=options.tol, initial_state=whole.final_state)
    lost = values["separations"] - record.statistics["n_separations"]
    early = first.statistics["n_separations"]
    assert lost == whole.statistics["n_separations"]
    assert early > 0
    assert early < lost
    assert values["first_separation"] == first.first_separation


@pytest.mark.compiled
def test_separations_while_samples_are_taken_are_counted() -> None:
    """Contact is first lost at 50.4 s: there were samples at separations, and neither number nor time of
    any."""
    p = Parameters(N=385, Omega=15.1)
    options = Bifurcation(section="event", transient=50, max_transient=50)
    values, _ = options.compute_point(Point(p))

    initial = make_initial_state(p, Start(), 1e-10)
    transient = simulate(p, 50, tol=options.tol, initial_state=initial)
    record = simulate(p, 55, tol=options.tol, initial_state=transient.final_state)
    expected = record.statistics["n_separations"]
    assert transient.statistics["n_separations"] == 0
    assert expected > 0
    assert values["separations"] == expected
    assert values["first_separation"] == record.first_separation
    assert values["phase"] == ["separation"] * options.samples


@pytest.mark.compiled
def test_a_motion_without_an_event_while_samples_are_taken_says_so() -> None:
    """It slides from 34 s on, and loses contact at 53 s."""
    p = Parameters(N=385, Omega=15.1, c_p=1)
    options = Bifurcation(section="event", transient=40, max_transient=40)
    values, message = options.compute_point(Point(p))
    not_settled, no_event, advice = message.split("; ")
    assert not_settled == "not settled after 40 s: changing at 0.025/s"
    assert no_event == "no event in the 5 s sampled after that"
    assert advice == "raise max_transient"
    assert not len(values["psi"])


def test_a_run_that_ends_early_while_samples_are_taken_has_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its few events were samples of a complete one."""
    p = Parameters(N=385, Omega=14, n_diameters=1)
    of_transient_and_record = iter([Status.OK, Status.NON_FINITE])

    def ending(*args: Any, **how: Any) -> Any:
        status = next(of_transient_and_record)
        run = simulate(*args, **how)
        return dataclasses.replace(run, status=status)

    def arrival(p: Parameters, legs: Any) -> attractors.Arrival:
        undecided = Settling()
        return attractors.Arrival(undecided)

    monkeypatch.setattr(api, "simulate", ending)
    monkeypatch.setattr(attractors, "arrival", arrival)
    options = Bifurcation(section="event", transient=0.5, max_transient=0.9, samples=4)
    values, message = options.compute_point(Point(p))
    assert values["status"] == Status.NON_FINITE
    assert values["separations"] == 0
    assert "psi" not in values
    assert message.startswith("the simulation ended early")
