"""The origin of a result: its sources, the commit, and versions of packages.

The sources are all that its entry points import, at any depth, and the data read beside it.

An entry point is a module or package of `disc_model`, or the script of a job. Quantities and figures, which are loaded
by their names, are entry points of their own. Deferred imports count, imports for type checkers do not. The data of a
module are the files beside it with its own name, and what its texts name: files and folders beside it, and paths from
the package on.
"""

import ast
import contextlib
import functools
import hashlib
import importlib.metadata
import json
import os
import platform
import re
import subprocess
import sys
import zlib
from collections.abc import Iterator
from pathlib import Path

import platformdirs

PACKAGE = Path(__file__).resolve().parent
ASIDE = {
    "mode_choice": "is an entry point, where modes are chosen by the motion",
    "disc.plausibility": "warns",
    "display": "shows to a reader, and progress",
    "simulation.pictures": "draws for a reader",
}
"""Modules that are not followed where they are imported, since they decide no result, with the reason."""


@functools.cache
def source_hash(*entries: str | Path) -> str:
    """Hash of the sources of a result, 16 hexadecimal digits.

    Comments, docstrings and layout of Python sources do not count, because they change no result.

    Parameters
    ----------
    entries : names of modules and packages, with or without ``disc_model.``, and paths of scripts and further files
    """
    digest = hashlib.sha256()
    for path in source_files(*entries):
        # a script is hashed under its bare name, wherever it is installed
        name = path.name if path in entries else path.relative_to(PACKAGE).as_posix()
        digest.update(f"{name}\0{code_hash(path)}\0".encode())
    return digest.hexdigest()[:16]


@functools.cache
def source_files(*entries: str | Path) -> tuple[Path, ...]:
    """The files of entry points and of all that they import, sorted."""
    waiting = {path for entry in entries for path in ([entry] if isinstance(entry, Path) else _modules(entry))}
    aside = {path for name in ASIDE for path in _modules(name)} - waiting
    sources: set[Path] = set()
    while waiting:
        path = waiting.pop()
        sources.add(path)
        if path.suffix == ".py":
            waiting |= {*_imported(path), *_data(path)} - sources - aside
    return tuple(sorted(sources))


def code_hash(path: Path) -> str:
    """Hash of a file; of Python only what it does, as this version of Python reads it."""
    return _read(path)[0] if path.suffix == ".py" else hashlib.sha256(path.read_bytes()).hexdigest()


@functools.cache
def _read(path: Path) -> tuple[str, frozenset[tuple[int, str, str]], frozenset[str]]:
    """What `_parse` finds in a file, which takes 8 ms: kept in a file whose name is the hash of all that decides it."""
    source = path.read_bytes()
    name = hashlib.sha256(b"\0".join((source, sys.version.encode(), _PARSER))).hexdigest()
    cache = cache_folder() / "sources" / name
    try:
        known = json.loads(zlib.decompress(cache.read_bytes()))
    except (OSError, zlib.error):  # also if another process is writing it: the compression contains a checksum
        known = _parse(ast.parse(source, str(path)))
        with contextlib.suppress(OSError):
            cache.parent.mkdir(parents=True, exist_ok=True)
            cache.write_bytes(zlib.compress(json.dumps(known).encode()))
    return known[0], frozenset(map(tuple, known[1])), frozenset(known[2])


_PARSER = Path(__file__).read_bytes()


def cache_folder() -> Path:
    """The folder of what is made once on a machine, kernels too: numba's if it has one, or the user's for caches."""
    return Path(os.environ.get("NUMBA_CACHE_DIR") or platformdirs.user_cache_dir("disc_model"))


def _parse(tree: ast.Module) -> tuple[str, list[tuple[int, str, str]], list[str]]:
    """Hash of a Python source without comments, docstrings and layout; levels, modules and names of its imports; and
    its texts that may name files."""
    imports, constants = set(), {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    texts = [text for text in constants if isinstance(text, str) and re.fullmatch(r"\w[\w./-]*", text)]
    for node in [tree, *_statements(tree)]:
        if isinstance(node, ast.Import):
            imports |= {(0, alias.name, "") for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            imports |= {(node.level, node.module or "", alias.name) for alias in node.names}
        for name in _BLOCKS:
            if block := getattr(node, name, None):
                setattr(node, name, [child for child in block if not _is_text(child)])
    return hashlib.sha256(ast.dump(tree).encode()).hexdigest(), sorted(imports), sorted(texts)


_BLOCKS = ("body", "orelse", "finalbody", "handlers", "cases")


def _statements(node: ast.AST) -> Iterator[ast.AST]:
    """All statements within a node, but for those that only type checkers read."""
    typing = isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
    for name in _BLOCKS[typing:]:
        for child in getattr(node, name, ()):
            yield child
            yield from _statements(child)


def _is_text(node: ast.AST) -> bool:
    """Whether a statement is a docstring, or another text that does nothing."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _modules(name: str) -> list[Path]:
    """The file of a module, or all those of a package; raises ModuleNotFoundError."""
    path = PACKAGE.joinpath(*name.removeprefix("disc_model.").split("."))
    if paths := [*path.rglob("*.py")] if path.is_dir() else [*path.parent.glob(f"{path.name}.py")]:
        return paths
    raise ModuleNotFoundError(f"No module named 'disc_model.{name}'", name=name)


@functools.cache
def _imported(path: Path) -> frozenset[Path]:
    """Files of the package's modules that a file imports."""
    files: set[Path] = set()
    for level, module, name in _read(path)[1]:
        if level:
            parts = path.relative_to(PACKAGE).parent.parts
            module = ".".join(filter(None, ["disc_model", *parts[: len(parts) + 1 - level], module]))
        files.update(_file(module, name))
    return frozenset(files)


def _file(module: str, name: str) -> Iterator[Path]:
    """The file from which a name is imported, if it lies in the package."""
    top, *parts = module.split(".")
    if top == "disc_model":
        path = PACKAGE.joinpath(*parts)
        choices = (path / f"{name}.py", path / name / "__init__.py", path.with_suffix(".py"), path / "__init__.py")
        file = next(choice for choice in choices if choice.is_file())
        if file.parent == PACKAGE and file.stem == "__init__":
            raise ImportError(f"{name or module}: must be imported from its own module, so that its sources are known")
        yield file


@functools.cache
def _data(path: Path) -> frozenset[Path]:
    """Files of data that a module reads."""
    named = {(PACKAGE if "/" in text else path.parent) / text for text in _read(path)[2]}
    files = {*named, *path.parent.glob(f"{path.stem}.*")}
    files |= {file for folder in named if folder.is_dir() and not [*folder.rglob("*.py")] for file in folder.iterdir()}
    return frozenset(file for file in files if file.is_file() and file.suffix not in (".py", ".pyc"))


# ---- Commit and versions

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
