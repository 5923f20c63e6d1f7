"""Hashes of sources, and the commit of the package's own repository."""

import subprocess
from pathlib import Path

import pytest

from disc_model.provenance import figures_hash, git_commit, hash_of, physics_hash


def test_names_and_bytes_of_a_folder_count(tmp_path: Path) -> None:
    hashes = {physics_hash(), figures_hash()}
    for name, content in (
        ("a.py", "x = 1"),
        ("b.toml", "x = 1"),
        ("b.toml", "x = 2"),
        ("b.pyc", ""),
    ):
        (tmp_path / name).write_text(content)
        hashes.add(hash_of([tmp_path]))
    assert len(hashes) == 5
    with pytest.raises(FileNotFoundError):
        hash_of(["no_such_part"])


def test_the_commit_of_another_repository_is_not_taken(tmp_path: Path) -> None:
    """The package may be installed in an environment that lies in somebody's own repository."""

    def git(*words: str) -> None:
        identity = ("-c", "user.name=somebody", "-c", "user.email=somebody@example.org")
        subprocess.run(["git", *identity, *words], cwd=tmp_path, check=True)

    site = tmp_path / "venv" / "disc_model"
    site.mkdir(parents=True)
    (site / "__init__.py").write_text("")
    git("init", "-q")
    git("commit", "-q", "--allow-empty", "-m", "own work")
    assert git_commit(site) == "unknown"
    git("add", ".")
    git("commit", "-q", "-m", "all of it")
    git_commit.cache_clear()
    assert len(git_commit(site)) == 40
