"""Who follows one case or one grid point through the package has few rooms to look into."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("way", "most", "some", "written"),
    [
        ("file", 5, {"studies/document.py", "studies/study.py"}, "batches.json"),
        (
            "case",
            16,
            {"studies/document.py", "simulation/api.py", "plate.py", "data/dataset.py"},
            "fig02.png",
        ),
        ("point", 24, {"studies/document.py", "studies/grids/run.py", "plate.py", "data/dataset.py"}, "batch.nc"),
    ],
)
def test_a_way_enters_few_rooms(way: str, most: int, some: set[str], written: str, tmp_path: Path) -> None:
    """In a process of its own: what is remembered from before would not be entered again."""
    command = [sys.executable, "-m", "tests.packaging.rooms", way, str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    rooms = json.loads(done.stdout.splitlines()[-1])
    assert (tmp_path / written).is_file()
    assert some <= set(rooms)
    assert len(rooms) <= most, rooms
