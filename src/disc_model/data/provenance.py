"""Provenance of a result: hashes of its sources, versions of packages, and the commit."""

import functools
import hashlib
import importlib.metadata
import platform
import subprocess
from collections.abc import Iterable
from pathlib import Path

from disc_model.bytecode import bytecode_of
from disc_model.data.sources import KINDS, VERSIONS

PACKAGE = Path(__file__).resolve().parents[1]
VERSIONS_OF = ("disc_model", "numpy", "scipy", "numba", "pandas", "xarray", "netCDF4")


@functools.cache
def source_hash(*names: str, files: tuple[Path, ...] = ()) -> str:
    """Hash of the sources of a result, 16 hexadecimal digits.

    Comments, docstrings and layout of Python sources do not count, because they change no result.

    Parameters
    ----------
    names : kinds of results, modules, packages and files, as in `disc_model.data.sources`
    files : further sources, such as a script
    """
    kinds = sorted(_meant(names) & KINDS.keys())
    digest = hashlib.sha256(repr([(kind, VERSIONS.get(kind, 1)) for kind in kinds]).encode())
    own = {path: path.relative_to(PACKAGE).as_posix() for path in source_files(*names)}
    # a script is hashed under its bare name, wherever it is installed
    for path, name in (own | {path: path.name for path in files}).items():
        content = bytecode_of(path) if path.suffix == ".py" else path.read_bytes()
        digest.update(f"{name}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()[:16]


def source_files(*names: str) -> tuple[Path, ...]:
    """The files that names of sources stand for, sorted; a package stands for all files within it."""
    found: set[Path] = set()
    names = tuple(name.removeprefix("disc_model.") for name in names)
    for name in _meant(names) - KINDS.keys():
        path = PACKAGE / (name if "/" in name else name.replace(".", "/"))
        found |= {*path.rglob("*" if "/" in name else "*.py")} if path.is_dir() else {_file(path)}
    return tuple(sorted(path for path in found if path.is_file() and path.suffix != ".pyc"))


def _meant(names: Iterable[str]) -> set[str]:
    """Names, and all that the kinds among them stand for."""
    return {*names}.union(*(_meant(KINDS[name].split()) for name in names if name in KINDS))


def _file(path: Path) -> Path:
    file = path if path.suffix else path.with_suffix(".py")
    if not file.is_file():
        raise FileNotFoundError(f"{file}: no such source")
    return file


def versions(*further: str) -> dict[str, str]:
    """Versions of Python and of the packages on which results depend, and of further packages."""
    found = {"python": platform.python_version()}
    for name in (*VERSIONS_OF, *further):
        try:
            found[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            found[name] = "not installed" if name in further else "unknown"
    return found


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
