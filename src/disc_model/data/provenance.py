"""Provenance of a result: versions of packages, and the commit; the hash of its sources is in `disc_model.sources`."""

import functools
import importlib.metadata
import platform
import subprocess
from pathlib import Path

from disc_model.sources import PACKAGE

VERSIONS_OF = ("disc_model", "numpy", "scipy", "numba", "pandas", "xarray", "netCDF4")


def versions(*further: str) -> dict[str, str]:
    """Versions of Python and of the packages on which results depend, and of further packages."""
    known = {"python": platform.python_version()}
    for name in (*VERSIONS_OF, *further):
        try:
            known[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            known[name] = "not installed" if name in further else "unknown"
    return known


@functools.lru_cache(maxsize=1)
def git_commit(package: Path = PACKAGE) -> str:
    """Commit of the sources, with ``-dirty`` if they were changed since; "unknown" outside their repository."""
    try:
        # an environment may lie within the repository of another project
        _git(package, "ls-files", "--error-unmatch", "__init__.py")
        return _git(package, "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*")
    except (OSError, subprocess.SubprocessError):
        return "unknown"


def _git(folder: Path, *arguments: str) -> str:
    done = subprocess.run(["git", *arguments], cwd=folder, capture_output=True, text=True, timeout=20, check=True)
    return done.stdout.strip()
