"""The scenes' right answers, errors against them, and verdicts."""

import math

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.benchmarks import scenes
from disc_model.benchmarks.methods.integrators import MethodResult, RunStatus
from disc_model.benchmarks.methods.kernels import Physics
from disc_model.benchmarks.scenes import Verdict, answer, errors, problem
from tests.references import stored

P = Parameters(N=385.0, Omega=15.1)


def test_the_stored_start_is_that_of_the_references():
    ours = scenes.separating_start(P)
    theirs = stored.engine_state(stored.load("C")["start"], P)
    assert Physics(P).distance(ours, theirs) < 1e-14


@pytest.mark.parametrize(("scene", "name"), [("stick_slip", "A"), ("separating", "C")])
def test_the_stored_answers_are_those_of_the_references(scene, name):
    data = stored.load(name)
    assert answer(scene).kinds == tuple(data["kinds"])
    assert float(np.abs(answer(scene).times - stored.times_of(data)).max()) < 1e-15
    assert answer(scene).error < 1e-15


TASK, RIGHT = problem("stick_slip"), answer("stick_slip")


def _result(**changes):
    right = {
        "times": RIGHT.times,
        "kinds": RIGHT.kinds,
        "final": RIGHT.final,
        "seconds": 0.1,
        "work": 1,
    }
    return MethodResult(**(right | {"outcome": RunStatus.FINISHED} | changes))


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({"times": RIGHT.times + 1e-4}, Verdict.INACCURATE),
        ({"kinds": ("separation",) * 135}, Verdict.WRONG_EVENTS),
        ({"outcome": RunStatus.NON_FINITE}, Verdict.UNSTABLE),
        ({"outcome": RunStatus.TOO_SLOW}, Verdict.GAVE_UP),
        ({"outcome": RunStatus.STALLED}, Verdict.GAVE_UP),
        ({"final": RIGHT.final.replace(alpha=RIGHT.final.alpha + 100.0)}, Verdict.UNSTABLE),
    ],
)
def test_verdicts(changes, verdict):
    assert errors(TASK, RIGHT, _result(**changes)).verdict is verdict


def test_the_rigid_cycle_is_that_of_a_single_degree_of_freedom():
    """In slip the energy of the oscillation about sliding at the drive's speed stays the same."""
    right, p = answer("rigid"), problem("rigid").parameters
    held, kinetic = (mu * p.N / (p.k_p * p.r_0) for mu in (p.mu_s, p.mu_k))
    assert float(right.times[0]) == pytest.approx(held / p.Omega, rel=1e-15)
    w, final = math.sqrt(p.k_p / p.m), right.final
    assert (final.time, final.phase) == (problem("rigid").t_end, "slip")
    energy = (w * (final.psi - kinetic)) ** 2 + (p.Omega - final.f) ** 2
    assert energy == pytest.approx((w * (held - kinetic)) ** 2 + p.Omega**2, rel=1e-9)
