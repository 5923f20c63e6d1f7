"""Where a result comes from: which sources, versions and commit produced it.

A source hash covers a module and everything of this package that it imports, found by reading the sources, so
that no list has to be kept by hand: a module that `disc_model.simulation.api` begins to use is in it from then on.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import importlib.metadata
import platform
import subprocess
from collections.abc import Iterable
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
SIMULATION = ("disc_model.simulation.api", "disc_model.data.dataset", "disc_model.studies.cases.run")
"""What decides the bytes of a case's file: the solver, how its result is encoded, and what calls both."""
VERSIONS_OF = ("disc_model", "numpy", "scipy", "numba", "pandas", "xarray", "netCDF4")


def source_hash(*modules: str, files: Iterable[str | Path] = ()) -> str:
    """First 16 hexadecimal digits of a sha256 over sources.

    Parameters
    ----------
    modules : names of modules of this package; what they import from it is included
    files : further files that matter, such as a script or a style; hashed by name and content
    """
    digest = hashlib.sha256()
    for path in source_files(*modules):
        _add(digest, path.relative_to(PACKAGE).as_posix(), path)
    for path in sorted(Path(file) for file in files):
        _add(digest, path.name, path)
    return digest.hexdigest()[:16]


def source_files(*modules: str) -> tuple[Path, ...]:
    """Source files of modules and of everything of this package they import, at any depth, sorted.

    The package's own ``__init__`` is left out: it only names what is imported on first use, and modules inside
    the package do not use those names.
    """
    found: dict[str, Path] = {}
    waiting = list(modules)
    while waiting:
        name = waiting.pop()
        path = _module_path(name)
        if path is None or name in found or name == PACKAGE.name:
            continue
        found[name] = path
        waiting += _imported(path, name)
        waiting.append(name.rpartition(".")[0])
    return tuple(sorted(found.values()))


def versions() -> dict[str, str]:
    """Versions of Python and of the packages that numbers depend on."""
    found = {"python": platform.python_version()}
    for name in VERSIONS_OF:
        try:
            found[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            found[name] = "unknown"
    return found


@functools.lru_cache(maxsize=1)
def git_commit() -> str:
    """Commit of the sources, with ``-dirty`` if they were changed since; "unknown" outside their repository."""
    try:
        # an environment may lie in the repository of something else
        _git("ls-files", "--error-unmatch", "__init__.py")
        return _git("describe", "--always", "--dirty", "--abbrev=40", "--exclude=*")
    except (OSError, subprocess.SubprocessError):
        return "unknown"


def _git(*arguments: str) -> str:
    done = subprocess.run(["git", *arguments], cwd=PACKAGE, capture_output=True, text=True, timeout=20, check=True)
    return done.stdout.strip()


def _add(digest: hashlib._Hash, name: str, path: Path) -> None:
    content = path.read_bytes()
    digest.update(f"{name}\0{len(content)}\0".encode())
    digest.update(content)


def _module_path(name: str) -> Path | None:
    """File of a module of this package, None for anything else."""
    first, *rest = name.split(".")
    if first != PACKAGE.name:
        return None
    path = PACKAGE.joinpath(*rest)
    if path.is_dir():
        init = path / "__init__.py"
        return init if init.is_file() else None
    module = path.with_suffix(".py")
    return module if module.is_file() else None


def _imported(path: Path, name: str) -> tuple[str, ...]:
    """Names a source file imports; ``from x import y`` gives x and x.y, since y may be a module."""
    return _names_in(path.read_bytes(), path.name, name)


@functools.cache
def _names_in(source: bytes, file: str, name: str) -> tuple[str, ...]:
    package = name if file == "__init__.py" else name.rpartition(".")[0]
    names: list[str] = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            parts = package.split(".")
            base = ".".join([*parts[: len(parts) - node.level + 1], *([node.module] if node.module else [])])
            module = base if node.level else (node.module or "")
            names += [module, *(f"{module}.{alias.name}" for alias in node.names)]
    return tuple(names)
