"""Simulations in several threads: the engine releases Python's lock, and runs share nothing that they change."""

import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from disc_model import Parameters, Result, simulate
from disc_model.simulation import api

P = Parameters(N=385, Omega=15.1)


def test_runs_in_threads_equal_runs_in_turn() -> None:
    def content(result: Result) -> tuple[bytes, str]:
        return result.event_rows.tobytes(), repr(result.final_state)

    # few cases, so that runs in different threads share their constants and reuse each other's workspaces
    cases = [P.replace(N=100.0 + 150.0 * (i % 4), Omega=15.1 + i % 3) for i in range(48)]

    def run(p: Parameters) -> tuple[bytes, str]:
        return content(simulate(p, 0.5))

    with ThreadPoolExecutor(8) as threads:
        together = list(threads.map(run, cases))
    assert together == list(map(run, cases))
    assert any(rows for rows, _ in together)


@pytest.mark.compiled
def test_other_threads_go_on_while_the_engine_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    """With Python's lock held, this thread would stand still for the whole run, which is made one call here."""
    monkeypatch.setattr(api, "STEPS_PER_PAUSE", 10**9)
    sliding = Parameters(N=66, Omega=25, c_p=0.5)  # with hardly any events, whose buffers would make it pause
    assert simulate(sliding, 10.0).statistics["events"] < 10
    times = [time.perf_counter()]
    with ThreadPoolExecutor(1) as threads:
        run = threads.submit(simulate, sliding, 2000.0)
        while not run.done():
            time.sleep(1e-3)
            times.append(time.perf_counter())
    assert len(times) > 20
