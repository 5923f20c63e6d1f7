"""Commits."""

import subprocess
from pathlib import Path

from disc_model.sources import git_commit


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
