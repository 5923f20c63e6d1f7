"""A small study that is treated badly, and what its results are compared by."""

from __future__ import annotations

import os
import re
import signal
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from tests.tally import tried
from tests.workflow.conftest import Project

CONFIG = "config/faulty.yaml"
MAIN = """\
study: faulty
claims: true
record:
  windows:
    history: {rate: 500, envelope: 50}
cases:
  F11: {title: quiet, parameters: {N: 385, Omega: 15}, t_end: 2}
  F13: {title: growing, parameters: {N: 385, Omega: 15.1}, t_end: 2}
figures: [fig11]
studies: [config/faulty_*.yaml]
"""
MAP = """\
study: faulty_map
quantity: outcome
options: {horizon: 1, late: 0.2, after_separation: 0.2}
axes:
  N: [100, 300]
  Omega: [10, 15, 20]
batch: {over: [Omega], size: 3}
"""
KINDS = {".nc", ".csv", ".md", ".html", ".pdf", ".png"}
INPUT = re.compile("/(cases|batches|merged)/")


needs_proc = pytest.mark.skipif(not Path("/proc/self").exists(), reason="finds jobs in /proc")
STUDY = {CONFIG: MAIN, "config/faulty_map.yaml": MAP}


def products(project: Project) -> dict[str, bytes]:
    """Content of every file that the study is about; no logs."""
    results = project.folder / "results"
    return {
        str(path.relative_to(results)): path.read_bytes()
        for path in sorted(results.rglob("*"))
        if path.suffix in KINDS and not path.name.startswith(".")
    }


@dataclass(frozen=True)
class Copy(Project):
    """A copy of the study that is treated badly, and what the files of an undisturbed run hold."""

    undisturbed: Mapping[str, bytes] = field(default_factory=dict)

    def recovers(self, what: str, count: int = 1) -> None:
        """A run after faults gives the same bytes."""
        self.complete("-j2")
        self.recovered(what, count)

    def recovered(self, what: str, count: int = 1) -> None:
        """The run after faults has been: same bytes. Inputs of finished files may be missing: nothing asks for them."""
        found, wanted = products(self), self.undisturbed
        assert set(found) <= set(wanted)
        assert {name for name in set(wanted) - set(found) if not INPUT.search(name)} == set()
        assert [name for name in found if found[name] != wanted[name]] == []
        tried("faults, after which a rerun gave the same bytes", what, count)


def jobs(project: Project) -> list[int]:
    """Processes of the project's jobs: scripts, by their whole path, and the package itself."""
    commands = project.processes().items()
    return [
        process for process, words in commands if "workflow/scripts/" in words[1] or words[1:3] == ["-m", "disc_model"]
    ]


def kill(process: int) -> bool:
    """Whether there was still something to kill."""
    try:
        os.kill(process, signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True


def wait_until(holds: Callable[[], object], seconds: float = 120.0) -> None:
    until = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < until
        time.sleep(0.05)
