"""A finished small study, made once, and copies of it to change."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Self

import pytest

from tests.processes import run

ROOT = Path(__file__).parents[2]
PARTS = ("Snakefile", "workflow", "profiles", "config", "src")

TEXTS = Path(__file__).with_name("studies")
BRACES = (TEXTS / "braces.yaml").read_text()
SMALL = "config/small.yaml"
MAP = "config/small_map.yaml"
STUDIES = {f"config/{path.name}": path.read_text() for path in sorted(TEXTS.glob("small*.yaml"))}
PRODUCTS = {".nc", ".csv", ".md", ".html", ".pdf", ".png"}


@dataclass(frozen=True)
class Project:
    """A copy of the repository in which Snakemake runs.

    Attributes
    ----------
    folder : where it is
    config : the study file that is run; None for what is run if none is named
    variables : of the environment, beyond those of the tests
    """

    folder: Path
    config: str | None = None
    variables: Mapping[str, str] = field(default_factory=dict)

    def complete(self, *options: str, fails: bool = False) -> str:
        """Run Snakemake as a user would, with the copy's own sources; it must succeed, or fail;
        what it says."""
        done = run(*self.command(*options), cwd=self.folder, fails=fails, timeout=900, **self.own)
        return done.stdout + done.stderr

    def command(self, *options: str) -> list[str]:
        """The command of such a run."""
        named = []
        if self.config:
            named = ["--configfile", self.config]
        return [sys.executable, "-m", "snakemake", *options, *named]

    @property
    def own(self) -> dict[str, str]:
        """Variables of the environment of such a run."""
        return {
            "PYTHONPATH": str(self.folder / "src"),
            "PYTHONDONTWRITEBYTECODE": "1",
            **self.variables,
        }

    def start(
        self, *options: str, log: str = "run.log", prepare: Callable[[], object] | None = None
    ) -> subprocess.Popen[bytes]:
        """Run Snakemake in the background, in a session of its own, which does what ``prepare``
        says; add to a log."""
        with (self.folder / log).open("ab") as file:
            return subprocess.Popen(
                self.command(*options), cwd=self.folder, env=os.environ | self.own, stdout=file, stderr=file,
                start_new_session=True, preexec_fn=prepare,
            )  # fmt: skip

    def products(self) -> dict[str, bytes]:
        """Content of every file that the study is about; no logs."""
        files = [
            path for path in sorted((self.folder / "results").rglob("*")) if path.suffix in PRODUCTS
        ]
        return {
            str(path.relative_to(self.folder)): path.read_bytes()
            for path in files
            if path.name[0] != "."
        }

    def jobs(self, *options: str) -> Iterator[tuple[str, dict[str, str]]]:
        """Jobs that a run would do: rule and wildcards."""
        shown = self.complete("-n", *options)
        for block in re.split(r"\n(?=(?:local)?rule \w+:)", shown)[1:]:
            rule = re.match(r"(?:local)?rule (\w+):", block)
            wildcards = re.search(r"^ +wildcards: (.*)", block, re.MULTILINE)
            assert rule is not None
            yield rule[1], dict(re.findall(r"(\w+)=([^\s,]+)", wildcards[1] if wildcards else ""))

    def planned(self, *options: str) -> set[str]:
        """The same as rule or rule:wildcard, without the target `all`."""
        return {
            ":".join((rule, *wildcards.values())) for rule, wildcards in self.jobs(*options)
        } - {"all"}

    def edit(self, path: str, old: str, new: str) -> None:
        """Replace a text in a file; it must be there."""
        file = self.folder / path
        text = file.read_text()
        assert old in text
        file.write_text(text.replace(old, new))

    def copy(self, folder: Path) -> Self:
        """A copy to change, times of files included."""
        shutil.copytree(self.folder, folder, symlinks=True)
        return replace(self, folder=folder)

    def forget(self) -> None:
        """Remove all that was made."""
        for made in ("results", ".snakemake"):
            shutil.rmtree(self.folder / made)

    def change(self, path: str) -> None:
        """Change what a source does, as far as anyone can tell without running it: a comment would
        not count."""
        assert (self.folder / path).is_file()
        with (self.folder / path).open("a") as file:
            change = "\n# changed\n"
            if path.endswith(".py"):
                change = "\n_CHANGED = True\n"
            file.write(change)


def copy_repository(
    folder: Path, studies: Mapping[str, str] | None = None, **variables: str
) -> Project:
    """What a run needs of the repository, in a folder of its own, with study files by path: the
    first is run."""
    folder.mkdir(exist_ok=True)
    for part in PARTS:
        source = ROOT / part
        target = folder / part
        if source.is_symlink():
            target.symlink_to(os.readlink(source))
        elif source.is_dir():
            ignored = shutil.ignore_patterns("__pycache__", "*.egg-info")
            shutil.copytree(source, target, symlinks=True, ignore=ignored)
        else:
            shutil.copy2(source, target)
    for path, text in (studies or {}).items():
        (folder / path).write_text(text)
    return Project(folder, next(iter(studies or ()), None), variables)


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """The small study of cases and grids, computed."""
    project = copy_repository(tmp_path_factory.mktemp("project"), STUDIES)
    project.complete("-j2")
    return project


@pytest.fixture
def project(finished: Project, tmp_path: Path) -> Project:
    """A copy of the finished study, times included."""
    file = tmp_path / "project"
    return finished.copy(file)
