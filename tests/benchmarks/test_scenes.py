"""The scenes' right answers, errors against them, and verdicts."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from benchmarks import scenes
from benchmarks.methods.integrators import MethodResult, RunStatus
from benchmarks.methods.kernels import Physics
from benchmarks.scenes import Verdict, answer, errors, problem
from disc_model import Parameters
from disc_model.simulation.states import static_start
from tests.references import stored

P = Parameters(N=385.0, Omega=15.1)


def test_the_stored_start_is_that_of_the_references() -> None:
    ours = scenes.separating_start(P)
    theirs = stored.engine_state(stored.load("C")["start"], P)
    assert Physics(P).distance(ours, theirs) < 1e-14


def test_the_static_start_is_the_engines() -> None:
    assert Physics(P).distance(scenes.static_start(P), static_start(P)) < 1e-12


@pytest.mark.parametrize(("scene", "name"), [("stick_slip", "A"), ("separating", "C")])
def test_the_stored_answers_are_those_of_the_references(scene: str, name: str) -> None:
    data = stored.load(name)
    right = answer(scene)
    assert right.kinds == tuple(data["kinds"])
    assert float(np.abs(right.times - stored.times_of(data)).max()) < 1e-15
    assert right.error < 1e-15


TASK = problem("stick_slip")
RIGHT = answer("stick_slip")
RESULT = MethodResult(
    times=RIGHT.times,
    kinds=RIGHT.kinds,
    final=RIGHT.final,
    seconds=0.1,
    work=1,
    outcome=RunStatus.FINISHED,
)
"""The right answer as a method would find it."""
SHAKEN = RIGHT.final.replace(alpha=RIGHT.final.alpha + 100.0)


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({"times": RIGHT.times + 1e-7}, Verdict.CONVERGED),
        ({"times": RIGHT.times + 1e-4}, Verdict.INACCURATE),
        ({"kinds": ("separation",) * 135}, Verdict.WRONG_EVENTS),
        ({"outcome": RunStatus.NON_FINITE}, Verdict.UNSTABLE),
        ({"outcome": RunStatus.TOO_SLOW}, Verdict.GAVE_UP),
        ({"outcome": RunStatus.STALLED}, Verdict.GAVE_UP),
        ({"final": SHAKEN}, Verdict.UNSTABLE),
    ],
)
def test_verdicts(changes: dict[str, Any], verdict: Verdict) -> None:
    assert errors(TASK, RIGHT, replace(RESULT, **changes)).verdict is verdict


def test_the_rigid_cycle_is_that_of_a_single_degree_of_freedom() -> None:
    """In slip the energy of the oscillation about sliding at the drive's speed stays the same."""
    task = problem("rigid")
    right = answer("rigid")
    p = task.parameters
    held = p.mu_s * p.N / (p.k_p * p.r_0)
    kinetic = p.mu_k * p.N / (p.k_p * p.r_0)
    assert float(right.times[0]) == pytest.approx(held / p.Omega, rel=1e-15)

    final = right.final
    assert final.time == task.t_end
    assert final.phase == "slip"
    omega = math.sqrt(p.k_p / p.m)
    at_release = (omega * (held - kinetic)) ** 2 + p.Omega**2
    in_slip = (omega * (final.psi - kinetic)) ** 2 + (p.Omega - final.f) ** 2
    # the disc's remaining flexibility, k psi^2/omega^2, is 3e-9
    assert in_slip == pytest.approx(at_release, rel=1e-9)
