"""The command line in real shells: completion, and Ctrl-C."""

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
from tests.shell import shell
from tests.workflow.conftest import TEXTS

pytestmark = [pytest.mark.workflow, pytest.mark.slow]

PATH = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
PROMPT = "ready> "


def test_no_interrupt_leaves_the_folder_locked(tmp_path: Path) -> None:
    """A quarter of a second after Ctrl-C Snakemake was killed, with its lock left behind in 5 of 12 tries."""
    shutil.copy(TEXTS / "long.yaml", tmp_path / "mine.yaml")
    moments = random.Random(27)
    with shell(["bash", "--norc", "-i"], tmp_path, PATH=PATH, PS1=PROMPT) as terminal:
        terminal.wait_for(PROMPT)
        terminal.type("disc-model compile\n")
        terminal.wait_for(PROMPT, 600)
        for _ in range(20):
            terminal.type("disc-model study mine.yaml -j2\n")
            terminal.wait_for_program()
            terminal.wait_for(moments.choice(["study mine.yaml", "rule compute_batch:"]))
            terminal.read(moments.uniform(0.0, 4.0))
            terminal.type("\x03")
            phrase = terminal.wait_for(PROMPT)
            assert not list((tmp_path / ".snakemake").glob("locks/*")), phrase
            terminal.type("echo ended with $?\n")
            terminal.wait_for("ended with 130")
            terminal.wait_for(PROMPT)


def test_the_lock_of_a_killed_run_is_told_with_the_option_that_removes_it(tmp_path: Path) -> None:
    shutil.copy(TEXTS / "long.yaml", tmp_path / "mine.yaml")
    command = [str(Path(sys.executable).with_name("disc-model")), "study", "mine.yaml"]
    locks = tmp_path / ".snakemake" / "locks"
    run = subprocess.Popen(command, cwd=tmp_path, start_new_session=True)
    while not list(locks.glob("*.lock")):
        assert run.poll() is None
        time.sleep(0.05)
    os.killpg(run.pid, signal.SIGKILL)
    run.wait()
    assert "--unlock" in processes.run(*command, cwd=tmp_path, fails=True, timeout=300).stderr
    processes.run(*command, "--unlock", cwd=tmp_path, timeout=300)
    assert not list(locks.glob("*"))
