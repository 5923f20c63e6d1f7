"""Studies on machines that are set up a little differently: right figures, nothing out of date."""

import os
import sys
import sysconfig
from pathlib import Path

import pytest
import xarray as xr

from tests.processes import run
from tests.workflow.conftest import ROOT

pytestmark = pytest.mark.slow

STUDY = """\
study: s
quantity: floquet
base: {N: 200, Omega: 20, n_diameters: 1}
axes: {mu_s: [0.3, 0.4], mu_k: [0.1, 0.2]}
figures:
  growth: {kind: heat_map, variable: growth_rate, x: mu_s, y: mu_k}
"""
COMMAND = (sys.executable, "-m", "disc_model", "study", "s.yaml", "-j2")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a study, its name with a space."""
    made = tmp_path / "my study"
    made.mkdir()
    (made / "s.yaml").write_text(STUDY)
    return made


def results(folder: Path) -> tuple[xr.Dataset, bytes]:
    """The dataset of the study and its figure."""
    picture = (folder / "results" / "s" / "figures" / "growth.png").read_bytes()
    assert picture.startswith(b"\x89PNG")
    return xr.load_dataset(folder / "results" / "s" / "s.nc"), picture


def test_a_profile_that_looks_at_times_alone_leaves_nothing_out_of_date(folder: Path) -> None:
    """Results of the former values stayed, and nothing was said."""
    profile = folder / "profile"
    profile.mkdir()
    (profile / "config.yaml").write_text("rerun-triggers: [mtime]\n")
    variables = {"SNAKEMAKE_PROFILE": str(profile)}
    run(*COMMAND, cwd=folder, timeout=300, **variables)
    before, picture = results(folder)
    (folder / "s.yaml").write_text(STUDY.replace("N: 200", "N: 210"))
    run(*COMMAND, cwd=folder, timeout=300, **variables)
    after, _ = results(folder)
    assert (before["growth_rate"] != after["growth_rate"]).all()
    (folder / "s.yaml").write_text(STUDY.replace("variable: growth_rate", "variable: period"))
    run(*COMMAND, cwd=folder, timeout=300, **variables)
    again, other_picture = results(folder)
    xr.testing.assert_identical(again, before)
    assert other_picture != picture


def test_an_interpreter_of_another_name_runs_the_jobs(folder: Path) -> None:
    """Jobs called `python`, which may be missing or another version."""
    programs = folder / "bin"
    programs.mkdir()
    (programs / "python").write_text("#!/bin/sh\necho another version >&2\nexit 99\n")
    (programs / "python").chmod(0o755)
    interpreter = programs / "python3"
    interpreter.symlink_to(Path(sys.base_prefix) / "bin" / Path(sys.executable).resolve().name)
    variables = {
        "PATH": os.pathsep.join([str(programs), os.environ["PATH"]]),
        "PYTHONPATH": os.pathsep.join([str(ROOT / "src"), sysconfig.get_path("purelib")]),
    }
    run(interpreter, *COMMAND[1:], cwd=folder, timeout=300, **variables)
    results(folder)


def test_a_notebook_s_choice_for_pictures_does_not_count(folder: Path) -> None:
    """Every job that draws a figure failed."""
    notebook = {"MPLBACKEND": "module://no_such_module.backend"}
    run(*COMMAND, cwd=folder, timeout=300, **notebook)
    results(folder)
