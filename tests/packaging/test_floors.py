"""The import contracts notice what they forbid."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def checked(folder: Path) -> str:
    """What `lint-imports` says of a copy of the package."""
    command = [sys.executable, "-c", "from importlinter.cli import lint_imports_command; lint_imports_command()"]
    options = ["--config", str(ROOT / "pyproject.toml"), "--no-cache"]
    environment = os.environ | {"PYTHONPATH": str(folder)}
    return subprocess.run([*command, *options], cwd=folder, env=environment, capture_output=True, text=True).stdout


@pytest.mark.parametrize(
    ("module", "imported", "broken"),
    [
        ("plate", "disc_model.simulation.api", "The floors of the house BROKEN"),
        ("simulation/result", "disc_model.simulation.api", "No circle of imports, at any depth BROKEN"),
        ("engine/machine", "pandas", "schemas or plots BROKEN"),
        ("figures/parts", "disc_model.simulation.api", "The figures never run the engine BROKEN"),
        ("attic", "math", "not listed as layers"),
    ],
)
def test_a_wrong_import_is_noticed_even_inside_a_function(
    module: str, imported: str, broken: str, tmp_path: Path
) -> None:
    shutil.copytree(ROOT / "src/disc_model", tmp_path / "disc_model", ignore=shutil.ignore_patterns("__pycache__"))
    with (tmp_path / f"disc_model/{module}.py").open("a") as file:
        file.write(f"\n\ndef _wrong():\n    import {imported}\n")
    assert broken in checked(tmp_path)


def test_the_house_as_it_stands_keeps_its_contracts() -> None:
    assert " 0 broken." in checked(ROOT / "src")
