"""What a public host is told: addresses, locked packages, definitions for actions; and the parts of `make test`."""

import re
import tomllib
from pathlib import Path

import pytest
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


@pytest.mark.parametrize("lock", sorted(ROOT.glob("requirements*.lock")), ids=lambda path: path.name)
def test_everything_locked_is_pinned_with_hashes_and_no_address(lock: Path) -> None:
    text = lock.read_text(encoding="utf-8")
    assert not re.search(r"://|--(extra-)?index-url|--find-links|--trusted-host| @ ", text)
    blocks = re.split(r"^(?=[A-Za-z0-9])", text, flags=re.MULTILINE)[1:]
    assert len(blocks) > 3
    assert not [
        block for block in blocks if not re.match(r"[A-Za-z0-9._-]+==\S+", block) or "--hash=sha256:" not in block
    ]


def test_what_takes_the_whole_machine_takes_one_thread_of_a_node_of_its_own() -> None:
    """The answers' rules asked SLURM for 1024 processors, which no node has."""
    profile = yaml.safe_load((ROOT / "workflow" / "profiles" / "slurm" / "config.yaml").read_text(encoding="utf-8"))
    texts = [file.read_text(encoding="utf-8") for file in (ROOT / "workflow" / "rules").glob("*.smk")]
    rules = [re.split(r"^ *rule (\w+):$", text, flags=re.MULTILINE) for text in texts]
    whole = {name for one in rules for name, body in zip(one[1::2], one[2::2], strict=True) if "threads: 1024" in body}
    assert whole == profile["set-threads"].keys()
    assert all("--exclusive" in profile["set-resources"][name]["slurm_extra"] for name in whole)


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
