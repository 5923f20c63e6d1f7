"""Simulations in several threads: the engine releases Python's lock, and runs share nothing that they change."""

from concurrent.futures import ThreadPoolExecutor

from disc_model import Parameters, Result, simulate

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
