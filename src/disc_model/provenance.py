"""The origin of a result: names by content, hashes of sources, the commit, and versions of packages."""

import functools
import hashlib
import importlib.metadata
import json
import os
import platform
import subprocess
from collections.abc import Iterable
from pathlib import Path

import platformdirs

PACKAGE = Path(__file__).resolve().parent

# ---- Names by content


def content_key(text: str) -> str:
    """First 12 hexadecimal digits of the sha256 of a text."""
    return hashlib.sha256(text.encode()).hexdigest()[:12]


# ---- Sources

_ABOVE = ("__init__.py", "__main__.py", "cli.py", "display.py", "fit.py", "provenance.py")
"""Modules beside the folders, which decide no number of a study."""


@functools.cache
def physics_hash() -> str:
    """Hash of all sources that decide the numbers of a point: 16 hexadecimal digits."""
    modules = [path.name for path in PACKAGE.glob("*.py") if path.name not in _ABOVE]
    folders = ("analysis", "disc", "engine", "simulation", "stability", "studies/quantities")
    return hash_of([*modules, *folders, "studies/compute.py", "studies/quantity.py"])


@functools.cache
def figures_hash() -> str:
    """Hash of all sources that decide what figures and pages show of data: 16 hexadecimal digits."""
    return hash_of(["data", "explorer", "figures"])


def hash_of(parts: Iterable[str | Path]) -> str:
    """Hash of the names and bytes of files, or of all files of folders, relative to the package:
    16 hexadecimal digits. Raises `FileNotFoundError` for a part that is not there."""
    digest = hashlib.sha256()
    for part in sorted(map(str, parts)):
        path = PACKAGE / part
        files = sorted(path.rglob("*.*")) if path.is_dir() else [path]
        for file in files:
            if file.suffix != ".pyc":
                digest.update(f"{file.relative_to(path.parent).as_posix()}\0".encode())
                digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def code_hash(path: Path) -> str:
    """The hash of the bytes of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def cache_folder() -> Path:
    """The folder of what is made once on a machine, kernels too: numba's if it has one, or the
    user's for caches."""
    return Path(os.environ.get("NUMBA_CACHE_DIR") or platformdirs.user_cache_dir("disc_model"))


# ---- Commit and versions

VERSIONS_OF = ("disc_model", "numpy", "scipy", "numba", "pandas", "xarray", "netCDF4")


@functools.cache
def versions_text() -> str:
    """The `versions` as JSON, for an attribute of results."""
    return json.dumps(versions(), sort_keys=True)


def versions(*further: str) -> dict[str, str]:
    """Versions of Python and of the packages on which results depend, and of further packages."""
    known = {"python": platform.python_version()}
    for name in (*VERSIONS_OF, *further):
        try:
            known[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            known[name] = "not installed"
    return known


@functools.cache
def git_commit(package: Path = PACKAGE) -> str:
    """Commit of the sources, with ``-dirty`` if they were changed since; "unknown" outside their
    repository."""
    # an environment may lie within the repository of another project, which does not list its files
    listed = "ls-files --error-unmatch __init__.py"
    described = "describe --always --dirty --abbrev=40 --exclude=*"
    try:
        for command in (listed, described):
            words = ["git", *command.split()]
            done = subprocess.run(words, cwd=package, capture_output=True, text=True, check=True)
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return done.stdout.strip()
