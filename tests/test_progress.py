"""What is shown of long work: on a terminal, and elsewhere."""

import io
import logging
import sys
from pathlib import Path

import pytest

from disc_model import Execution, Parameters, critical, display, simulate
from disc_model.simulation import api

P = Parameters(N=200, Omega=50, n_diameters=1)


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


EVERYWHERE = pytest.mark.parametrize("kind", [Terminal, io.StringIO])


@EVERYWHERE
@pytest.mark.parametrize(("patience", "option", "shown"), [(0.0, None, True), (60.0, None, False), (0.0, False, False)])
def test_only_a_long_simulation_is_shown(
    kind: type[io.StringIO], monkeypatch: pytest.MonkeyPatch, patience: float, option: bool | None, shown: bool
) -> None:
    stderr = kind()
    monkeypatch.setattr(sys, "stderr", stderr)
    monkeypatch.setattr(display, "PATIENCE", patience)
    monkeypatch.setattr(api, "STEPS_PER_PAUSE", 10)  # as if it were long: it pauses
    simulate(P, 0.05, execution=Execution(progress=option))
    assert ("simulating 0.05 s" in stderr.getvalue()) == shown
    assert bool(stderr.getvalue()) == shown


def test_a_long_search_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", stderr := io.StringIO())
    monkeypatch.setattr(display, "PATIENCE", 0.0)
    critical(Parameters(N=385, Omega=12, mu_k_over_mu_s=0.6), "mu_s", (0.3, 0.42), points=7)
    assert all(f" {what} of mu_s\n" in stderr.getvalue() for what in ("7 values", "further values", "crossings"))


@EVERYWHERE
def test_a_study_shows_its_progress_and_its_failures_by_reason(
    kind: type[io.StringIO], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    stream, now = kind(), 0.0
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr(display.time, "monotonic", lambda: now)
    logger = logging.Logger("of Snakemake")  # with records as those of Snakemake's own
    durations = {**dict.fromkeys(range(10), 60.0), 10: 600.0}
    progress = display.StudyProgress(logging.StreamHandler(stream), lambda: (durations, 2))
    logger.addHandler(progress)
    logger.info("Job stats: many lines", extra={"event": "run_info"})
    assert stream.getvalue() == "11 jobs, about 10 min left\n"
    for job, reason in ((7, "N = 3.2e5: too hard"), (8, "another"), (9, "N = 400: too hard")):
        log = tmp_path / f"{job}.log"
        log.write_text(f"Traceback\n{reason}\n")
        extra = {"event": "job_error", "rule_name": "simulate", "jobid": job, "log": [str(log)], "rule_msg": None}
        logger.error("Error in rule", extra=extra)
    for job in range(7):
        now += 60.0  # twice as long as two jobs at once were expected to take
        logger.info("Select jobs to execute...")
        logger.info("Finished job", extra={"event": "job_finished", "job_id": job})
        logger.info(None, extra={"event": "progress", "done": job + 1, "total": 11})
        if job == 5:  # the last that makes a tenth more, and a line where there is no terminal
            told = progress.bar.tasks[0].description if progress.bar else stream.getvalue()
            assert "6 of 11 jobs done, 3 failed, about 13 min left" in told
    assert bool(progress.bar) == (kind is Terminal)
    logger.warning("the disk is full")
    logger.error("Exiting because a job execution failed. Look above for error messages")
    shown = stream.getvalue()
    assert "the disk is full\n" in shown
    assert not any(text in shown for text in ("Job stats", "Error in rule", "Select jobs", "Finished", "Look above"))
    first, second, third = (f"simulate: {tmp_path / f'{job}.log'}" for job in (7, 9, 8))
    ends = ["    Traceback", "    N = 3.2e5: too hard", "    N = 400: too hard"]
    lines = ["failed jobs: 3", first, second, *ends, third, "    Traceback", "    another"]
    assert shown.endswith("\n".join(lines) + "\n")
