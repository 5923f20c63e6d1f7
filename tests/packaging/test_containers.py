"""Recipes of containers: two that hold the same, of files that exist and suffice."""

import re
import shutil
import sys
from pathlib import Path

import pytest

from tests.processes import run

ROOT = Path(__file__).parents[2]
DOCKER = (ROOT / "Containerfile").read_text(encoding="utf-8")
APPTAINER = (ROOT / "container.def").read_text(encoding="utf-8")
BASE = r"python:(\d\.\d+)-slim-\w+"


def docker_instructions() -> list[str]:
    """The instructions of the recipe for Docker, each on a line."""
    joined = DOCKER.replace("\\\n", " ")
    return [line for line in joined.splitlines() if line and not line.startswith("#")]


def docker_files() -> set[str]:
    """What the recipe for Docker copies into /opt/disc_model."""
    copied = [line.split()[1:] for line in docker_instructions() if line.startswith("COPY ")]
    return {source for *sources, _ in copied for source in sources}


def section(name: str) -> list[str]:
    """The lines of a section of the recipe for Apptainer."""
    found = re.search(rf"^%{name}\n(.*?)(?=^%|\Z)", APPTAINER, re.M | re.S)
    assert found, name
    return [line.strip() for line in found[1].splitlines() if line.strip()]


def docker_commands() -> list[str]:
    """The commands that the recipe for Docker runs, and where."""
    runs = [line.removeprefix("RUN ") for line in docker_instructions() if "RUN " in line]
    return [part.strip() for line in runs for part in line.split("&&")]


def test_both_recipes_hold_the_same() -> None:
    bases = (
        re.search(f"^FROM {BASE}$", DOCKER, re.M),
        re.search(f"^From: {BASE}$", APPTAINER, re.M),
    )
    assert bases[0]
    assert bases[1]
    assert bases[0][0].split()[1] == bases[1][0].split()[1]
    copied = [line.split() for line in section("files")]
    assert all(target == f"/opt/disc_model/{source}" for source, target in copied)
    assert {source for source, _ in copied} == docker_files()
    around = {"set -eu", "cd /opt/disc_model"}
    assert [line for line in section("post") if line not in around] == docker_commands()


def test_the_recipes_install_the_locked_versions() -> None:
    assert "make env && .venv/bin/python -m compileall -q src" in DOCKER
    assert {"Makefile", "requirements.lock", "pyproject.toml"} <= docker_files()
    assert "--require-hashes -r requirements.lock" in (ROOT / "Makefile").read_text()


@pytest.mark.slow
def test_the_files_of_a_container_suffice(tmp_path: Path) -> None:
    """Links are followed, as by Apptainer; a study that is checked finds all that it needs."""
    for name in docker_files():
        source = ROOT / name
        if source.is_dir():
            left_out = shutil.ignore_patterns("__pycache__", "*.egg-info")
            shutil.copytree(source, tmp_path / name, ignore=left_out)
        else:
            shutil.copy(source, tmp_path / name)
    path = tmp_path / "src"
    variables = {"PYTHONPATH": str(path), "PYTHONDONTWRITEBYTECODE": "1"}
    code = "import disc_model; print(disc_model.__file__)"
    assert run(sys.executable, "-c", code, cwd=tmp_path, **variables).stdout.startswith(str(path))
    study = ROOT / "config" / "studies" / "test" / "test_growth.yaml"
    command = (sys.executable, "-m", "disc_model", "study", study, "-n", "-j1")
    done = run(*command, cwd=tmp_path, **variables)
    assert "compute_batch" in done.stdout + done.stderr
    for shell in (section("post"), section("runscript"), section("test")):
        run("sh", "-n", "-c", "\n".join(shell))
