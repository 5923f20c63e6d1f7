"""The parts in which `make test` runs hold each file of tests once."""

import re
from pathlib import Path

from tests.processes import run

ROOT = Path(__file__).resolve().parents[2]


def test_every_file_of_quick_tests_is_in_one_part() -> None:
    """Those of the workflow are not quick."""
    phrase = run("make", "-n", "test-parts").stdout
    parts = [ROOT / path for line in re.findall(r"pytest .*", phrase) for path in re.findall(r"tests/\S*", line)]
    files = {path for path in (ROOT / "tests").rglob("test_*.py") if "workflow" not in path.parts}
    assert len(files) > 50
    assert all(part.exists() for part in parts)
    for file in files:
        assert sum(file == part or part in file.parents for part in parts) == 1, file
