"""What a public host is told: addresses, locked packages, definitions for actions; and the parts of
`make test`."""

import re
import tomllib
from pathlib import Path

from tests import needs
from tests.processes import run

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
WORKFLOWS = {path.stem: path for path in (ROOT / ".github" / "workflows").glob("*.yml")}


def test_addresses_are_those_of_pyproject() -> None:
    urls = PROJECT["urls"]
    repository, site = urls["Repository"], urls["Documentation"]
    lines = {
        "README.md": [f"[{name}]({address})" for name, address in urls.items()],
        "CITATION.cff": [
            f"repository-code: {repository}",
            f"url: {site}",
            f"doi: {urls['DOI'].split('/', 3)[3]}",
        ],
        "recipe/meta.yaml": [f"home: {repository}", f"doc_url: {site}"],
    }
    texts = {path: (ROOT / path).read_text(encoding="utf-8") for path in lines}
    wrong = [
        f"{path}: no {line}"
        for path, text in texts.items()
        for line in lines[path]
        if line not in text
    ]
    owner = re.compile(r"https://(?:github\.com/\w+/disc_model|\w+\.github\.io/disc_model)")
    for path in (*ROOT.glob("*.md"), *ROOT.glob("docs/*.*")):
        found = owner.finditer(path.read_text(encoding="utf-8") if path.is_file() else "")
        wrong += [
            f"{path.name}: {match[0]}"
            for match in found
            if match[0] not in (repository, site.rstrip("/"))
        ]
    assert not wrong, "\n".join(wrong)


@needs.ACTIONLINT.mark
def test_definitions_for_actions_have_no_faults() -> None:
    assert run(needs.program("actionlint"), *WORKFLOWS.values()).stdout == ""


def test_every_file_of_quick_tests_is_in_one_part() -> None:
    """Those of the workflow are not quick."""
    phrase = run("make", "-n", "test-parts").stdout
    parts = [
        ROOT / path
        for line in re.findall(r"pytest .*", phrase)
        for path in re.findall(r"tests/\S*", line)
    ]
    files = {
        path
        for path in (ROOT / "tests").rglob("test_*.py")
        if "workflow" not in path.relative_to(ROOT).parts
    }
    assert len(files) > 50
    assert all(part.exists() for part in parts)
    for file in files:
        assert sum(file == part or part in file.parents for part in parts) == 1, file
