"""What the rules have in common."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from tests.workflow.conftest import ROOT, TEXTS, copy_repository

pytestmark = [pytest.mark.workflow, pytest.mark.slow]


def rules() -> dict[str, str]:
    """The text of each rule."""
    texts = {}
    for file in (ROOT / "workflow" / "rules").glob("*.smk"):
        blocks = re.split(r"^ *rule (\w+):$", file.read_text(), flags=re.MULTILINE)
        texts |= dict(zip(blocks[1::2], blocks[2::2], strict=True))
    return texts


def test_what_takes_the_whole_machine_takes_one_thread_of_a_node_of_its_own() -> None:
    """The answers' rules asked SLURM for 1024 processors, which no node has."""
    profile = yaml.safe_load((ROOT / "workflow" / "profiles" / "slurm" / "config.yaml").read_text())
    whole = {name for name, text in rules().items() if "threads: 1024" in text}
    assert whole == profile["set-threads"].keys()
    assert all("--exclusive" in profile["set-resources"][name]["slurm_extra"] for name in whole)


COUNTS = """
import atexit, gc, sys

def count():
    kernels = [one for one in gc.get_objects() if type(getattr(one, "_cache", None)).__name__ == "KernelCache"]
    if any(one.stats.cache_misses for one in kernels):
        print(sys.argv, file=open(FILE, "a"))

atexit.register(count)
"""
"""Imported by each Python that starts: it writes down which of them compiled kernels."""
KINDS = (TEXTS / "kinds.yaml").read_text()


@pytest.mark.parametrize("config", ["config/test.yaml", "config/kinds.yaml"])
def test_no_job_compiles_kernels_for_itself(tmp_path: Path, config: str) -> None:
    """Cases with more modes and on ramps compiled theirs, and motions of points under other laws of contact."""
    cache, counted = tmp_path / "cache", tmp_path / "compiled.txt"
    project = copy_repository(tmp_path / "project", {"config/kinds.yaml": KINDS}, NUMBA_CACHE_DIR=str(cache))
    (project.folder / "src" / "sitecustomize.py").write_text(f"FILE = {str(counted)!r}\n{COUNTS}")
    replace(project, config=config).complete("-j2", "all", "explorer")
    who = counted.read_text().splitlines()
    assert who
    assert [job for job in who if "compile" not in job] == []
