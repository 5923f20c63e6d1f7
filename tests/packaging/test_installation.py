"""The package as others get it: built, installed from the locked versions, and used without the
sources."""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests import processes

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]


def run(*command: str | Path, cwd: Path, **environment: str) -> str:
    """Output of a command that must succeed, run with nothing in the environment that leads to the
    sources."""
    clean = ("env", "-u", "PYTHONPATH", "-u", "VIRTUAL_ENV")
    return processes.run(*clean, *command, cwd=cwd, timeout=1800, **environment).stdout


@pytest.fixture(scope="session")
def index() -> None:
    """A package index that answers."""
    ask = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "--dry-run",
        "--ignore-installed",
        "--no-deps",
        "--quiet",
        "wheel",
    ]
    if subprocess.run(ask, capture_output=True, check=False, timeout=600).returncode:
        pytest.skip("no package index can be reached")


@pytest.fixture(scope="session")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What a clone would have, as it is now."""
    left_out = shutil.ignore_patterns(".*", "results", "build", "dist", "__pycache__", "*.egg-info")
    return shutil.copytree(
        ROOT, tmp_path_factory.mktemp("clone") / "disc_model", symlinks=True, ignore=left_out
    )


@pytest.fixture(scope="session")
def wheel(tree: Path, index: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """By way of an sdist, which so has all that a build needs."""
    out = tmp_path_factory.mktemp("dist")
    run(sys.executable, "-m", "build", "--outdir", out, tree, cwd=out)
    [wheel] = out.glob("*.whl")
    return wheel


def test_the_wheel_is_the_package_and_nothing_else(wheel: Path, tree: Path) -> None:
    """The workflow is linked to; the paper's part of it stays in the repository."""
    src = tree / "src"
    folders = os.walk(src / "disc_model", followlinks=True)
    sources = {
        Path(folder, name).relative_to(src).as_posix()
        for folder, _, names in folders
        for name in names
        if "workflow/paper" not in folder
    }
    files = zipfile.ZipFile(wheel).namelist()
    assert {name for name in files if ".dist-info/" not in name} == sources


# ---- installed


@dataclass(frozen=True)
class Installed:
    """An environment with the wheel, and an empty folder elsewhere to work in."""

    bin: Path
    work: Path

    def run(self, *command: str | Path) -> str:
        first, *rest = command
        cache = str(self.work / "numba")  # not the user's
        return run(self.bin / first, *rest, cwd=self.work, NUMBA_CACHE_DIR=cache, MPLBACKEND="agg")


@pytest.fixture(scope="module")
def installed(wheel: Path, tree: Path, tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """The wheel among the locked versions; the workflow of .github runs all tests for each
    Python."""
    folder = tmp_path_factory.mktemp("installed")
    run(sys.executable, "-m", "venv", folder / "venv", cwd=folder)
    work = folder / "work"
    work.mkdir()
    made = Installed(folder / "venv" / "bin", work)
    made.run(
        "python",
        "-m",
        "pip",
        "install",
        "--require-hashes",
        "--no-deps",
        "-r",
        tree / "requirements.lock",
    )
    made.run("python", "-m", "pip", "install", "--no-deps", wheel)
    made.run("python", "-m", "pip", "check")
    return made


USE = """\
import importlib, json, pkgutil, sys
import disc_model

result = disc_model.simulate(disc_model.Parameters(N=385, Omega=15.1), 2)
result.to_tree().to_netcdf("run.nc")
for module in pkgutil.walk_packages(disc_model.__path__, "disc_model."):
    if module.name != "disc_model.__main__":
        importlib.import_module(module.name)
files = [module.__file__ for module in sys.modules.values() if getattr(module, "__file__", None)]
print(json.dumps({"status": result.status.value, "steps": int(result.statistics["steps"]), "files": files}))
"""


def test_it_works_without_the_sources(installed: Installed) -> None:
    """A run, a dataset, and every module with the data it reads."""
    result = json.loads(
        installed.run("python", "-I", "-W", "error::SyntaxWarning", "-c", USE).splitlines()[-1]
    )
    assert result["status"] == "ok"
    assert result["steps"] > 0
    assert not [name for name in result["files"] if Path(name).is_relative_to(ROOT)]
    assert (installed.work / "run.nc").stat().st_size > 0


def test_a_study_needs_no_clone(installed: Installed) -> None:
    study = installed.work / "s.yaml"
    study.write_text("{study: s, quantity: floquet, base: {N: 385}, axes: {Omega: [12, 15]}}")
    assert "merge_grid" in installed.run("disc-model", "study", study, "-n", "-d", "own")
