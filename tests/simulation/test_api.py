"""How simulations end, and what they take; in several threads they share nothing that they
change."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from disc_model import Execution, Parameters, Result, simulate
from disc_model.engine import audit
from disc_model.errors import NonFinite, StepLimit
from disc_model.simulation.request import checked_request
from disc_model.simulation.run import Run
from tests.refusals import refusal
from tests.simulation.equal import same

P = Parameters(N=200, Omega=50, n_diameters=1)


def test_steps_run_out():
    result = simulate(P, 1.0, execution=Execution(max_steps=3))
    assert result.status == "step_limit"
    assert not result.status.complete
    assert result.statistics["steps"] == 3
    with pytest.raises(StepLimit, match="raise max_steps"):
        result.raise_for_status()


def test_a_run_stops_at_its_first_separation():
    p = P.replace(N=60.0)
    start = simulate(p, 1e-6).final_state
    kicked = start.replace(alpha=start.alpha + np.array([0.0, 20.0]))
    result = simulate(p, 0.05, initial_state=kicked, stop_at="first_separation")
    assert result.status == "stopped"
    assert result.status.complete
    assert result.first_separation == result.final_state.time
    assert result.final_state.time == result.events["time"].iloc[-1]
    assert result.final_state.phase == "separation"
    assert result.raise_for_status() is result


def test_a_state_that_overflows_is_named():
    start = simulate(P, 1e-6).final_state
    with np.errstate(all="ignore"):
        result = simulate(P, 0.01, initial_state=start.replace(phase="slip", direction=1, f=1e308))
    assert result.status == "non_finite"
    assert result.message == "non_finite: at t = 1e-06 s in slip"
    with pytest.raises(
        NonFinite, match=r"^non_finite: at t = 1e-06 s in slip. The state overflowed"
    ):
        result.raise_for_status()


def test_a_duration_begins_at_the_initial_state():
    first = simulate(P, duration="20 ms")
    same(first, simulate(P, 0.02))
    same(
        simulate(P, duration=0.01, initial_state=first.final_state),
        simulate(P, 0.03, initial_state=first.final_state),
    )
    for times, rule in (
        ({}, ": is required, or duration"),
        ({"t_end": 1, "duration": 1}, "=1: must be left out"),
    ):
        with refusal(f"t_end{rule}"):
            simulate(P, **times)


def test_the_tolerance_that_was_used_is_recorded():
    for law, loosest in ({}, 1.25e-7), ({"contact_compliance": 1e-7}, 2e-6):
        for tol in (1e-15, 1e-10, 1e-2):
            run = simulate(P.replace(**law), 1e-4, tol=tol)
            assert run.tol == pytest.approx(min(tol, loosest), rel=1e-12)
    for tol in (0.9e-15, 1.1e-2):
        with refusal(r"^tol=.*: must be within 1e-15 and 0\.01$"):
            simulate(P, 1e-4, tol=tol)


def test_each_balance_of_energy_has_its_own_terms():
    request = checked_request(
        P,
        t_end=0.01,
        duration=None,
        windows=None,
        events=True,
        tol=1e-10,
        initial_state=None,
        stop_at=None,
        ramps=(),
        execution=Execution(audit_every_step=True),
    )
    run = Run(request)
    sums = run.collector.buffers.audit
    sums[:] = 0.0
    sums[[audit.TRANSVERSE, audit.TRANSVERSE_SCALE, audit.TRANSVERSE_TURNOVER]] = -2.0, 3.0, 5.0
    sums[[audit.INPLANE, audit.INPLANE_SCALE, audit.INPLANE_TURNOVER]] = 7.0, 11.0, 13.0
    found = run._statistics()
    assert found["energy_residual_transverse"] == 2 / 8
    assert found["energy_residual_inplane"] == 7 / 24


def test_runs_in_threads_equal_runs_in_turn() -> None:
    def content(result: Result) -> tuple[bytes, str]:
        return result.event_rows.tobytes(), repr(result.final_state)

    # few cases, so that runs in different threads share their constants and reuse each other's
    # workspaces
    cases = [Parameters(N=100.0 + 150.0 * (i % 4), Omega=15.1 + i % 3) for i in range(48)]

    def run(p: Parameters) -> tuple[bytes, str]:
        return content(simulate(p, 0.5))

    with ThreadPoolExecutor(8) as threads:
        together = list(threads.map(run, cases))
    assert together == list(map(run, cases))
    assert any(rows for rows, _ in together)


def test_counts_of_a_run_have_the_names_that_datasets_have() -> None:
    """`n_separations` of a sweep was `separations` of a run; a former name still gives the count."""
    run = simulate(P, 0.02)
    assert run.statistics["n_events"] == len(run.events)
    assert run.statistics.keys() > {"steps", "n_events", "n_separations"}
    assert run.statistics["events"] == run.statistics["n_events"]
    with pytest.raises(KeyError, match="event"):
        run.statistics["event"]
