"""What the rules have in common."""

from dataclasses import replace
from pathlib import Path

import pytest

from tests.workflow.conftest import TEXTS, copy_repository

pytestmark = [pytest.mark.workflow, pytest.mark.slow]


COUNTS = """
import atexit, gc

def count():
    kernels = [one for one in gc.get_objects() if type(getattr(one, "_cache", None)).__name__ == "KernelCache"]
    with open(FILE, "a") as file:
        for kernel in kernels:
            for signature in kernel.stats.cache_misses:
                print(kernel.__name__, signature, file=file)

atexit.register(count)
"""
"""Imported by each Python that starts: it writes down which kernels it compiled."""
KINDS = (TEXTS / "kinds.yaml").read_text()


def test_jobs_at_the_same_time_compile_each_kernel_once(tmp_path: Path) -> None:
    counted = tmp_path / "compiled.txt"
    environment = {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    project = copy_repository(tmp_path / "project", {"config/kinds.yaml": KINDS}, **environment)
    (project.folder / "src" / "sitecustomize.py").write_text(f"FILE = {str(counted)!r}\n{COUNTS}")
    replace(project, config="config/kinds.yaml").complete("-j2", "all", "explorer")
    kernels = counted.read_text().splitlines()
    assert kernels
    assert sorted(kernels) == sorted(set(kernels))
