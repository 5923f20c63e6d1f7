"""The rival methods: that each is right where it should be, and wrong where it must be."""

import math

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.benchmarks import scenes
from disc_model.benchmarks.methods import METHODS, integrators
from disc_model.benchmarks.methods.integrators import Problem, RunStatus
from disc_model.benchmarks.methods.kernels import Physics
from disc_model.benchmarks.scenes import answer, problem
from disc_model.errors import ParameterError
from tests import needs
from tests.contact_laws import ALL_LAWS
from tests.references.printed import MOTIONS, P, Printed, lively

SHORT = [
    name for name in ("RK4", "RK45", "DOP853", "heyoka", "CVODE") if not METHODS[name].absent()
]
EACH_SHORT = pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.compiled] * (name == "CVODE")) for name in SHORT]
)
BASE = Parameters(N=385.0, Omega=15.1)
UP = np.sign(Physics(P).shape)
"""Amplitudes that lift the disc under the slider."""


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("name", "scene", "value", "allowed"),
    [
        ("series", "stick_slip", 1e-15, 2e-14),
        ("series", "separating", 1e-15, 2e-14),
        pytest.param(
            "series", "many_modes", 1e-15, 2e-14, marks=pytest.mark.slow
        ),  # compiles for a minute
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
        # the all but rigid disc gives way by 3e-9 of what the slider's spring does: it is left out
        ("series-fewest", "rigid", 1e-8, 1e-8),
    ],
)
def test_every_method_finds_all_switches(name, scene, value, allowed):
    if METHODS[name].absent():
        pytest.skip(needs.RIVALS.reason)
    result = METHODS[name].solve(problem(scene), value, math.inf)
    off = scenes.errors(problem(scene), answer(scene), result)
    assert (result.outcome, result.kinds) == (RunStatus.FINISHED, answer(scene).kinds)
    assert off.event_time < allowed
    if name == "series":
        assert off.state < 1e-11
    if name == "series-fewest":
        assert result.work < 100
        assert result.final.a.shape == problem(scene).start.a.shape


@EACH_SHORT
@pytest.mark.parametrize(
    ("phase", "direction", "span", "p", "lifted"),
    [
        *((*motion, 1e-4, P, 0.0) for motion in MOTIONS),
        (
            "separation",
            0,
            1e-5,
            P,
            0.0,
        ),  # shorter than the time for which no reattachment is looked for
        ("slip", 1, 1e-4, P.replace(contact="bilateral"), 0.01),
    ],
)
def test_a_short_motion_is_the_printed_one(name, phase, direction, span, p, lifted):
    start = lively(phase, direction, p)
    motion = Problem(p, start.replace(a=start.a + lifted * UP), span, watched=True)
    result = METHODS[name].solve(motion, 2e-6 if METHODS[name].setting == "step" else 1e-9)
    assert (result.outcome, result.kinds) == (RunStatus.FINISHED, ())
    printed = Printed(p, motion.start)
    assert bool(lifted) == (printed.force() < 0)
    end = printed.at(motion.t_end)
    # w rises or falls all the time; the range of RK4 begins a step later
    heights, left_out = np.sort([printed.at(0.0)["w"], end["w"]]), 2e-6 / span
    np.testing.assert_allclose(
        result.heights, heights, rtol=0, atol=1.1 * left_out * np.ptp(heights)
    )
    for quantity in ("a", "b", "alpha", "beta", "psi", "f", "u", "u_velocity"):
        size = max(np.max(np.abs(end[quantity])), 1e-12)
        np.testing.assert_allclose(
            getattr(result.final, quantity), end[quantity], rtol=0, atol=1e-6 * size
        )


@EACH_SHORT
def test_a_method_gives_up_when_its_time_is_over(name):
    start = lively("slip", 1, P)
    result = METHODS[name].solve(
        Problem(P, start, 2e-4), 2e-6 if METHODS[name].setting == "step" else 1e-9, 0.0
    )
    assert (result.outcome, result.kinds) == (RunStatus.TOO_SLOW, ())
    assert result.final.time < 2e-4


@pytest.mark.parametrize("name", [name for name in SHORT if name != "CVODE"])
def test_a_state_that_overflows_is_no_answer(name):
    start = lively("slip", 1, P).replace(f=1e160)
    result = METHODS[name].solve(
        Problem(P, start, 1e-4), 2e-6 if METHODS[name].setting == "step" else 1e-9, 1.0
    )
    assert result.outcome in (RunStatus.NON_FINITE, RunStatus.FAILED)


@pytest.mark.parametrize("name", [*SHORT, "LSODA", "Radau", "regularised"])
@pytest.mark.parametrize("law", ALL_LAWS)
def test_rivals_refuse_other_laws_of_contact(name, law):
    """They used to answer for the paper's law, as if the parameters had been left out."""
    motion = Problem(P.replace(**ALL_LAWS[law]), lively("slip", 1, P), 1e-4)
    changed = ".*".join(f"{parameter}=.*: must be" for parameter in ALL_LAWS[law])
    with pytest.raises(ParameterError, match=f"{changed} .*, because only the engine"):
        METHODS[name].solve(motion, 1e-3)


def test_the_regularised_model_is_of_order_two_thirds_in_eps_and_stiff_in_proportion_to_its_sharpness():
    """Stick breaks by slow passage through the maximum of the law, a fold: late by eps^(2/3)."""
    start = scenes.static_start(BASE)
    eps = np.array([0.3, 0.1, 0.03])
    results = [METHODS["regularised"].solve(Problem(BASE, start, 0.01), value) for value in eps]
    assert all(result.kinds == ("stick_to_slip",) for result in results)
    late = np.array([float(result.times[0] - answer("stick_slip").times[0]) for result in results])
    assert np.polyfit(np.log(eps), np.log(late), 1)[0] == pytest.approx(2 / 3, abs=0.12)
    stuck = Problem(BASE, start, 0.004)  # nothing moves but the drive
    coarse, fine = (
        integrators.solve_regularised(stuck, value, np.inf, "RK45").work for value in (0.1, 0.01)
    )
    assert fine > 4 * coarse
