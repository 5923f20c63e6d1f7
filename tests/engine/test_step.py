"""The event that ends a step, by series that are given; the clock."""

from fractions import Fraction

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.engine import step
from disc_model.engine.model import Model, build_state, on_ramp
from disc_model.engine.series import build_series
from disc_model.engine.state import (
    DIRECTION,
    KNOWN,
    KNOWN_FORCE,
    PHASE,
    PHI_RATE,
    PSI,
    SEPARATION,
    SLIP,
    STICK,
    TIME,
    TIME_LOW,
    EngineState,
)
from disc_model.engine.step import Step
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


def resting(model: Model, phase: int, direction: int, rate: float = 0.0) -> EngineState:
    """A phase that begins on a resting disc."""
    state = build_state(model)
    state.x[[PHASE, DIRECTION, PHI_RATE]] = phase, direction, rate
    return state


def first_event(model: Model, phase: int, coefficients: Coefficients) -> tuple[float, int]:
    """Place and cause of the end of a phase that begins on a resting disc, within a unit of time:
    coefficients of series by name, and numbers of the state by place."""
    state = resting(model, phase, int(phase == SLIP))
    series = build_series(model, ORDER)
    for function in (series.switch, series.switch2, series.P):
        function[0] = 1.0
    for name, values in coefficients.items():
        if isinstance(name, int):
            state.x[name] = values[0]
        else:
            function = getattr(series, name)
            function[: len(values)] = values
    return step.first_event(model, series, state, ORDER, 1.0, TOLERANCE)


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
    # the smallest coefficients that count as zero move a root a little
    found = first_event(engine_case(p).model, phase, coefficients)
    assert found == (pytest.approx(place, rel=1e-6), cause)


@pytest.mark.parametrize("rate", [pytest.param(r, marks=COMPILES) for r in (0.0, 2.0)])
def test_a_drive_that_begins_to_move_pulls(rate: float) -> None:
    model = engine_case(REST.replace(c_p=P.k_p)).model
    model = on_ramp(model, 0.0, 0.0, Omega=0.0, N=REST.N, Omega_rate=rate, N_rate=1.0)
    _, cause = first_event(model, STICK, UNLOADED)
    assert cause == (RELEASE_FORWARD if rate else CONTACT_LOST)


@pytest.mark.parametrize(
    ("speed", "rate", "place"),
    [
        # within errors of the release: of g, and, at a smooth one, of g' too
        (-0.9, None, 0.5),
        (-0.9, -0.9, 0.5),
        # more than an error
        (-1.1, None, 0.0),
        (-0.9, -1.1, 0.0),
    ],
)
def test_slip_that_has_just_begun_does_not_end_by_errors_of_its_start(
    speed: float, rate: float | None, place: float
) -> None:
    """Pull and friction err by the tolerance, and accelerate the slider."""
    model = engine_case(P).model
    force = P.c_p * P.Omega + P.mu_k * P.N / P.r_0
    error = TOLERANCE * model.unit / P.m * force
    start = speed * (error + TOLERANCE * P.Omega)
    slip: tuple[float, ...] = (start, 1e6, -2e6)
    if rate:
        slip = (start, rate * error, 1e9, -2e9)
    found, cause = first_event(model, SLIP, {"switch": slip})
    assert found == pytest.approx(place, rel=1e-6)
    assert cause == AT_REST


def test_the_clock_loses_nothing_by_rounding() -> None:
    """A thousand steps beside a time of 100 s, whose rounding is 1e-14 s each."""
    model = engine_case(P).model
    state = build_state(model)
    state.x[TIME] = 100.0
    exact = Fraction(100)
    for length in np.linspace(0.1, 3.0, 1000).tolist():
        assert step.advance_clock(model, state, Step(0, ORDER, length, NOTHING))
        exact += Fraction(length * model.unit)
    time = Fraction(float(state.x[TIME])) + Fraction(float(state.x[TIME_LOW]))
    assert abs(time - exact) < 1e-17
    assert not step.advance_clock(model, state, Step(0, ORDER, 0.0, NOTHING))
