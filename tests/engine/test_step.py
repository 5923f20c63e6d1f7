"""The event that ends a step, by series that are given; the clock and its counts."""

from fractions import Fraction
from typing import NamedTuple, Self

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.engine import step, transitions
from disc_model.engine.dense_output import CLOSED_FORM
from disc_model.engine.model import Model, build_state, on_ramp
from disc_model.engine.series import Series, build_series
from disc_model.engine.state import (
    DIRECTION,
    IN_A_ROW,
    KNOWN,
    KNOWN_FORCE,
    PHASE,
    PHI_RATE,
    PROPAGATED,
    PSI,
    SEPARATION,
    SLIP,
    STICK,
    TIME,
    TIME_LOW,
    EngineState,
)
from disc_model.engine.step import Step
from disc_model.engine.stick_modes import LONGEST_STICK
from disc_model.engine.transitions import (
    AT_REST,
    CONTACT_LOST,
    GAP_CLOSED,
    NOTHING,
    RELEASE_BACKWARD,
    RELEASE_FORWARD,
)
from disc_model.simulation.states import engine_case
from tests.contact_laws import COMPILES

ORDER = 12
TOLERANCE = 1e-3
"""Of the series: so large that rounding is nothing beside it."""

P = Parameters(N=200, Omega=10, n_diameters=1, c_p=0.5)
COMPLIANT = P.replace(contact_compliance=1e-6)


REST = P.replace(Omega=0)
SURFACE = REST.replace(friction_offset=0.01)
Coefficients = dict[str | int, tuple[float, ...]]


class Begun(NamedTuple):
    """A phase that begins, on a resting disc; functions of the event have to be set."""

    model: Model
    series: Series
    state: EngineState

    def put(self, coefficients: Coefficients) -> Self:
        """Set coefficients of series, by name, and numbers of the state, by place."""
        for name, values in coefficients.items():
            if isinstance(name, int):
                self.state.x[name] = values[0]
            else:
                put(getattr(self.series, name), *values)
        return self

    def first(self) -> tuple[float, int]:
        """Place and cause of the end within a unit of time."""
        model, series, state = self
        return step.first_event(model, series, state, ORDER, 1.0, TOLERANCE)

    def expect(self, place: float, cause: int) -> None:
        """Compare the end; the smallest coefficients that count as zero move a root a little."""
        assert self.first() == (pytest.approx(place, rel=1e-6), cause)


def begun(p: Parameters, phase: int, direction: int = 0) -> Begun:
    model = engine_case(p).model
    state = build_state(model)
    state.x[PHASE] = phase
    state.x[DIRECTION] = direction
    case = Begun(model, build_series(model, ORDER), state)
    for function in (case.series.switch, case.series.switch2, case.series.P):
        function[0] = 1.0
    return case


def put(function: np.ndarray, *coefficients: float) -> None:
    function[:] = 0.0
    function[: len(coefficients)] = coefficients


# ---- the event that is first

UNLOADED: Coefficients = {"P": (1, -4), "switch": (1, -4)}
"""Force and release function vanish together."""
EVENTS: list[tuple[Parameters, int, Coefficients, float, int]] = [
    (P, SLIP, {}, 1, NOTHING),
    (P, SLIP, {"switch": (1, -2)}, 0.5, AT_REST),
    (P, SLIP, {"switch": (1, -2), "P": (1, -4)}, 0.25, CONTACT_LOST),
    (P, SLIP, {"switch": (1, -8), "P": (1, -4)}, 0.125, AT_REST),
    (P.replace(contact="bilateral"), SLIP, {"P": (1, -4)}, 1, NOTHING),
    (P, SLIP, {KNOWN: (1,), "switch": (-1, 1e3, -2e3)}, 0.5, AT_REST),
    (COMPLIANT, SLIP, {KNOWN_FORCE: (1,), "P": (-1e6, 1e9, -2e9)}, 0.5, CONTACT_LOST),
    (P, SEPARATION, {}, 1, NOTHING),
    (P, SEPARATION, {"switch": (1, -2), "P": (1, -4)}, 0.5, GAP_CLOSED),
    (P, SEPARATION, {KNOWN: (3,), "switch": (-1, 0, 0, 1e9, -2e9)}, 0.5, GAP_CLOSED),
    (P, SEPARATION, {"switch": (0, 0, 0, -1)}, 0, GAP_CLOSED),
    (P, STICK, {"P": (1, -4)}, 1, NOTHING),  # friction would have ended before
    (P, STICK, {"P": (1, -4), "switch": (1, -2)}, 0.5, RELEASE_FORWARD),
    (P, STICK, {"switch": (1,), "switch2": (2, -4)}, 1, NOTHING),  # nothing pulls it backwards
    (P, STICK, {"switch": (3,), "switch2": (2, -4)}, 0.5, RELEASE_BACKWARD),
    (P.replace(mu_s=0, mu_k=0), STICK, {"P": (1, -4)}, 0.25, CONTACT_LOST),
    # the least pull ends stick by slip
    (P, STICK, UNLOADED, 0.25, RELEASE_FORWARD),
    (REST, STICK, UNLOADED, 0.25, CONTACT_LOST),
    (P.replace(k_p=0, c_p=0), STICK, UNLOADED, 0.25, CONTACT_LOST),
    (REST, STICK, UNLOADED | {PSI: (1e-9,)}, 0.25, RELEASE_FORWARD),
    (SURFACE, STICK, UNLOADED, 0.25, CONTACT_LOST),
    (SURFACE, STICK, UNLOADED | {"hold": (1,)}, 0.25, RELEASE_FORWARD),
    (SURFACE, STICK, UNLOADED | {"hold": (0, 1)}, 0.25, RELEASE_FORWARD),
]


@pytest.mark.parametrize(("p", "phase", "coefficients", "place", "cause"), EVENTS)
def test_the_first_event_ends_a_step(
    p: Parameters, phase: int, coefficients: Coefficients, place: float, cause: int
) -> None:
    begun(p, phase, int(phase == SLIP)).put(coefficients).expect(place, cause)


@pytest.mark.parametrize("rate", [pytest.param(r, marks=COMPILES) for r in (0.0, 2.0)])
def test_a_drive_that_begins_to_move_pulls(rate: float) -> None:
    case = begun(REST.replace(c_p=P.k_p), STICK).put(UNLOADED)
    ramp = {"Omega": 0.0, "N": REST.N, "Omega_rate": rate, "N_rate": 1.0}
    case = case._replace(model=on_ramp(case.model, 0.0, 0.0, **ramp))
    case.expect(0.25, RELEASE_FORWARD if rate else CONTACT_LOST)


# ---- errors where a phase begins


def test_slip_that_has_just_begun_does_not_end_by_errors_of_its_start() -> None:
    """They are of the release: of g, and, at a smooth one, of g' too."""
    case = begun(P, SLIP, 1)
    error = transitions.slip_error(case.model, case.state, TOLERANCE)
    of_speed = error + 0.5 * TOLERANCE * P.Omega
    put(case.series.switch, -of_speed, 1e6, -2e6)
    case.expect(0.5, AT_REST)
    put(case.series.switch, -of_speed, -0.5 * error, 1e9, -2e9)
    case.expect(0.5, AT_REST)
    # rounding above zero, and then below it for a moment
    rounding = transitions.slip_error(case.model, case.state, 0.0)
    above = rounding + 0.5 * transitions.ROUNDING * P.Omega
    rise = 0.02 * error**2 / above
    put(case.series.switch, above, -0.5 * error, rise, -2.0 * rise)
    case.expect(0.5, AT_REST)


def test_slip_ends_where_it_begins_if_more_than_an_error_says_so() -> None:
    case = begun(P, SLIP, 1)
    error = transitions.slip_error(case.model, case.state, TOLERANCE)
    of_speed = error + 0.5 * TOLERANCE * P.Omega
    put(case.series.switch, -2.0 * error - 2.0 * TOLERANCE * P.Omega, 1e6, -2e6)
    assert case.first() == (0.0, AT_REST)
    put(case.series.switch, -of_speed, -2.0 * error, 1e9, -2e9)
    assert case.first() == (0.0, AT_REST)


@pytest.mark.parametrize("p", [P, COMPLIANT])
def test_compliant_contact_that_has_just_begun_is_not_lost_by_an_error(p: Parameters) -> None:
    """Its force starts at zero; that of rigid contact does not."""
    case = begun(p, SLIP, 1)
    error = TOLERANCE * p.N
    put(case.series.P, -0.5 * error, 1e6, -2e6)
    case.expect(0.5 if p.contact_compliance else 0.0, CONTACT_LOST)
    put(case.series.P, -2.0 * error, 1e6, -2e6)
    assert case.first() == (0.0, CONTACT_LOST)
    put(case.series.P, -0.5 * error, -1e6, 2e6)
    assert case.first() == (0.0, CONTACT_LOST)


@pytest.mark.parametrize(
    ("phase", "limited"), [pytest.param(*each, marks=COMPILES) for each in ((SLIP, 1), (STICK, 0))]
)
def test_small_changes_go_in_steps_that_their_growth_allows(phase: int, limited: int) -> None:
    """Where friction falls steeply, a change of slow slip grows faster than anything moves."""
    p = P.replace(friction_decay=1e5)
    case = begun(p, phase, limited)
    speed = 1e-6 * limited
    case.state.x[PHI_RATE] = speed
    model, series, state = case
    planned = step.series_step(model, series, state, ORDER, TOLERANCE, 1e-3, np.inf)
    fall = (p.mu_s - p.mu_k) * p.friction_decay / (1.0 + p.friction_decay * p.r_0 * speed) ** 2
    growth = series.P[0] * fall / p.m * model.unit
    assert growth > 10.0
    wanted = 1e-3
    if limited:
        wanted /= growth
    assert planned.length == pytest.approx(wanted)


# ------------------------------------------------------------------------------------- separation


CLOSING = 0.1
"""Time in which an error of the gap's acceleration closes the gap."""


@pytest.mark.parametrize("order", [0, 1, 2])
def test_a_gap_that_has_just_opened_does_not_close_by_errors_of_its_start(order: int) -> None:
    """Of the acceleration, and of what it closes before the gap's third derivative opens it."""
    case = begun(P, SEPARATION)
    of_acceleration = transitions.gap_error(case.model, case.state, 2, TOLERANCE)
    opening = of_acceleration / CLOSING
    error = opening * CLOSING ** (3 - order)
    gap = [0.0, 0.0, 0.0, opening, -1.25 * opening]
    gap[order] = -0.9 * error
    put(case.series.switch, *gap)
    case.expect(0.8, GAP_CLOSED)
    gap[order] = -1.5 * error
    put(case.series.switch, *gap)
    assert case.first() == (0.0, GAP_CLOSED)


# ------------------------------------------------------------------------------------- stick


# ------------------------------------------------------------------------------------- the clock
def test_the_clock_loses_nothing_by_rounding() -> None:
    """A thousand steps beside a time of 100 s, whose rounding is 1e-14 s each."""
    model, _, state = begun(P, SLIP, 1)
    state.x[TIME] = 100.0
    exact = Fraction(100)
    for length in np.linspace(0.1, 3.0, 1000).tolist():
        assert step.advance_clock(model, state, Step(0, ORDER, length, NOTHING))
        exact += Fraction(length * model.unit)
    time = Fraction(float(state.x[TIME])) + Fraction(float(state.x[TIME_LOW]))
    assert abs(time - exact) < 1e-17
    assert not step.advance_clock(model, state, Step(0, ORDER, 0.0, NOTHING))


@pytest.mark.parametrize(("part", "left"), [(0.5, 1.0), (2.0, 0.0)])
def test_a_run_that_is_cut_at_once_keeps_the_roots_of_its_start(part: float, left: float) -> None:
    model, _, state = begun(P, SLIP, 1)
    state.x[KNOWN] = 1.0
    state.x[KNOWN_FORCE] = 1.0
    step.advance_clock(model, state, Step(0, ORDER, part * step.JUST_BEGUN, NOTHING))
    assert state.x[KNOWN] == left
    assert state.x[KNOWN_FORCE] == left


@pytest.mark.parametrize(
    ("order", "length", "after"),
    [
        (CLOSED_FORM, LONGEST_STICK, 0.0),
        (CLOSED_FORM, 7.0, step.JUST_PROPAGATED),
        (ORDER, 7.0, 1.0),
    ],
)
def test_the_closed_form_is_used_once_before_a_release(
    order: int, length: float, after: float
) -> None:
    """A short series follows it, and the closed form only after a longest step."""
    case = begun(P, STICK)
    step.advance_clock(case.model, case.state, Step(0, order, length, NOTHING))
    assert case.state.x[PROPAGATED] == after
    low = step.ORDER_BEFORE_RELEASE if after == step.JUST_PROPAGATED else ORDER
    assert step.sufficient_order(case.model, case.state, ORDER) == low
    allowed = step.closed_form_length_within(case.model, case.series, case.state, 6.0)
    assert allowed == (6.0 if after == 0.0 else 0.0)
    case.state.x[PHASE] = SLIP
    assert step.closed_form_length_within(case.model, case.series, case.state, 6.0) == 0.0


@pytest.mark.parametrize(
    ("phase", "direction", "rate", "after"),
    [(SLIP, 1, -1e-9, 0.0), (SLIP, -1, 1e-9, 0.0), (SLIP, 1, 1e-9, 1e-9), (STICK, 1, -1.0, -1.0)],
)
def test_slip_beyond_its_end_is_at_rest(
    phase: int, direction: int, rate: float, after: float
) -> None:
    _, _, state = begun(P, phase, direction)
    state.x[PHI_RATE] = rate
    step.settle(state)
    assert state.x[PHI_RATE] == after


def test_events_at_one_instant_are_counted() -> None:
    _, _, state = begun(P, STICK)
    state.x[IN_A_ROW] = step.MAX_EVENTS_IN_A_ROW - 1.0
    assert not step.stalls(state, False)
    assert step.stalls(state, False)
    assert not step.stalls(state, True)
    assert state.x[IN_A_ROW] == 0.0
