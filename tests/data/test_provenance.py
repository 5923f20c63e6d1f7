"""Hashes of sources, versions and commits."""

import subprocess
from pathlib import Path

import pytest

from disc_model.data import provenance
from disc_model.data.provenance import PACKAGE, git_commit, source_files, source_hash
from disc_model.data.sources import KINDS, VERSIONS

BODY = "import os\n\ndef f(x, *, y=1.0):\n    return [x, 'text', None] + y\n"


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("# a comment\n" + BODY, True),
        ('"""A docstring."""\n' + BODY, True),
        (BODY.replace("y=1.0", "\n    y = 1.00,\n"), True),
        (BODY.replace("    return", '    """What it does."""\n\n    return'), True),
        (BODY.replace("text", "test"), False),
        (BODY.replace("+ y", "- y"), False),
    ],
)
def test_code_counts_and_what_is_said_of_it_does_not(text: str, same: bool, tmp_path: Path) -> None:
    hashes = []
    for name, content in (("a", BODY), ("b", text)):
        script = tmp_path / name / "job.py"
        script.parent.mkdir()
        script.write_text(content)
        hashes.append(source_hash("errors", files=(script,)))
    assert (hashes[0] == hashes[1]) == same


def test_a_script_is_the_same_beside_the_package_and_within_it() -> None:
    within = PACKAGE / "workflow" / "scripts" / "gc.py"
    assert source_hash("errors", files=(within,)) == source_hash("errors", files=(within.resolve(),))


def test_names_stand_for_kinds_modules_packages_and_files(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(KINDS, "one", "errors explorer/static figures.paper")
    monkeypatch.setitem(KINDS, "other", "one plate")
    found = {path.relative_to(PACKAGE).as_posix() for path in source_files("other", "disc_model.progress")}
    assert {"errors.py", "plate.py", "progress.py", "explorer/static/page.css", "figures/paper/disc.py"} <= found
    assert source_files("one") == tuple(path for path in source_files("other") if path.name != "plate.py")
    before = source_hash("other")
    provenance.source_hash.cache_clear()
    monkeypatch.setitem(VERSIONS, "one", 2)
    assert source_hash("other") != before
    provenance.source_hash.cache_clear()
    with pytest.raises(FileNotFoundError, match="missing"):
        source_files("missing")


def test_the_commit_of_another_repository_is_not_taken(tmp_path: Path) -> None:
    """The package may be installed in an environment that lies in somebody's own repository."""
    site = tmp_path / "venv" / "disc_model"
    site.mkdir(parents=True)
    (site / "__init__.py").write_text("")
    identity = ("-c", "user.name=somebody", "-c", "user.email=somebody@example.org")
    for command in (("init", "-q"), (*identity, "commit", "-q", "--allow-empty", "-m", "own work")):
        subprocess.run(["git", *command], cwd=tmp_path, check=True)
    assert git_commit(site) == "unknown"
    subprocess.run(["git", "add", "."], cwd=tmp_path, check=True)
    subprocess.run(["git", *identity, "commit", "-q", "-m", "all of it"], cwd=tmp_path, check=True)
    git_commit.cache_clear()
    assert len(git_commit(site)) == 40
