"""The origin of a result: its sources, the commit, and versions of packages.

The sources are all that its entry points import, at any depth, and the data read beside it. An
entry point is a module or package of `disc_model`, or the script of a job. Quantities and figures,
which are loaded by their names, are entry points of their own. Deferred imports count, imports for
type checkers do not. The data of a module are the files beside it with its own name, and what its
texts name: files and folders beside it, and paths from the package on.
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
from importlib.util import resolve_name
from pathlib import Path

import platformdirs

PACKAGE = Path(__file__).resolve().parent
ASIDE = {  # modules that are not followed where they are imported, since they decide no result, with the reason
    "mode_choice": "is an entry point, where modes are chosen by the motion",
    "disc.plausibility": "warns",
    "studies.costs": "estimates",
    "display": "shows to a reader",
}


@functools.cache
def source_hash(*entries: str | Path) -> str:
    """Hash of the sources of a result without comments, docstrings and layout, 16 hexadecimal
    digits. Entries are names of modules and packages, with or without ``disc_model.``, and paths of
    scripts and further files."""
    digest = hashlib.sha256()
    for path in source_files(*entries):
        # a script is hashed under its bare name, wherever it is installed
        name = path.name if path in entries else path.relative_to(PACKAGE).as_posix()
        digest.update(f"{name}\0{code_hash(path)}\0".encode())
    return digest.hexdigest()[:16]


@functools.cache
def source_files(*entries: str | Path) -> tuple[Path, ...]:
    """The files of entry points and of all that they import, sorted."""
    waiting = {
        path
        for entry in entries
        for path in ([entry] if isinstance(entry, Path) else _modules(entry))
    }
    aside = {path for name in ASIDE for path in _modules(name)} - waiting
    sources: set[Path] = set()
    while waiting:
        path = waiting.pop()
        sources.add(path)
        if path.suffix == ".py":
            waiting |= _used(path) - sources - aside
    return tuple(sorted(sources))


def _modules(name: str) -> list[Path]:
    """The file of a module, or all those of a package."""
    path = PACKAGE.joinpath(*name.removeprefix("disc_model.").split("."))
    if paths := [*path.rglob("*.py"), *path.parent.glob(f"{path.name}.py")]:
        return paths
    raise ModuleNotFoundError(f"No module named 'disc_model.{name}'", name=name)


@functools.cache
def _used(path: Path) -> frozenset[Path]:
    """Files of the package that a module imports, and those of data that it reads."""
    _, imports, texts = _read(path)
    modules: set[Path] = set()
    for module, name in imports:
        if module.startswith("."):
            module = resolve_name(
                module, ".".join(["disc_model", *path.relative_to(PACKAGE).parent.parts])
            )
        top, *parts = module.split(".")
        if top == "disc_model":
            base = PACKAGE.joinpath(*parts)
            choices = (
                base / f"{name}.py",
                base / name / "__init__.py",
                base.with_suffix(".py"),
                base / "__init__.py",
            )
            modules.add(next(choice for choice in choices if choice.is_file()))
            if PACKAGE / "__init__.py" in modules:
                rule = "must be imported from its own module, so that its sources are known"
                raise ImportError(f"{name or module}: {rule}")
    named = {(PACKAGE if "/" in text else path.parent) / text for text in texts}
    data = {*named, *path.parent.glob(f"{path.stem}.*")}
    data |= {
        file
        for folder in named
        if folder.is_dir() and not [*folder.rglob("*.py")]
        for file in folder.iterdir()
    }
    return frozenset(
        modules | {file for file in data if file.is_file() and file.suffix not in (".py", ".pyc")}
    )


def code_hash(path: Path) -> str:
    """Hash of a file; of Python only what it does, as this version of Python reads it."""
    return _read(path)[0] if path.suffix == ".py" else hashlib.sha256(path.read_bytes()).hexdigest()


@functools.cache
def _read(path: Path) -> tuple[str, list[tuple[str, str]], list[str]]:
    """What `_parse` finds in a file, which takes 8 ms: kept in a file whose name is the hash of all
    that decides it."""
    source = path.read_bytes()
    name = hashlib.sha256(b"\0".join((source, sys.version.encode(), _PARSER))).hexdigest()
    cache = cache_folder() / "sources" / name
    try:
        return json.loads(cache.read_text(encoding="utf-8"))
    except (
        OSError,
        ValueError,
    ):  # also if another process is writing it: only the whole text is JSON
        known = _parse(ast.parse(source, str(path)))
        with contextlib.suppress(OSError):
            cache.parent.mkdir(parents=True, exist_ok=True)
            cache.write_text(json.dumps(known), encoding="utf-8")
        return known


_PARSER = Path(__file__).read_bytes()


def cache_folder() -> Path:
    """The folder of what is made once on a machine, kernels too: numba's if it has one, or the
    user's for caches."""
    return Path(os.environ.get("NUMBA_CACHE_DIR") or platformdirs.user_cache_dir("disc_model"))


class _WithoutDocstrings(ast.NodeTransformer):
    def visit_Expr(self, node: ast.Expr) -> ast.Expr | None:
        return (
            None
            if isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
            else node
        )


def _parse(tree: ast.Module) -> tuple[str, list[tuple[str, str]], list[str]]:
    """Hash of a Python source without comments, docstrings and layout; its imports, each as ``from
    ..module import name`` has it; and its texts that may name files."""
    code = ast.dump(_WithoutDocstrings().visit(tree))
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            node.body = []
    imports, texts = set(), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            imports |= {(alias.name, "") for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            imports |= {
                ("." * node.level + (node.module or ""), alias.name) for alias in node.names
            }
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            texts.add(node.value)
    files = [text for text in texts if re.fullmatch(r"\w[\w./-]*", text)]
    return hashlib.sha256(code.encode()).hexdigest(), sorted(imports), sorted(files)


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
