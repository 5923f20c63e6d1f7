"""The library without the paper's part and the benchmark's: both can be deleted, and studies are
computed as before."""

import shutil
import sys
from pathlib import Path

import pytest

from tests.processes import run
from tests.test_cli import STUDY
from tests.workflow.conftest import ROOT

WITHOUT = """
import importlib, pkgutil, disc_model
assert {path!r} in disc_model.__file__, disc_model.__file__
for module in pkgutil.walk_packages(disc_model.__path__, "disc_model."):
    assert module.name not in ("disc_model.paper", "disc_model.benchmarks")
    if "__main__" not in module.name and ".workflow" not in module.name:
        importlib.import_module(module.name)
"""


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    """The sources without both parts."""
    for folder in ("src/disc_model", "workflow", "config"):
        shutil.copytree(
            ROOT / folder,
            tmp_path / folder,
            symlinks=True,
            ignore=shutil.ignore_patterns("__pycache__"),
        )
    path = tmp_path / "src" / "disc_model"
    for part in ("paper", "benchmarks"):
        shutil.rmtree(path / part)
    return tmp_path


def test_all_that_remains_can_be_imported(clone: Path) -> None:
    run(
        sys.executable,
        "-c",
        WITHOUT.format(path=str(clone)),
        cwd=clone,
        PYTHONPATH=str(clone / "src"),
    )


@pytest.mark.slow
@pytest.mark.workflow
def test_a_study_is_computed(clone: Path) -> None:
    """One that asks for verdicts is refused before anything runs."""
    command = [
        sys.executable,
        "-m",
        "snakemake",
        "-s",
        "workflow/Snakefile",
        "--configfile",
        "mine.yaml",
        "-j2",
    ]
    (clone / "mine.yaml").write_text(STUDY)
    run(*command, cwd=clone, timeout=900, PYTHONPATH=str(clone / "src"))
    made = {path.name for path in (clone / "results" / "mine").rglob("*.*")}
    assert {"mine.nc", "cases.nc", "growth.png", "seen.png", "provenance.html"} <= made
    (clone / "mine.yaml").write_text(f"{STUDY}\nclaims: true\n")
    refused = run(*command, "-n", cwd=clone, fails=True, timeout=100, PYTHONPATH=str(clone / "src"))
    assert "claims need disc_model.paper, which is not here" in refused.stdout + refused.stderr
