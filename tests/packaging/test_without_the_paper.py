"""The workflow without the paper's part and the benchmark: a study is computed as before."""

import shutil
import sys
from pathlib import Path

import pytest

from tests.processes import run
from tests.workflow.conftest import BRACES as STUDY
from tests.workflow.conftest import ROOT


@pytest.mark.slow
def test_a_study_is_computed(tmp_path: Path) -> None:
    """One that asks for verdicts is refused before anything runs."""
    for folder in ("src/disc_model", "workflow"):
        left_out = shutil.ignore_patterns("__pycache__", "paper")
        shutil.copytree(ROOT / folder, tmp_path / folder, symlinks=True, ignore=left_out)
    shutil.copy(ROOT / "Snakefile", tmp_path)
    command = [sys.executable, "-m", "snakemake", "--configfile", "mine.yaml", "-j2"]
    (tmp_path / "mine.yaml").write_text(STUDY)
    run(*command, cwd=tmp_path, timeout=900, PYTHONPATH=str(tmp_path / "src"))
    made = {path.name for path in (tmp_path / "results" / "mine").rglob("*.*")}
    assert {"mine.nc", "A.nc", "growth.png", "seen.png", "provenance.html"} <= made
    (tmp_path / "mine.yaml").write_text(f"{STUDY}\nclaims: true\n")
    refused = run(*command, "-n", cwd=tmp_path, fails=True, PYTHONPATH=str(tmp_path / "src"))
    assert "mine: claims are judged by the Snakefile of a clone" in refused.stdout + refused.stderr
