"""What a public host is told: addresses, locked packages, definitions for actions; and the parts of `make test`."""

import re
import tomllib
from pathlib import Path

import yaml

from tests import needs
from tests.processes import run

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
WORKFLOWS = {path.stem: path for path in (ROOT / ".github" / "workflows").glob("*.yml")}


def test_addresses_are_those_of_pyproject() -> None:
    urls = PROJECT["urls"]
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert (cited["repository-code"], cited["url"]) == (urls["Repository"], urls["Documentation"])
    assert f"https://doi.org/{cited['doi']}" == urls["DOI"]
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    for name, address in urls.items():
        assert f"[{name}]({address})" in readme
    # no other page names another place of the project
    owner = re.compile(r"https://(?:github\.com/(\w+)/disc_model|(\w+)\.github\.io/disc_model)")
    texts = [path.read_text(encoding="utf-8") for path in (*ROOT.glob("*.*"), *ROOT.glob("docs/*.*")) if path.is_file()
             and path.suffix in (".md", ".cff", ".toml", ".py")]  # fmt: skip
    assert len({one or other for text in texts for one, other in owner.findall(text)}) == 1


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
