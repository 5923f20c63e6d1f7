"""The rival methods: each is right where it should be, and wrong where it must be."""

import math

import pytest

from benchmarks import scenes
from benchmarks.failure_maps import failure_map
from benchmarks.methods import METHODS
from benchmarks.methods.integrators import Problem, RunStatus
from benchmarks.scenes import answer, problem
from tests import needs
from tests.contact_laws import ALL_LAWS
from tests.references.printed import P, lively
from tests.refusals import refusal

RIVALS = ("RK4", "RK45", "DOP853", "heyoka", "CVODE")
SHORT = [name for name in RIVALS if not METHODS[name].absent()]
FINE = {"step": 2e-6, "tol": 1e-9}
"""Settings at which a method is accurate on short motions."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "scene", "value", "allowed"),
    [
        ("series", "stick_slip", 1e-15, 2e-14),
        ("series", "separating", 1e-15, 2e-14),
        ("series", "many_modes", 1e-15, 2e-14),
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


@pytest.mark.slow
@pytest.mark.parametrize("name", SHORT)
def test_what_does_not_end_is_no_answer(name: str) -> None:
    start = lively("slip", 1, P)
    method = METHODS[name]
    fine = FINE[method.setting]
    assert method.solve(Problem(P, start, 2e-4), fine, 0.0).outcome == RunStatus.TOO_SLOW
    if name != "CVODE":  # its library takes such a state for an error of the program
        overflowing = Problem(P, start.replace(f=1e160), 2e-4)
        outcome = method.solve(overflowing, fine, 1.0).outcome
        assert outcome in {RunStatus.NON_FINITE, RunStatus.FAILED}


@pytest.mark.parametrize("law", ALL_LAWS)
def test_rivals_refuse_other_laws_of_contact(law: str) -> None:
    """They used to answer for the paper's law, as if the parameters had been left out."""
    motion = Problem(P.replace(**ALL_LAWS[law]), lively("slip", 1, P), 1e-4)
    with refusal("because only the engine"):
        METHODS["RK4"].solve(motion, 1e-3)


@pytest.mark.slow
def test_fixed_steps_fail_at_the_limit_of_stability() -> None:
    """Above h omega_max = 2 sqrt(2) the disc's highest mode grows until the slider leaves it."""
    limit = failure_map("RK4", "stick_slip", (2,), (1e-5,))["step_limit"][0]
    cells = failure_map("RK4", "stick_slip", (2,), (1.05 * limit, 0.5 * limit, 1e-5))
    assert cells["verdict"][0] not in ("converged", "inaccurate")
    assert cells["verdict"][2] == "converged"


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({"off": 1e-7}, "CONVERGED"),
        ({"off": 1e-4}, "INACCURATE"),
        ({"kinds": ("separation",) * 135}, "WRONG_EVENTS"),
        ({"outcome": RunStatus.NON_FINITE}, "UNSTABLE"),
        ({"outcome": RunStatus.TOO_SLOW}, "GAVE_UP"),
        ({"outcome": RunStatus.STALLED}, "GAVE_UP"),
        ({"shaken": 100.0}, "UNSTABLE"),
    ],
)
def test_verdicts_on_results(changes: dict, verdict: str) -> None:
    right = answer("stick_slip")
    result = scenes.MethodResult(
        times=right.times + changes.get("off", 0.0),
        kinds=changes.get("kinds", right.kinds),
        final=right.final.replace(alpha=right.final.alpha + changes.get("shaken", 0.0)),
        seconds=0.1,
        outcome=changes.get("outcome", RunStatus.FINISHED),
    )
    assert scenes.errors(problem("stick_slip"), right, result).verdict.name == verdict
