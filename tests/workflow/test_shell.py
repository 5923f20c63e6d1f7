"""Studies of the command line that are interrupted or killed."""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests import processes
from tests.workflow.conftest import TEXTS

pytestmark = pytest.mark.slow

PROGRAM = str(Path(sys.executable).with_name("disc-model"))


def test_no_interrupt_leaves_the_folder_locked(tmp_path: Path) -> None:
    """A quarter of a second after Ctrl-C Snakemake was killed, with its lock left behind in 5 of 12
    tries."""
    mine_path = tmp_path / "mine.yaml"
    shutil.copy(TEXTS / "long.yaml", mine_path)
    moments = random.Random(27)
    locks = tmp_path / ".snakemake" / "locks"
    log_path = tmp_path / "log"
    for _ in range(10):
        with log_path.open("w+") as log:
            study = subprocess.Popen([PROGRAM, "study", "mine.yaml", "-j2"], cwd=tmp_path, stdout=log, stderr=log,
                                     start_new_session=True)  # fmt: skip
            while not list(locks.glob("*.lock")):
                assert study.poll() is None
                time.sleep(0.01)
            time.sleep(moments.uniform(0.0, 4.0))
            os.killpg(study.pid, signal.SIGINT)  # as a terminal does
            code = study.wait(300)
            log.seek(0)
            said = log.read()
            assert (code != 0, list(locks.glob("*"))) == (True, []), said


def test_what_was_finished_before_an_interrupt_is_not_computed_again(tmp_path: Path) -> None:
    text = (TEXTS / "long.yaml").read_text().replace("241", "4").replace("201", "3")
    mine_path = tmp_path / "mine.yaml"
    mine_path.write_text(f"{text}batch: {{size: 1}}\n")
    command = [PROGRAM, "study", "mine.yaml", "-j1"]
    log_path = tmp_path / "log"
    with log_path.open("w+") as log:
        study = subprocess.Popen(
            command, cwd=tmp_path, stdout=log, stderr=log, start_new_session=True
        )
        # one job at a time: what is there when the next one has begun to write is finished
        while len(made := list(tmp_path.glob("results/*/batches/[!.]*.nc"))) < 2:
            assert study.poll() is None
            time.sleep(0.05)
        os.killpg(study.pid, signal.SIGINT)
        assert study.wait(300) != 0
    first = min(made, key=lambda path: path.stat().st_mtime_ns)
    finished = first.stat().st_mtime_ns
    processes.run(*command, cwd=tmp_path, timeout=600)
    assert first.stat().st_mtime_ns == finished
