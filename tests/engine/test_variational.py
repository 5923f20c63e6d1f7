"""Small changes of state and parameters, along a motion and through every kind of switch: against differences."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from disc_model import Parameters, plate_modes
from disc_model.engine import layout, outcomes, saltation, switches, tangent
from disc_model.simulation.result import State, engine_case, write_state
from disc_model.stability.return_map import PARAMETERS, ReturnMap
from tests.contact_laws import COMPILES, LAWS
from tests.engine.full_system import Full
from tests.references import stored, taylor
from tests.references.divergence import divergence
from tests.references.printed import MOTIONS, SPAN, Printed, lively

LIVELY = Parameters(
    N=600.0, Omega=15.1, m=0.3, k=8e4, c=5.0, k_p=3e4, c_p=0.5, mu_s=0.5, mu_k=0.1, D_star=1e-3, n_diameters=2
)  # fmt: skip
#: Case, size and seed of the disturbance of the static equilibrium from which the flight starts, and what it is then:
#: (separations, slip reversals, backward releases).
DAMPED = {"n_diameters": 2, "c": 0.05, "c_p": 0.02}
FLIGHTS = {
    "stick and slip": (Parameters(N=200, Omega=20, **DAMPED), 0.1, 1, (0, 0, 0)),
    "separation, slip to and fro": (Parameters(N=100, Omega=2, k_p=1e5, m=0.3, **DAMPED), 1.5, 19, (1, 1, 0)),
    "two separations, release backwards": (Parameters(N=200, Omega=5, **DAMPED), 1.5, 9, (2, 0, 1)),
    # contact is lost in slip at 98 rad/s
    "separation at speed": (Parameters(N=200, Omega=50, **DAMPED), 3.0, 14, (1, 0, 0)),
    # an impact leaves a tension, so that contact is lost again in the same instant
    "separation at an impact": (Parameters(N=200, Omega=20, **DAMPED), 8.0, 36, (3, 0, 1)),
}


def departure(flight: str) -> tuple[ReturnMap, np.ndarray]:
    """A point of the section from which the flight is as told."""
    p, size, seed, _ = FLIGHTS[flight]
    map_ = ReturnMap(p)
    noise = np.random.default_rng(seed).normal(size=map_.size)
    return map_, map_.static + size * np.max(np.abs(map_.static)) * noise


def differences(function, h: float):
    """Derivative at 0, to fourth order."""
    return (function(-2 * h) - 8 * function(-h) + 8 * function(h) - function(2 * h)) / (12 * h)


@pytest.mark.parametrize("flight", list(FLIGHTS))
def test_jacobian_of_a_flight(flight: str) -> None:
    map_, x = departure(flight)
    how, h = {"may_separate": True}, 1e-6 * np.linalg.norm(x)
    log, _, jacobian, _ = map_.evaluate(x, **how)
    assert log.outcome == outcomes.RETURNED
    assert (log.counts.separations, log.counts.reversals, log.counts.backward_releases) == FLIGHTS[flight][3]
    # three directions that mix all coordinates: a wrong entry of the matrix shows in each
    for direction in np.random.default_rng(0).normal(size=(3, map_.size)) / np.sqrt(map_.size):
        expected = differences(lambda s, d=direction: map_.evaluate(x + s * d, tangent=False, **how)[1], h)
        assert np.linalg.norm(jacobian @ direction - expected) < 1e-6 * np.linalg.norm(expected)


@pytest.mark.parametrize("flight", list(FLIGHTS))
def test_derivatives_of_a_flight_by_parameters(flight: str) -> None:
    check_derivatives(*departure(flight), lambda name: 1e-2 if name in ("c", "c_p") else 1e-4)


def check_derivatives(map_: ReturnMap, x: np.ndarray, step: Callable[[str], float]) -> None:
    """Derivatives of where a flight ends by all parameters, against differences of steps relative to their values."""
    p, how = map_.parameters, {"may_separate": True}
    _, _, _, by = ReturnMap(p, parameters=PARAMETERS).evaluate(x, **how)
    for i, name in enumerate(PARAMETERS):
        value = getattr(p, name)

        def end(change: float, name: str = name, value: float = value) -> np.ndarray:
            other = ReturnMap(p.replace(**{name: value + change}))
            # the same displacements and velocities, whatever the frequencies
            reached = other.evaluate(x / map_.scale * other.scale, tangent=False, **how)[1]
            return reached / other.scale * map_.scale

        expected = differences(end, step(name) * value)
        assert np.linalg.norm(by[:, i] - expected) < 1e-5 * np.linalg.norm(expected), name


class Disturbed(Full):
    """A start whose coordinates may be moved: u and u' are some in separation, f is none in stick."""

    def __init__(self, p: Parameters, start: State) -> None:
        scalars = {"stick": 1, "slip": 2, "separation": 4}[start.phase]
        super().__init__(p, start, scalars=4 if p.contact_compliance else scalars)

    def moved(self, change: np.ndarray) -> None:
        rows = np.zeros(self.n_rows)
        rows[self.rows] = change
        self.state.disc[: self.n_rows - 4] += rows[:-4]
        self.state.x[layout.PSI : layout.U_VELOCITY + 1] += rows[-4:]

    def at_end(self, tangent: bool = False) -> np.ndarray:
        """The coordinates at the end of the span, or their derivatives by those at the start."""
        assert self.fly(SPAN, tangent=tangent) == outcomes.TIME_OVER
        return self.columns if tangent else self.coordinates


def jacobian(p: Parameters, start: State, reached: Callable[[Disturbed], np.ndarray]) -> np.ndarray:
    """Derivatives of what a disturbed start leads to by its coordinates: one column each."""

    def moved(i: int, change: float) -> np.ndarray:
        other = Disturbed(p, start)
        other.moved(change * np.eye(len(other.rows))[i])
        return reached(other)

    steps = 1e-3 * np.maximum(np.abs(Disturbed(p, start).coordinates), 1e-4)
    return np.array([differences(lambda h, i=i: moved(i, h), step) for i, step in enumerate(steps)]).T


@pytest.mark.parametrize(("phase", "direction", "n_circles"), [*((*motion, 0) for motion in MOTIONS), ("slip", 1, 1)])
def test_columns_along_one_phase(phase: str, direction: int, n_circles: int) -> None:
    """With a circle there are two modes without nodal diameter."""
    p = LIVELY.replace(n_circles=n_circles)
    check_columns(p, lively(phase, direction, p))


@pytest.mark.parametrize("law", [pytest.param(law, marks=COMPILES) for law in LAWS])
@pytest.mark.parametrize(("phase", "direction"), [motion for motion in MOTIONS if "separation" not in motion])
def test_columns_along_one_phase_under_other_laws_of_contact(law: str, phase: str, direction: int) -> None:
    p = LIVELY.replace(**LAWS[law])
    start = lively(phase, direction, p)
    check_columns(p, start.replace(u=start.u - p.contact_compliance * p.N))


def check_columns(p: Parameters, start: State) -> None:
    """Columns of all coordinates over a span, against differences of motions."""
    got, expected = Disturbed(p, start).at_end(tangent=True), jacobian(p, start, Disturbed.at_end)
    if start.phase == "stick" and p.contact_compliance:
        # f, which stands before u and u', is no coordinate then
        got, expected = np.delete(got, -3, axis=1), np.delete(expected, -3, axis=1)
    size = np.abs(got) + np.abs(expected) + 1e-4 * np.max(np.abs(expected), axis=1, keepdims=True)
    assert np.all(np.abs(got - expected) <= 1e-5 * size)


def test_jacobian_of_an_impact() -> None:
    """With a circle there are two modes without nodal diameter, each with its own share of the impulse."""
    p = LIVELY.replace(n_circles=1)
    start = lively("separation", 0, p)
    run = Disturbed(p, start)
    saltation.impact_change(run.model, run.state, run.tangent)
    n = len(run.rows) - 2  # u and u' are the disc's from now on

    def after(other: Disturbed) -> np.ndarray:
        assert switches.touch_down(other.model, other.state) == outcomes.CONSISTENT
        return other.coordinates[:n]

    expected = jacobian(p, start, after)
    # bilinear: nothing but rounding of values over steps
    np.testing.assert_allclose(run.columns[:n], expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
def test_rates_are_those_of_the_paper(phase: str, direction: int) -> None:
    start = lively(phase, direction, LIVELY)
    got, wanted = Disturbed(LIVELY, start).rates, Printed(LIVELY, start).rates()
    pair = plate_modes(LIVELY)["diameters"].to_numpy() > 0
    modal = [wanted["a"][pair], wanted["b"][pair], wanted["alpha"][pair], wanted["beta"][pair]]
    expected = [*modal, wanted["a"][~pair], wanted["alpha"][~pair], [wanted["psi"], wanted["f"]]]
    names = ["u", "u_velocity"] if phase == "separation" else []
    expected = np.concatenate([*expected, [wanted[name] for name in names]])
    np.testing.assert_allclose(got, expected[: len(got)], rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("law", ["normal", "compliant_normal"])
@pytest.mark.parametrize(("phase", "direction"), [("stick", 0), ("slip", 1), ("slip", -1)])
def test_rates_under_the_normal_force(law: str, phase: str, direction: int) -> None:
    """Five pairs of modes fill one block of lanes and begin another."""
    p = LIVELY.replace(n_diameters=5, n_circles=1, **LAWS[law])
    start, case = lively(phase, direction, p), engine_case(p)
    start = start.replace(u=start.u - 500 * p.contact_compliance)
    run, reference = Full(p, start, scalars=4), stored.reference_state(start, p)
    step = taylor.Step(taylor.problem_of(p), phase, direction, reference)
    sign = np.sign(plate_modes(p)["psi"].to_numpy())
    modal = np.concatenate([sign * x[1] for x in (step.a, step.b, step.alpha, step.beta)])
    expected = np.zeros(run.n_rows)
    expected[case.places] = modal[case.present]
    expected[-4:] = step.psi[1], step.f[1], step.u[1], step.v[1]
    # sums of terms that cancel: rounding of velocities' rates
    np.testing.assert_allclose(run.rates, expected[run.rows], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
def test_divergence_is_the_trace(phase: str, direction: int) -> None:
    start = lively(phase, direction, LIVELY)
    run = Disturbed(LIVELY, start)
    n = len(run.rows) - (2 if phase == "separation" else 0)
    trace = np.trace(jacobian(LIVELY, start, lambda other: other.rates)[:n, :n])
    assert divergence(run.model, run.state) == pytest.approx(trace, rel=1e-7)


# ------------------------------------------------------------------------------------ when a switch happens
def switch_function(cause: int, p: Parameters, state: State) -> float:
    """What falls to zero at a switch, from the paper's equations; contact is lost where P's numerator is zero."""
    printed = Printed(p, state)
    if cause == switches.AT_REST:
        return state.f
    if cause == switches.GAP_CLOSED:
        return float(printed.literal.gap(0)(0.0, printed.y))
    if cause == switches.CONTACT_LOST:
        modes = plate_modes(p)
        slope = float(modes["psi"] @ (modes["diameters"] * state.b))
        friction = state.direction * p.mu_k * slope / p.r_0
        return float(printed.force() * (1 + p.m * modes["psi"] @ modes["psi"] + friction))
    side = 1 if cause == switches.RELEASE_FORWARD else -1
    return float(p.mu_s * printed.force() - side * p.r_0 * printed.literal.pull(0.0, printed.y))


SWITCHES = {
    "at rest": (switches.AT_REST, "slip", 1),
    "contact lost": (switches.CONTACT_LOST, "slip", 1),
    "contact lost, slip backwards": (switches.CONTACT_LOST, "slip", -1),
    "contact lost in stick": (switches.CONTACT_LOST, "stick", 0),
    "release forwards": (switches.RELEASE_FORWARD, "stick", 0),
    "release backwards": (switches.RELEASE_BACKWARD, "stick", 0),
    "gap closed": (switches.GAP_CLOSED, "separation", 0),
}


def changes(model: layout.Model, state: layout.State, t: tangent.Tangent, cause: int) -> np.ndarray:
    """Changes of a switch function for all columns: minus the change of its time by its rate."""
    t.before[:] = t.now[: len(t.before)]  # any motion gives a rate; that of the first column, which has one
    t.before.reshape(-1, 8)[:, 1:] = 0.0
    rate = saltation.switch_times(model, state, t, cause)
    return -t.tau * rate


@pytest.mark.parametrize("switch", SWITCHES)
def test_changes_of_the_switch_functions(switch: str) -> None:
    """By every coordinate.  Where P falls to zero they cancel in the columns, since no rate jumps there."""
    cause, phase, direction = SWITCHES[switch]
    start = lively(phase, direction, LIVELY)
    run = Disturbed(LIVELY, start)
    n = len(run.rows)
    columns = np.eye(n)
    columns[:, 0] += columns[:, 1:].sum(axis=1)
    run.set_columns(columns)
    got = changes(run.model, run.state, run.tangent, cause)[:n]
    got[0] -= got[1:].sum()
    modes = plate_modes(LIVELY)
    pair = np.flatnonzero(modes["diameters"])
    single = np.flatnonzero(modes["diameters"] == 0)
    modal = [("a", pair), ("b", pair), ("alpha", pair), ("beta", pair), ("a", single), ("alpha", single)]
    names = [(name, int(i)) for name, where in modal for i in where]
    names += [(name, None) for name in ("psi", "f", "u", "u_velocity")][: n - len(names)]

    def value(name: str, row: int | None, change: float) -> float:
        moved = getattr(start, name) + (change if row is None else change * np.eye(len(modes))[row])
        return switch_function(cause, LIVELY, start.replace(**{name: moved}))

    sizes = {"a": 1e-6, "b": 1e-6, "alpha": 1e-3, "beta": 1e-3, "psi": 1e-5, "f": 1e-2, "u": 1e-6, "u_velocity": 1e-3}
    expected = np.array([differences(lambda h, at=at: value(*at, h), sizes[at[0]]) for at in names])
    noise = np.array([1e-12 * LIVELY.N / sizes[name] for name, _ in names])
    assert np.any(expected)
    np.testing.assert_array_less(np.abs(got - expected), 1e-7 * np.abs(expected) + noise + 1e-300)


@pytest.mark.parametrize("switch", SWITCHES)
def test_changes_of_the_switch_functions_by_parameters(switch: str) -> None:
    cause, phase, direction = SWITCHES[switch]
    start = lively(phase, direction, LIVELY)
    map_ = ReturnMap(LIVELY, parameters=PARAMETERS)
    model, state, t = map_.model, layout.build_state(map_.model), map_._tangent
    write_state(engine_case(LIVELY), start, state)
    t.now[:] = 0.0
    # a change of every coordinate in the first column: it has a rate, whatever the switch function
    t.now.reshape(-1, tangent.n_rows(model), 8)[0, :, 0] = 1.0
    got = changes(model, state, t, cause)[map_._first :][: len(PARAMETERS)]
    for change, name in zip(got, PARAMETERS, strict=True):
        value = getattr(LIVELY, name)

        def function(h: float, name: str = name, value: float = value) -> float:
            return switch_function(cause, LIVELY.replace(**{name: value + h}), start)

        expected = differences(function, 1e-4 * value)
        assert change == pytest.approx(expected, rel=1e-6, abs=1e-9 * LIVELY.N / value), name
