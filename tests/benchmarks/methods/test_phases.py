"""What ends a run of phases."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from disc_model.benchmarks.methods import RunStatus, kernels
from disc_model.benchmarks.methods import regularised as regularised_module
from disc_model.benchmarks.methods import solve_ivp as solve_ivp_module
from disc_model.benchmarks.methods.base import GaveUp, Meter
from disc_model.benchmarks.methods.phases import run_phases
from disc_model.benchmarks.registry import METHODS
from tests.benchmarks.methods.problems import task


@pytest.mark.parametrize(
    ("what", "outcome", "words"),
    [
        ("fails", RunStatus.FAILED, "gave up"),
        ("overflows", RunStatus.NON_FINITE, "no longer finite"),
        ("crowds", RunStatus.STALLED, "more than 50 events at one instant"),
    ],
)
def test_what_ends_a_run_of_phases(what, outcome, words):
    problem = task()

    def advance(phase, direction, t, y, t_end):
        if what == "fails":
            raise GaveUp("gave up")
        if what == "overflows":
            return None, t, y * math.nan
        return 1 if phase == kernels.SLIP else 0, t, y  # one switch after the other, at once

    result = run_phases(advance, Meter(problem, math.inf))
    assert result.outcome is outcome
    assert words in result.message


def test_an_integrator_that_gives_up_is_reported(monkeypatch):
    def pretending(factor, status):
        def solved(function, span, y, **_):
            found = {"t": np.array([0.0]), "y": factor * y[:, None], "status": status, "message": "step too small"}
            return SimpleNamespace(**found, t_events=([], []), y_events=([], []))

        return solved

    monkeypatch.setattr(solve_ivp_module, "solve_ivp", pretending(1.0, -1))
    monkeypatch.setattr(regularised_module, "solve_ivp", pretending(1.0, -1))
    for name, value in (("RK45", 1e-6), ("regularised", 1.0)):
        result = METHODS[name].solve(task(), value)
        assert (result.outcome, result.message) == (RunStatus.FAILED, "step too small")
    monkeypatch.setattr(regularised_module, "solve_ivp", pretending(math.nan, 0))
    assert METHODS["regularised"].solve(task(), 1.0).outcome is RunStatus.NON_FINITE
