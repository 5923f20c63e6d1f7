"""How simulations end, and what they refuse to begin with."""

from __future__ import annotations

import math
import sys

import numba
import numpy as np
import pytest

from disc_model import ParameterError, Parameters, Poincare, Record, Window, simulate
from disc_model.engine import machine, outcomes
from disc_model.errors import StepLimit
from disc_model.simulation.api import _Run
from tests.contact_laws import COMPILES, LAWS
from tests.simulation.equal import same

P = Parameters(N=200, Omega=50, n_diameters=1)
RECORD = Record(windows=(Window(stop=0.01, rate=1000.0),), poincare=Poincare(), energy=True)


def test_small_buffers_and_many_pauses_change_nothing(monkeypatch):
    record = Record(windows=(Window(start=0, stop=0.05, rate=20_000),))
    whole = simulate(P, 0.05, tol=1e-9, record=record)
    monkeypatch.setattr("disc_model.simulation.kept.BUFFER", 16)
    monkeypatch.setattr(sys.modules["disc_model.simulation.api"], "STEPS_PER_PAUSE", 3)
    seen = []
    again = simulate(P, 0.05, tol=1e-9, record=record, progress=seen.append)
    same(again, whole)
    assert seen == sorted(seen)
    assert seen[-1] == 0.05
    assert len(seen) > 3


def test_a_window_alone_is_a_record_of_it():
    """It was refused, cut off in the middle of the window."""
    window = RECORD.windows[0]
    assert simulate(P, 0.01, record=window).record == Record(windows=(window,))


def test_steps_run_out():
    result = simulate(P, 1.0, max_steps=3)
    assert result.status == "step_limit"
    assert not result.status.complete
    assert result.statistics["steps"] == 3
    with pytest.raises(StepLimit, match="raise max_steps"):
        result.raise_for_status()


def test_more_steps_than_the_engine_counts_are_no_bound():
    """Numba took such a number for one of another kind, and compiled the engine for it, or refused it."""
    assert simulate(P, 1e-3, max_steps=2**64).status == "ok"


@pytest.mark.compiled
@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
@pytest.mark.parametrize(
    "changes", [{"n_circles": 3}, *(pytest.param(law, marks=COMPILES) for law in LAWS.values())], ids=str
)
@pytest.mark.parametrize("record", [None, RECORD], ids=["events", "samples"])
def test_machine_code_is_given_the_types_it_was_compiled_for(changes, record):
    """It takes its arguments at their word: it is chosen by the kind of the model, which must decide all types."""
    p = P.replace(**changes)
    start = simulate(p, 1e-3).final_state
    given = []
    for state in (None, start):
        run = _Run(p, 0.01, 1e-10, state, record or Record(), None, 10**6 if state else None, ())
        given.append(tuple(map(numba.typeof, run._arguments())))
        while run.advance() == outcomes.PAUSED:
            given.append(tuple(map(numba.typeof, run._arguments())))
    assert len(set(given)) == 1
    assert run.engine is machine.run.overloads[given[0]].entry_point


def test_a_run_stops_at_its_first_separation():
    p = P.replace(N=60.0)
    start = simulate(p, 1e-6).final_state
    kicked = start.replace(alpha=start.alpha + np.array([0.0, 20.0]))
    result = simulate(p, 0.05, initial_state=kicked, stop_at="first_separation")
    assert result.status == "stopped"
    assert result.status.complete
    assert result.first_separation == result.final_state.time == result.events["time"].iloc[-1]
    assert result.final_state.phase == "separation"
    assert result.raise_for_status() is result


def test_a_state_that_overflows_is_named():
    start = simulate(P, 1e-6).final_state
    with np.errstate(all="ignore"):
        result = simulate(P, 0.01, initial_state=start.replace(phase="slip", direction=1, f=1e308))
    assert result.status == "non_finite"
    assert result.message == "non_finite: at t = 1e-06 s in slip"


def test_all_faults_of_the_arguments_come_at_once():
    with pytest.raises(ParameterError) as error:
        simulate(3, math.nan, tol=1, record="all", stop_at="never", max_steps=0)
    names = [fault.partition("=")[0] for fault in error.value.faults]
    assert names == ["p", "record", "t_end", "tol", "stop_at", "max_steps"]
    state = simulate(P, 1e-3).final_state
    wrong = state.replace(phase="slip", direction=1, f=-1.0, psi=math.inf, a=np.zeros(7))
    with pytest.raises(ParameterError) as error:
        simulate(P, 1.0, initial_state=wrong)
    names = [fault.partition("=")[0].partition(":")[0] for fault in error.value.faults]
    assert names == ["initial_state.a", "initial_state.psi", "initial_state.f"]
    for changes, fault in (
        ({"phase": "flight"}, "must be one of stick, slip, separation"),
        ({"phase": "stick", "f": 1.0}, "must be 0 in stick"),
        ({"phase": "slip", "direction": 0}, "must be -1 or 1 in slip"),
        ({"known": 4}, "known=4: must be 0, 1, 2 or 3"),
        ({"time_low": math.nan}, "time_low=nan: must be less than the last digit of the time"),
        ({"time_low": 1e-3}, "time_low=0.001: must be less than the last digit of the time"),
    ):
        with pytest.raises(ParameterError, match=fault):
            simulate(P, 1.0, initial_state=state.replace(**changes))
