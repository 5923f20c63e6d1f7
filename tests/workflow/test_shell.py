"""Studies of the command line that are interrupted or killed."""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests import processes
from tests.workflow.conftest import TEXTS

pytestmark = pytest.mark.slow

PROGRAM = str(Path(sys.executable).with_name("disc-model"))


def interrupted(folder: Path, cores: int, ready: Callable[[], object], wait: float = 0.0) -> str:
    """What the study of a folder says that is interrupted, as by a terminal, a while (s) after
    something is there; it must not succeed."""
    command = [PROGRAM, "study", "mine.yaml", f"-j{cores}"]
    with (folder / "log").open("w+") as log:
        study = subprocess.Popen(
            command, cwd=folder, stdout=log, stderr=log, start_new_session=True
        )
        while not ready():
            assert study.poll() is None
            time.sleep(0.01)
        time.sleep(wait)
        os.killpg(study.pid, signal.SIGINT)
        code = study.wait(300)
        log.seek(0)
        said = log.read()
    assert code != 0, said
    return said


def test_no_interrupt_leaves_the_folder_locked(tmp_path: Path) -> None:
    """A quarter of a second after Ctrl-C Snakemake was killed, with its lock left behind in 5 of 12
    tries."""
    shutil.copy(TEXTS / "long.yaml", tmp_path / "mine.yaml")
    moments = random.Random(27)
    locks = tmp_path / ".snakemake" / "locks"
    for _ in range(10):
        said = interrupted(
            tmp_path, 2, lambda: list(locks.glob("*.lock")), moments.uniform(0.0, 4.0)
        )
        assert not list(locks.glob("*")), said


def test_what_was_finished_before_an_interrupt_is_not_computed_again(tmp_path: Path) -> None:
    text = (TEXTS / "long.yaml").read_text().replace("241", "4").replace("201", "3")
    (tmp_path / "mine.yaml").write_text(f"{text}points_per_job: 1\n")

    def made() -> list[Path]:
        return list(tmp_path.glob("results/*/batches/[!.]*.nc"))

    # one job at a time: what is there when the next one has begun to write is finished
    interrupted(tmp_path, 1, lambda: len(made()) >= 2)
    first = min(made(), key=lambda path: path.stat().st_mtime_ns)
    finished = first.stat().st_mtime_ns
    processes.run(PROGRAM, "study", "mine.yaml", "-j1", cwd=tmp_path, timeout=600)
    assert first.stat().st_mtime_ns == finished
