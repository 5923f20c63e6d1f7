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

from tests import needs, processes
from tests.shell import shell
from tests.workflow.conftest import TEXTS

pytestmark = [pytest.mark.workflow, pytest.mark.slow]

PATH = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
PROMPT = "ready> "


@pytest.mark.parametrize("program", ["bash", pytest.param("zsh", marks=needs.ZSH.mark)])
def test_a_shell_completes_commands_options_and_words(program: str, tmp_path: Path) -> None:
    """Completion was that of a program `python -m disc_model`: it did nothing here, and took over that of python."""
    environment = {"HOME": str(tmp_path), "PATH": PATH, "PS1": PROMPT}
    with shell([program, "-i"], tmp_path, **environment) as terminal:
        terminal.type("disc-model --install-completion\n")
        terminal.wait_for("Completion will take effect")
    texts = [file.read_text() for file in tmp_path.rglob("*") if file.is_file() and "history" not in file.name]
    assert any("disc-model" in text for text in texts)
    assert not any("python" in text for text in texts)
    with shell([program, "-i"], tmp_path, **environment) as terminal:
        tabs = "\t\t" if program == "zsh" else "\t"  # the first one in a zsh only loads what was installed
        terminal.type(f"disc-model fl{tabs}")
        terminal.wait_for("disc-model floquet ")
        terminal.type("--normaliz\t")
        terminal.wait_for("--normalization ")
        terminal.type("orth\t")
        terminal.wait_for("orthonormal ")


def test_no_interrupt_leaves_the_folder_locked(tmp_path: Path) -> None:
    """A quarter of a second after Ctrl-C Snakemake was killed, with its lock left behind in 5 of 12 tries."""
    shutil.copy(TEXTS / "long.yaml", tmp_path / "mine.yaml")
    moments = random.Random(27)
    with shell(["bash", "--norc", "-i"], tmp_path, PATH=PATH, PS1=PROMPT) as terminal:
        terminal.wait_for(PROMPT)
        terminal.type("disc-model study mine.yaml -j2 --snakemake '--until compile'\n")
        assert "Error" not in terminal.wait_for(PROMPT, 600)  # as its closing lines asked for what was not made
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
