"""What the rules have in common."""

from dataclasses import replace
from pathlib import Path

import pytest

from tests.workflow.conftest import TEXTS, copy_repository

pytestmark = [pytest.mark.workflow, pytest.mark.slow]


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
