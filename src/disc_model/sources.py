"""Names of `disc_model.provenance` for rules of the workflow that still ask for parts."""

import hashlib
from pathlib import Path

from disc_model.provenance import PACKAGE as PACKAGE
from disc_model.provenance import cache_folder as cache_folder
from disc_model.provenance import git_commit as git_commit
from disc_model.provenance import hash_of
from disc_model.provenance import versions as versions
from disc_model.provenance import versions_text as versions_text

PHYSICS = (
    *("analysis", "disc", "engine", "simulation", "stability", "arrays.py", "errors.py"),
    *("modal_disc.py", "mode_choice.py", "mode_measures.py", "mode_units.py", "parameters.py"),
    "units.py",
)
BATCHES = (*PHYSICS, "studies")
MERGING = ("data", "studies")


def source_hash(*parts: str | Path) -> str:
    """The hash of parts of the package, and of scripts by their paths."""
    return hash_of(parts)


def quantity_file(name: str) -> str:
    """The file of a quantity, relative to the package."""
    return f"studies/quantities/{name}.py"


def code_hash(path: Path) -> str:
    """The hash of the bytes of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()
