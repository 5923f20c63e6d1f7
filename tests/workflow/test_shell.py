"""The command line as shells use it: completion, and Ctrl-C."""

from __future__ import annotations

import os
import random
import re
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = [pytest.mark.workflow, pytest.mark.slow]

PROGRAM = str(Path(sys.executable).with_name("disc-model"))
STUDY = """\
study: mine
quantity: floquet
base: {N: 200, Omega: 20}
axes:
  mu_s: {start: 0.3, stop: 0.6, count: 61}
  mu_k: {start: 0.05, stop: 0.3, count: 51}
figures:
  growth: {kind: heat_map, variable: growth_rate, x: mu_s, y: mu_k}
"""


@pytest.mark.parametrize("shell", ["bash", "zsh"])
def test_a_shell_completes_commands_options_and_words(shell: str, tmp_path: Path) -> None:
    """Completion was that of a program `python -m disc_model`: it did nothing here, and took over that of python."""

    def run(*arguments: str, **variables: str) -> str:
        environment = os.environ | {"HOME": str(tmp_path), "_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"}
        return subprocess.run(
            [PROGRAM, *arguments], env=environment | variables, capture_output=True, text=True, check=True, timeout=60
        ).stdout

    run("--install-completion", shell)
    texts = [file.read_text() for file in tmp_path.rglob("*") if file.is_file()]
    [asked] = {word for text in texts for word in re.findall(r"\w+_COMPLETE(?==)", text)}
    assert not any("python" in text for text in texts)
    for typed, wanted in (
        ("disc-model fl", "floquet"),
        ("disc-model floquet --normaliz", "--normalization"),
        ("disc-model floquet --normalization orth", "orthonormal"),
    ):
        words = {"COMP_WORDS": typed, "COMP_CWORD": str(typed.count(" ")), "_TYPER_COMPLETE_ARGS": typed}
        assert wanted in run(**{asked: f"complete_{shell}"}, **words)


def locks(folder: Path) -> list[Path]:
    return list(folder.glob(".snakemake/locks/*"))


def test_no_interrupt_leaves_the_folder_locked(tmp_path: Path) -> None:
    """A quarter of a second after Ctrl-C Snakemake was killed, with its lock left behind in 5 of 12 tries."""
    (tmp_path / "mine.yaml").write_text(STUDY)
    command, chance = [PROGRAM, "study", "-j2"], random.Random(27)
    for _ in range(10):
        # as a terminal does: to all processes of a group of their own, none of which ignores it
        run = subprocess.Popen(command, cwd=tmp_path, process_group=0, stderr=subprocess.PIPE, text=True)
        assert run.stderr
        moment = chance.choice(["study file: mine.yaml", "rule compute_batch:"])
        for line in run.stderr:
            if moment in line:
                break
        time.sleep(chance.uniform(0.0, 4.0))
        os.killpg(run.pid, signal.SIGINT)
        said = run.communicate(timeout=300)[1]
        assert run.returncode in (130, -signal.SIGINT), said  # both are 130 to a shell
        assert not locks(tmp_path), said


def test_the_lock_of_a_killed_run_is_told_with_the_command_that_removes_it(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(STUDY)
    command = [PROGRAM, "study"]
    run = subprocess.Popen(command, cwd=tmp_path, process_group=0)
    while not locks(tmp_path):
        assert run.poll() is None
        time.sleep(0.05)
    os.killpg(run.pid, signal.SIGKILL)
    run.wait()
    told = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=300)
    assert told.returncode != 0
    [own] = re.findall("After a killed one: disc-model study (.*)", told.stderr)
    subprocess.run([*command, *shlex.split(own)], cwd=tmp_path, check=True, timeout=300)
    assert not locks(tmp_path)
