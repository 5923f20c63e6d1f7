"""What a public host is told: addresses, and definitions for GitHub Actions; and the parts of `make test`."""

import re
import tomllib
from pathlib import Path

from tests import needs
from tests.processes import run

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
WORKFLOWS = {path.stem: path for path in (ROOT / ".github" / "workflows").glob("*.yml")}


@needs.ACTIONLINT.mark
def test_definitions_for_actions_have_no_faults() -> None:
    assert run(needs.program("actionlint"), *WORKFLOWS.values()).stdout == ""


def test_every_file_of_quick_tests_is_in_one_part() -> None:
    """Those of the workflow are not quick."""
    phrase = run("make", "-n", "test-parts").stdout
    parts = [ROOT / path for line in re.findall(r"pytest .*", phrase) for path in re.findall(r"tests/\S*", line)]
    files = {path for path in (ROOT / "tests").rglob("test_*.py") if "workflow" not in path.relative_to(ROOT).parts}
    assert len(files) > 50
    assert all(part.exists() for part in parts)
    for file in files:
        assert sum(file == part or part in file.parents for part in parts) == 1, file
