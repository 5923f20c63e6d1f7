"""The origin of a result: a hash of the sources that decide it, the commit, and versions of packages."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

from disc_model.sources import git_commit, versions_text

__all__ = ["figures_hash", "git_commit", "physics_hash", "versions_text"]
PACKAGE = Path(__file__).resolve().parent
PHYSICS = (
    *("analysis", "disc", "engine", "simulation", "stability", "studies/quantities"),
    *(
        "modal_disc.py",
        "mode_units.py",
        "parameters.py",
        "units.py",
        "studies/compute.py",
        "studies/quantity.py",
    ),
)
"""Parts of the package that decide the numbers of results."""
DRAWING = ("data", "explorer", "figures")
"""Parts that decide what pictures and pages look like."""


@cache
def _hash_of(*parts: str) -> str:
    """A hash of the bytes of files and folders of the package, 16 hexadecimal digits."""
    digest = hashlib.sha256()
    for part in parts:
        path = PACKAGE / part
        for file in sorted(path.rglob("*.py")) if path.is_dir() else [path]:
            digest.update(f"{file.relative_to(PACKAGE)}\0".encode() + file.read_bytes())
    return digest.hexdigest()[:16]


def physics_hash() -> str:
    """The hash of what decides the numbers of results."""
    return _hash_of(*PHYSICS)


def figures_hash() -> str:
    """The hash of what decides what pictures and pages look like."""
    return _hash_of(*DRAWING)
