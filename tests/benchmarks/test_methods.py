"""The rival methods: that each is right where it should be, and wrong where it must be."""

import math

import numpy as np
import pytest

from benchmarks import scenes
from benchmarks.methods import METHODS, by_scipy
from benchmarks.methods.integrators import Problem, RunStatus
from benchmarks.methods.kernels import Physics
from benchmarks.scenes import answer, problem
from disc_model import Parameters
from tests import needs
from tests.contact_laws import ALL_LAWS
from tests.references.printed import MOTIONS, P, Printed, lively
from tests.refusals import refusal

QUICK_TO_COMPILE = ("RK4", "RK45", "DOP853", "heyoka", "CVODE")
SHORT = [name for name in QUICK_TO_COMPILE if not METHODS[name].absent()]
"""Methods for short motions."""
EACH_SHORT = pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.compiled] * (name == "CVODE")) for name in SHORT]
)
BASE = Parameters(N=385.0, Omega=15.1)
UP = np.sign(Physics(P).shape)
"""Amplitudes that lift the disc under the slider."""
STATE = ("a", "b", "alpha", "beta", "psi", "f", "u", "u_velocity")


def fine_setting(name: str) -> float:
    """Return a setting at which a method is accurate on short motions."""
    if METHODS[name].setting == "step":
        return 2e-6
    return 1e-9


# ---- Whole scenes


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("name", "scene", "value", "allowed"),
    [
        ("series", "stick_slip", 1e-15, 2e-14),
        ("series", "separating", 1e-15, 2e-14),
        # compiles for a minute
        pytest.param("series", "many_modes", 1e-15, 2e-14, marks=pytest.mark.slow),
        ("RK4", "stick_slip", 1e-5, 1e-10),
        ("RK45", "stick_slip", 1e-6, 1e-6),
        ("DOP853", "stick_slip", 1e-8, 1e-8),
        ("LSODA", "stick_slip", 1e-6, 1e-5),
        ("Radau", "stick_slip", 1e-4, 1e-4),
        ("heyoka", "stick_slip", 1e-10, 1e-10),
        ("CVODE-BDF", "stick_slip", 1e-8, 1e-7),
        # with roots of its own where a separation begins: triple ones
        ("heyoka", "separating", 1e-10, 1e-10),
        ("CVODE", "separating", 1e-11, 1e-9),
        ("LSODA", "rigid", 1e-7, 1e-7),
        ("RK4", "rigid", 6e-8, 1e-10),
    ],
)
def test_every_method_finds_all_switches(
    name: str, scene: str, value: float, allowed: float
) -> None:
    if METHODS[name].absent():
        pytest.skip(needs.RIVALS.reason)
    result = METHODS[name].solve(problem(scene), value, math.inf)
    off = scenes.errors(problem(scene), answer(scene), result)
    assert result.outcome == RunStatus.FINISHED
    assert result.kinds == answer(scene).kinds
    assert off.event_time < allowed
    if name == "series":
        assert off.state < 1e-11


@pytest.mark.compiled
def test_the_modes_of_an_all_but_rigid_disc_are_left_out() -> None:
    """It gives way by 3e-9 of what the slider's spring does."""
    task = problem("rigid")
    result = METHODS["series-fewest"].solve(task, 1e-8, math.inf)
    off = scenes.errors(task, answer("rigid"), result)
    assert result.kinds == answer("rigid").kinds
    assert off.event_time < 1e-8
    assert result.work < 100
    assert result.final.a.shape == task.start.a.shape


# ---- Short motions


@EACH_SHORT
@pytest.mark.parametrize(
    ("phase", "direction", "span", "p", "lifted"),
    [
        *((*motion, 1e-4, P, 0.0) for motion in MOTIONS),
        # shorter than the time for which no reattachment is looked for
        ("separation", 0, 1e-5, P, 0.0),
        ("slip", 1, 1e-4, P.replace(contact="bilateral"), 0.01),
    ],
)
def test_a_short_motion_is_the_printed_one(
    name: str, phase: str, direction: int, span: float, p: Parameters, lifted: float
) -> None:
    start = lively(phase, direction, p)
    motion = Problem(p, start.replace(a=start.a + lifted * UP), span, watched=True)
    result = METHODS[name].solve(motion, fine_setting(name))
    assert result.outcome == RunStatus.FINISHED
    assert result.kinds == ()
    printed = Printed(p, motion.start)
    assert (printed.force() < 0) == bool(lifted)

    # w rises or falls all the time; the range of RK4 begins a step later
    end = printed.at(motion.t_end)
    heights = np.sort([printed.at(0.0)["w"], end["w"]])
    step = 2e-6 / span * np.ptp(heights)
    np.testing.assert_allclose(result.heights, heights, rtol=0, atol=1.1 * step)
    for quantity in STATE:
        size = max(np.max(np.abs(end[quantity])), 1e-12)
        found = getattr(result.final, quantity)
        np.testing.assert_allclose(found, end[quantity], rtol=0, atol=1e-6 * size)


@EACH_SHORT
def test_a_method_gives_up_when_its_time_is_over(name: str) -> None:
    motion = Problem(P, lively("slip", 1, P), 2e-4)
    result = METHODS[name].solve(motion, fine_setting(name), 0.0)
    assert result.outcome == RunStatus.TOO_SLOW
    assert result.kinds == ()
    assert result.final.time < 2e-4


@pytest.mark.parametrize("name", [name for name in SHORT if name != "CVODE"])
def test_a_state_that_overflows_is_no_answer(name: str) -> None:
    motion = Problem(P, lively("slip", 1, P).replace(f=1e160), 1e-4)
    result = METHODS[name].solve(motion, fine_setting(name), 1.0)
    assert result.outcome in (RunStatus.NON_FINITE, RunStatus.FAILED)


@pytest.mark.parametrize("name", [*SHORT, "LSODA", "Radau", "regularised"])
@pytest.mark.parametrize("law", ALL_LAWS)
def test_rivals_refuse_other_laws_of_contact(name: str, law: str) -> None:
    """They used to answer for the paper's law, as if the parameters had been left out."""
    motion = Problem(P.replace(**ALL_LAWS[law]), lively("slip", 1, P), 1e-4)
    with refusal("because only the engine") as caught:
        METHODS[name].solve(motion, 1e-3)
    # how friction falls says nothing without the rate at which it falls, which is refused
    refused = {*ALL_LAWS[law]} - {"friction_law"}
    assert {text.split("=")[0] for text in str(caught.value).split("; ")} == refused


# ---- The regularised model


def test_the_regularised_model_is_of_order_two_thirds_in_eps() -> None:
    """Stick breaks by slow passage through the maximum of the law, a fold: late by eps^(2/3)."""
    motion = Problem(BASE, scenes.static_start(BASE), 0.01)
    right = answer("stick_slip").times[0]
    eps = np.array([0.3, 0.1, 0.03])
    late = []
    for value in eps:
        result = METHODS["regularised"].solve(motion, value)
        assert result.kinds == ("stick_to_slip",)
        late.append(float(result.times[0] - right))
    order, _ = np.polyfit(np.log(eps), np.log(late), 1)
    # the three values are not yet small enough for the order itself
    assert order == pytest.approx(2 / 3, abs=0.12)


def test_the_regularised_model_is_stiff_in_proportion_to_its_sharpness() -> None:
    stuck = Problem(BASE, scenes.static_start(BASE), 0.004)  # nothing moves but the drive
    coarse = by_scipy.solve_regularised(stuck, 0.1, np.inf, "RK45").work
    fine = by_scipy.solve_regularised(stuck, 0.01, np.inf, "RK45").work
    assert fine > 4 * coarse
