"""Where a result comes from: which sources, versions and commit produced it, and which Snakemake has no record of.

A source hash covers a module or a script and everything of this package that it imports, found by reading the
sources, so that no list has to be kept by hand: a module that `disc_model.simulation.api` begins to use is in it from
then on. Of Python sources the code counts, and not comments, docstrings and layout, which change no result.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import importlib.metadata
import json
import os
import platform
import subprocess
from base64 import urlsafe_b64encode
from collections.abc import Iterable
from importlib.util import resolve_name
from pathlib import Path
from typing import Any, NamedTuple

PACKAGE = Path(__file__).resolve().parents[1]
VERSIONS_OF = ("disc_model", "numpy", "scipy", "numba", "pandas", "xarray", "netCDF4")


def source_hash(*roots: str | Path, files: Iterable[str | Path] = ()) -> str:
    """First 16 hexadecimal digits of a sha256 over sources.

    Parameters
    ----------
    roots : modules of this package by name, scripts by path; what they import from the package is included
    files : further files that matter, such as a style; hashed by name and content
    """
    digest = hashlib.sha256()
    for path in source_files(*roots):
        inside = path.is_relative_to(PACKAGE) and path not in roots  # a script is named alike, installed or not
        name = path.relative_to(PACKAGE).as_posix() if inside else path.name
        _add(digest, name, _read(path.read_bytes()).code.encode())
    for path in sorted(Path(file) for file in files):
        _add(digest, path.name, path.read_bytes())
    return digest.hexdigest()[:16]


def source_files(*roots: str | Path) -> tuple[Path, ...]:
    """Source files of modules and scripts, and of everything of this package they import, at any depth, sorted.

    What is imported for type checkers only is left out, since it is not run; and so is the package's own ``__init__``:
    it only names what is imported on first use, and neither modules inside the package nor scripts use those names.
    """
    found = {root.stem: root for root in roots if isinstance(root, Path)}
    waiting = [str(root) for root in roots if not isinstance(root, Path)]
    for name, script in found.items():
        waiting += _imported(script, name)
    while waiting:
        name = waiting.pop()
        path = _module_path(name)
        if path is None or name in found or name == PACKAGE.name:
            continue
        found[name] = path
        waiting += [*_imported(path, name), name.rpartition(".")[0]]
    return tuple(sorted(set(found.values())))


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


def _add(digest: hashlib._Hash, name: str, content: bytes) -> None:
    digest.update(f"{name}\0{len(content)}\0".encode())
    digest.update(content)


def _module_path(name: str) -> Path | None:
    """File of a module of this package, None for anything else."""
    first, *rest = name.split(".")
    path = PACKAGE.joinpath(*rest)
    file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return file if first == PACKAGE.name and file.is_file() else None


def _imported(path: Path, name: str) -> list[str]:
    """Names a source file imports; ``from x import y`` gives x and x.y, since y may be a module."""
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    names = []
    for module, imported in _read(path.read_bytes()).imports:
        base = resolve_name(module, package)
        names += [base, *(f"{base}.{name}" for name in imported)]
    return names


class _Source(NamedTuple):
    """What there is to know of a source file: its code as text, and imports as module and names."""

    code: str
    imports: list[tuple[str, list[str]]]


@functools.cache
def _read(source: bytes) -> _Source:
    imports: list[tuple[str, list[str]]] = []
    return _Source(_text(ast.parse(source), imports), imports)


def _text(node: ast.AST, imports: list[tuple[str, list[str]]]) -> str:
    """A syntax tree as text, without docstrings and what is there for type checkers; adds what it imports to a list.

    The same in all versions of Python, unlike that of `ast.dump`: what is empty is left out.
    """
    match node:
        case ast.Expr(value=ast.Constant(value=str())):
            return ""
        case ast.If(test=ast.Name(id="TYPE_CHECKING")):
            return ",".join(_text(statement, imports) for statement in node.orelse)
        case ast.Import():
            imports += [(alias.name, []) for alias in node.names]
        case ast.ImportFrom():
            imports.append(("." * node.level + (node.module or ""), [alias.name for alias in node.names]))
    said = [type(node).__name__]
    for name in node._fields:
        value = getattr(node, name, None)
        if isinstance(value, list):
            items = [_text(item, imports) if isinstance(item, ast.AST) else repr(item) for item in value]
            if items := [item for item in items if item]:
                said.append(f"{name}=[{','.join(items)}]")
        elif isinstance(value, ast.AST):
            said.append(f"{name}={_text(value, imports)}")
        elif value is not None:
            said.append(f"{name}={value!r}")
    return f"({' '.join(said)})"


# ----------------------------------------------------------------------------------------------------
# Which results Snakemake has no record of

_EXAMPLE = "results/paper/cases/F02.nc"


def unrecorded(files: Iterable[str]) -> list[str]:
    """Those of the files that are there without a readable record.

    What an interrupted run left unfinished is not among them: Snakemake knows of it.
    """
    return [
        file
        for file in files
        if Path(file).exists()
        and not _readable(Path(".snakemake/metadata", _record(file)))
        and not Path(".snakemake/incomplete", _record(file)).exists()
    ]


def why_unknown(workflow: Any) -> str:
    """What of Snakemake is not as `unrecorded` takes it to be, of the running ``workflow``; "" if all is."""
    try:
        from snakemake.persistence.file import FilePersistence
        from snakemake.settings.enums import PersistenceBackend

        if workflow.workflow_settings.persistence_backend != PersistenceBackend.FILE:
            return "they are in a database"
        store = FilePersistence.__new__(FilePersistence)  # which makes no folders
        store._max_len = 255
        place = store._record_path("metadata", _EXAMPLE)
    except (ImportError, AttributeError, TypeError) as error:
        return str(error)
    return "" if place == os.path.join("metadata", _record(_EXAMPLE)) else f"one is called {place}"


def _record(file: str) -> str:
    return urlsafe_b64encode(file.encode()).decode()


def _readable(record: Path) -> bool:
    try:
        json.loads(record.read_bytes())
    except (OSError, ValueError):
        return False
    return True
