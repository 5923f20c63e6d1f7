"""The origin of a result: hashes of its sources, the commit, and versions of packages.

A result depends on a part of the package as a whole: batches and cases on the physics, a batch on
the file of its quantity too, a figure on the folder of figures.
"""

import ast
import contextlib
import functools
import hashlib
import importlib.metadata
import json
import os
import platform
import subprocess
import tomllib
from pathlib import Path
from typing import Any

import platformdirs

PACKAGE = Path(__file__).resolve().parent

TABLE = "data/variables.toml"
"""The table of variables, of which only flags, dimensions and types count as a part on its own: what they
are called is attached when results are merged or read."""
TEXTS = ("units", "long_name", "comment", "missing", "shown", "symbols", "parameters", "arguments")
"""Keys of the table that change no number."""
PHYSICS = (
    "analysis",
    "arrays.py",
    "data/columns.py",
    "data/dataset.py",
    "data/files.py",
    "data/tables.py",
    "data/variables.py",
    TABLE,
    "disc",
    "engine",
    "errors.py",
    "hashing.py",
    "modal_disc.py",
    "mode_choice.py",
    "mode_units.py",
    "parameters.py",
    "simulation",
    "stability",
    "units.py",
)
"""Parts on which every simulation depends."""
BATCHES = (
    *PHYSICS,
    "data/frequency_jumps.py",
    "studies/batch.py",
    "studies/distributions.py",
    "studies/quantity.py",
    "studies/refinement.py",
    "studies/run.py",
    "studies/shares_of_starts.py",
)
"""Parts on which every batch depends, beside the file of its quantity."""
MERGING = (
    "data",
    "studies/batch.py",
    "studies/merge.py",
    "studies/point_lists.py",
    "studies/run.py",
)
"""Parts on which merged datasets depend, beside their batches and cases."""
HASH_LENGTH = 64  # hexadecimal digits


@functools.cache
def source_hash(*parts: str | Path) -> str:
    """Return a hash of parts of the package, 16 hexadecimal digits.

    Parts are files and folders, relative to the package; a script is given by its path. Of Python
    files only what they do counts, and not comments, docstrings and layout, and of `TABLE` no words.
    """
    digest = hashlib.sha256()
    for part in parts:
        if part == TABLE:
            digest.update(_structure().encode())
            continue
        for path in _files(PACKAGE / part):
            # a script counts by its bare name, wherever it is installed
            inside = path.is_relative_to(PACKAGE)
            name = path.relative_to(PACKAGE).as_posix() if inside else path.name
            digest.update(f"{name}\0{code_hash(path)}\0".encode())
    return digest.hexdigest()[:16]


def _structure() -> str:
    """The table of variables without what it only says of them, as JSON."""

    def without_texts(table: dict[str, Any]) -> dict[str, Any]:
        kept = {}
        for name, entry in table.items():
            if name not in TEXTS:
                kept[name] = without_texts(entry) if isinstance(entry, dict) else entry
        return kept

    tables = tomllib.loads((PACKAGE / TABLE).read_text(encoding="utf-8"))
    return json.dumps(without_texts(tables), sort_keys=True)


def quantity_file(name: str) -> str:
    """Return the file of a quantity, relative to the package."""
    return f"studies/quantities/{name}.py"


def _files(part: Path) -> list[Path]:
    """Return a file, or all files of a folder, sorted; raises `FileNotFoundError`."""
    if part.is_file():
        return [part]
    files = [path for path in part.rglob("*") if path.is_file() and path.suffix != ".pyc"]
    if not files:
        raise FileNotFoundError(f"{part}: no such part of the package")
    return sorted(files)


@functools.cache
def code_hash(path: Path) -> str:
    """Return a hash of a file; of Python only of what it does, as this version of Python reads
    it."""
    content = path.read_bytes()
    of_content = hashlib.sha256(content).hexdigest()
    if path.suffix != ".py":
        return of_content
    known = _known_hashes()
    if of_content not in known:
        tree = ast.parse(content, str(path))
        _drop_texts(tree)
        known[of_content] = hashlib.sha256(ast.dump(tree).encode()).hexdigest()
        with contextlib.suppress(OSError), _hashes_file().open("a") as file:
            file.write(f"{of_content} {known[of_content]}\n")
    return known[of_content]


@functools.cache
def _known_hashes() -> dict[str, str]:
    """Hashes of what Python files do, by those of their contents, kept from earlier processes: to
    read the whole package takes half a second at each start of the workflow."""
    known = {}
    file = _hashes_file()
    with contextlib.suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        for line in file.read_text().splitlines():
            of_content, _, of_code = line.partition(" ")
            if len(of_content) == len(of_code) == HASH_LENGTH:
                known[of_content] = of_code
    return known


def _hashes_file() -> Path:
    """The file of known hashes, of this version of Python and of these rules for reading it."""
    rules = hashlib.sha256(Path(__file__).read_bytes()).hexdigest()
    return cache_folder() / f"code-{platform.python_version()}-{rules[:16]}.txt"


def _drop_texts(statement: ast.AST) -> None:
    """Drop the statements that are texts, such as docstrings, from all blocks of a statement."""
    for name in ("body", "orelse", "finalbody", "handlers", "cases"):
        block = getattr(statement, name, None)
        if not isinstance(block, list):
            continue
        block[:] = [each for each in block if not _is_text(each)]
        for each in block:
            _drop_texts(each)


def _is_text(statement: ast.AST) -> bool:
    """Whether a statement is nothing but a text."""
    if not isinstance(statement, ast.Expr) or not isinstance(statement.value, ast.Constant):
        return False
    return isinstance(statement.value.value, str)


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
            known[name] = "not installed" if name in further else "unknown"
    return known


@functools.cache
def git_commit(package: Path = PACKAGE) -> str:
    """Commit of the sources, with ``-dirty`` if they were changed since; "unknown" outside their
    repository."""
    # an environment may lie within the repository of another project, which does not list its files
    commands = (
        "ls-files --error-unmatch __init__.py",
        "describe --always --dirty --abbrev=40 --exclude=*",
    )
    try:
        for command in commands:
            done = subprocess.run(
                ["git", *command.split()],
                cwd=package,
                capture_output=True,
                text=True,
                timeout=20,
                check=True,
            )
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return done.stdout.strip()
