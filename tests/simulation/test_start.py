"""Motions that begin where another one ended, or with a kick."""

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from disc_model import Parameters, Window, deflection, floquet, initial_state, outcome, simulate
from disc_model.data.variables import PHASES
from disc_model.disc.plate import mode_arrays
from disc_model.simulation.states import State, perturb, static_start
from tests.contact_laws import LAWS
from tests.references.printed import Printed
from tests.refusals import refusal

P = Parameters(N=385, Omega=13)
KICK = {"u": -2.75e-3, "u_velocity": 1.375}
PRERUN = {"parameters": {"Omega": 14.0}, "time": 0.5}


def test_a_start_is_a_state() -> None:
    before = simulate(P.replace(Omega=14.0), 0.5).final_state.replace(time=0.0)
    assert initial_state(P) == static_start(P)
    assert initial_state(P, KICK) == perturb(P, static_start(P), **KICK)
    assert initial_state(P, {"prerun": PRERUN}) == before
    assert initial_state(P, KICK | {"prerun": PRERUN}) == perturb(P, before, **KICK)

    reached = outcome(P, 45, start=KICK)
    run = simulate(P, 45, initial_state=initial_state(P, KICK))
    # both compute the same steps up to the event
    assert reached["first_separation"].item() == pytest.approx(run.first_separation, rel=1e-12)


PRERUNS: list[tuple[dict[str, float], str]] = [
    ({"Omga": 3}, "start.prerun.parameters.Omga=3"),
    ({"n_diameters": 2}, "start.prerun.parameters=.*must leave the modes of the disc"),
    ({"r_0": 0.09}, "start.prerun.parameters=.*must leave the modes of the disc"),
    ({"mu_k": 0.9}, "mu_k=0.9"),
]


@pytest.mark.parametrize(
    ("given", "fault"),
    [
        ({"start": {"v": 1.0}}, "start.v=1: unknown key"),
        *(
            ({"start": {"prerun": {"parameters": other, "time": 1}}}, fault)
            for other, fault in PRERUNS
        ),
        ({"tol": 0}, "tol=0: must be >= 1e-15"),
    ],
)
def test_a_wrong_start_is_named_as_an_argument(given: Any, fault: str) -> None:
    with refusal(fault):
        initial_state(P, **given)


# ---- the modes that a state belongs to

ORTHONORMAL = Parameters(N=800, Omega=30, normalization="orthonormal")
USES: list[Callable[[State], Any]] = [
    lambda state: simulate(ORTHONORMAL, 0.101, initial_state=state),
    lambda state: simulate(ORTHONORMAL, 0.101, initial_state=state.replace(time=0.0)),
    lambda state: floquet(ORTHONORMAL, guess=state),
    lambda state: deflection(ORTHONORMAL, state, 0.1, 0.0),
]


@pytest.mark.parametrize("use", USES)
def test_a_state_of_other_modes_is_refused(use: Callable[[State], Any]) -> None:
    """On another processor one mode had the other sign, and the state went on as another motion."""
    state = simulate(ORTHONORMAL, 0.1).final_state
    assert state.mode_amplitudes is not None
    for factor in (np.array([1.0, 1.0, 1.0, -1.0, 1.0]), 1 + 1e-6):
        with refusal(r"(must be psi of plate_modes|must be states of the case)"):
            use(state.replace(mode_amplitudes=factor * state.mode_amplitudes))


def test_a_state_of_nearly_these_modes_or_by_hand_is_taken() -> None:
    """Other processors make modes differ by 1e-13."""
    state = simulate(ORTHONORMAL, 0.1).final_state
    near = (1 + 1e-12) * mode_arrays(ORTHONORMAL).psi
    for amplitudes in (near, None):
        start = state.replace(mode_amplitudes=amplitudes)
        assert simulate(ORTHONORMAL, 0.11, initial_state=start).status.complete


# ---- at a switch

APART = Parameters(N=385, Omega=15.1)
COMPLIANT = LAWS["compliant_normal"]


@functools.cache
def first_loss(**changes: object) -> State:
    """The first loss of contact of a case, after a kick that brings it soon."""
    p = APART.replace(**changes)
    start = perturb(p, static_start(p), u=-0.02)
    return simulate(p, 1.0, initial_state=start, stop_at="first_separation").final_state


def test_a_switch_continued_under_its_own_parameters_keeps_its_bits() -> None:
    state = first_loss()
    start = perturb(APART, static_start(APART), u=-0.02)
    whole = simulate(APART, state.time + 0.05, initial_state=start).event_rows
    expected = whole[whole[:, 0] > state.time]
    assert len(expected) > 3
    for given in (state, state.replace(time=state.time, time_low=state.time_low)):
        rest = simulate(APART, state.time + 0.05, initial_state=given)
        np.testing.assert_array_equal(rest.event_rows, expected)


@pytest.mark.parametrize(
    "change",
    [
        *({"N": N} for N in (386.0, 435.0, 384.0, 200.0)), {"k": 1e5}, {"k": 1e3}, {"m": 0.09},
        {"m": 0.2}, {"c": 100.0}, {"E": 160e9},
        *(pytest.param(COMPLIANT | more, marks=pytest.mark.compiled)
          for more in ({}, {"N": 500.0}, {"N": 300.0}, {"contact_compliance": 2e-6})),
    ],
    ids=str,
)  # fmt: skip
def test_a_switch_continued_under_other_parameters_is_one_of_these(change: dict[str, Any]) -> None:
    """The contact force vanishes under the former ones alone: the slider went into the disc, by up
    to 0.2 mm."""
    p = APART.replace(**change)
    compliant = "contact_compliance" in change
    lost = first_loss(**COMPLIANT) if compliant else first_loss()
    start = lost.replace(time=0.0)
    force = -1.0  # a compliant contact keeps its distance
    if not compliant:
        # by formulas that share nothing with the engine
        force = Printed(p, start.replace(phase="slip", direction=1)).force()
    run = simulate(p, 2e-3, {"w": Window(stop=2e-3, rate=1e6)}, initial_state=start)
    samples = run.samples["w"]
    apart = samples["phase"] == PHASES.index("separation")
    assert apart[0] == (force <= 0)
    assert samples["P"][0] == pytest.approx(max(force, 0.0), rel=1e-9)
    # as far as rounding goes: the disc's deflection is some millimetres
    gap = samples["u"] - samples["w"]
    assert gap[apart if compliant else ...].min(initial=0) > -1e-15
    assert samples["P"].min() >= 0


def test_a_switch_continued_under_other_parameters_keeps_the_digits_of_its_clock() -> None:
    """The phase is found by a run of no duration, with a clock of fewer digits."""
    p = APART.replace(N=386.0)
    late = first_loss().replace(time=1e6)
    digit = math.ulp(late.time)
    starts = [late.replace(time_low=low) for low in (0.0, digit)]
    ends = [simulate(p, 1e6 + 1e-3, initial_state=start).final_state for start in starts]
    speed = p.Omega - ends[0].f
    assert abs(speed) > 1
    # the second run is shorter by a digit of the clock
    assert ends[0].psi - ends[1].psi == pytest.approx(speed * digit, rel=1e-3)


# ---- kicks, and states of other cases


def height(p: Parameters, state: State) -> float:
    """Of the disc under the slider."""
    return float(mode_arrays(p).psi @ state.a)


def test_a_kick_moves_slider_and_disc_as_a_steady_force_would() -> None:
    """In that shape a kick is the static deflection of another preload."""
    start, other = (static_start(p) for p in (P, P.replace(N=200)))
    there = perturb(P, start, u=other.u - start.u)
    assert there.u - start.u == pytest.approx(height(P, there) - height(P, start), rel=1e-12)
    np.testing.assert_allclose(there.a, other.a, rtol=1e-12)
    hit = perturb(P, start, u_velocity=0.2)
    assert mode_arrays(P).psi @ hit.alpha == pytest.approx(0.2, rel=1e-12)
    # both have this velocity at once: contact does not end
    assert not len(simulate(P, 1e-6, initial_state=hit).event_rows)


@pytest.mark.parametrize(
    ("before", "f", "after"),
    [
        (("stick", 0, 0.0), 3.0, ("slip", 1, 3.0)),
        (("stick", 0, 0.0), -3.0, ("slip", -1, -3.0)),
        (("slip", 1, 3.0), -3.0, ("stick", 0, 0.0)),
        (("slip", 1, 3.0), -4.0, ("slip", -1, -1.0)),
        (("separation", 0, 0.0), 3.0, ("separation", 0, 3.0)),
    ],
)
def test_a_kick_along_the_disc(before: Any, f: float, after: Any) -> None:
    start = static_start(P).replace(**dict(zip(("phase", "direction", "f"), before, strict=True)))
    state = perturb(P, start, f=f)
    assert (state.phase, state.direction, state.f) == after
    assert simulate(P, 0.01, initial_state=state).status.complete
