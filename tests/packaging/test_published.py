"""What a public host is told: addresses and definitions for actions."""

import re
import tomllib
from pathlib import Path

from tests import needs
from tests.processes import run

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
WORKFLOWS = {path.stem: path for path in (ROOT / ".github" / "workflows").glob("*.yml")}


ADDRESSES: dict[str, str] = PROJECT.get("urls", {})
"""Addresses of repository, documentation and DOI; none before the first release."""
LINKING = ("README.md", "CITATION.cff", "CONTRIBUTING.md", "CHANGELOG.md")
OWN = re.compile(
    r"https://github\.com/\w+/disc_model"
    r"|https://\w+\.github\.io/disc_model"
    r"|10\.5281/zenodo\.\d+"
    r"|\bOWNER\b"
)
"""An address of this project, or the placeholder of one."""


def linking_texts() -> dict[str, str]:
    """Texts of the pages and of the files that describe the project, by path."""
    paths = [ROOT / name for name in LINKING]
    paths += [path for path in (ROOT / "docs").rglob("*.md") if "_build" not in path.parts]
    return {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in paths}


def test_what_is_not_published_is_not_linked() -> None:
    published = " ".join(ADDRESSES.values())
    texts = linking_texts()
    texts["pyproject.toml"] = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    wrong = [
        f"{path}: {match[0]}"
        for path, text in texts.items()
        for match in OWN.finditer(text)
        if match[0] not in published or match[0] == "OWNER"
    ]
    assert not wrong, "\n".join(wrong)


@needs.ACTIONLINT.mark
def test_definitions_for_actions_have_no_faults() -> None:
    assert run(needs.program("actionlint"), *WORKFLOWS.values()).stdout == ""
