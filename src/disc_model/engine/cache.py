"""Files of compiled kernels, with checksums.

Numba's own cache misses changes of a callee in another file and recompiles after every changed comment. It also trusts
its files: a cut file ends in a traceback, a changed byte in wrong numbers.  Here each signature of a kernel has one
file, in a folder named by a hash of the engine's code.  A file that does not fit is replaced by compiling again.

A package may ship kernels compiled for a level of x86-64 processors (`SHIPPED`).
"""

import functools
import hashlib
import os
import pickle
import sys
import uuid
import warnings
import zlib
from pathlib import Path
from typing import Any

import llvmlite
import llvmlite.binding as llvm
import numba

from disc_model.sources import code_hash

SHIPPED = Path(__file__).parent / "kernels"
"""Kernels shipped with the package, a folder for each level; its file `VERSIONS` states what compiled them."""
VERSIONS = "versions.txt"
LEVELS = {
    "x86-64-v4": ("-prefer-256-bit", ("avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl")),
    "x86-64-v3": ("", ("avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe")),
}
"""Levels, the highest first: ``NUMBA_CPU_FEATURES`` to compile for it, beside its name as ``NUMBA_CPU_NAME``, and the
features that a processor needs."""
SUFFIX = ".kernel"
HELPERS = ".helpers"
"""Suffix of files with the helpers that were first compiled for a kernel, for kernels that are compiled later."""
_DIGEST = hashlib.sha256().digest_size
_SETTINGS: Any = numba.config


@functools.cache
def source_hash(folder: Path = Path(__file__).parent) -> str:
    """Hash of the engine's code without comments, docstrings and line numbers: 16 hexadecimal digits."""
    digest = hashlib.sha256()
    for path in sorted(folder.glob("*.py")):
        digest.update(f"{path.name}\0{code_hash(path)}\0".encode())
    return digest.hexdigest()[:16]


@functools.cache
def folder() -> Path:
    """The folder of the compiled kernels."""
    from platformdirs import user_cache_dir

    return Path(os.environ.get("NUMBA_CACHE_DIR") or user_cache_dir("disc_model")) / f"engine-{source_hash()}"


def versions() -> str:
    """Versions on which compiled kernels depend, as text."""
    python = f"{sys.implementation.name} {sys.version_info[0]}.{sys.version_info[1]} {sys.platform}"
    return f"engine {source_hash()}, numba {numba.__version__}, llvmlite {llvmlite.__version__}, {python}"


@functools.cache
def shipped_level() -> str | None:
    """The highest level of this processor with shipped kernels, if they fit the installed versions."""
    if not SHIPPED.is_dir():
        return None
    here, chosen = llvm.get_host_cpu_features(), (_SETTINGS.CPU_NAME, _SETTINGS.CPU_FEATURES)
    for level, (settings, features) in LEVELS.items():
        if all(here.get(name, False) for name in features) and chosen in ((None, None), (level, settings)):
            break
    else:
        warn_once(f"{SHIPPED}: no kernels came with the package for this processor; they are compiled")
        return None
    try:
        compiled_with = (SHIPPED / level / VERSIONS).read_text(encoding="utf-8", errors="replace")
    except OSError:
        compiled_with = "unknown versions"
    if compiled_with != versions():
        warn_once(f"{SHIPPED / level}: these kernels are of {compiled_with}, here is {versions()}; they are compiled")
        return None
    return level


def processor(codegen: Any) -> object:
    """The processor on which machine code depends: a level that is chosen for numba, or all known properties."""
    chosen = _SETTINGS.CPU_NAME, _SETTINGS.CPU_FEATURES
    levels = [level for level, (settings, _) in LEVELS.items() if chosen == (level, settings)]
    return levels[0] if levels else codegen.magic_tuple()


def hash_of(*of: object) -> str:
    """Hash of what compiled code depends on, beside the versions: 16 hexadecimal digits."""
    return hashlib.sha256(repr((*of, versions())).encode()).hexdigest()[:16]


@functools.cache
def stored_helpers(codegen: Any) -> dict[str, bytes]:
    """The helpers that were compiled for earlier kernels."""
    found: dict[str, bytes] = {}
    for path in sorted(folder().glob(f"*.{hash_of(processor(codegen))}{HELPERS}")):
        found |= read(path) or {}
    return found


def write(path: Path, contents: object) -> None:
    """Write a file atomically, with its checksum in front."""
    from numba.core.serialize import dumps

    body = zlib.compress(dumps((path.name, contents)))
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{uuid.uuid4().hex}.tmp")
    try:
        temporary.write_bytes(hashlib.sha256(body).digest() + body)
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def read(path: Path) -> Any:
    """The contents of a file, or None if it is missing, damaged, or of another version."""
    try:
        whole = path.read_bytes()
    except OSError:
        return None
    digest, body = whole[:_DIGEST], whole[_DIGEST:]
    if hashlib.sha256(body).digest() != digest:
        return None
    name, contents = pickle.loads(zlib.decompress(body))
    return contents if name == path.name else None


@functools.cache
def warn_once(what: str) -> None:
    """Warn once for each message."""
    warnings.warn(what, RuntimeWarning, stacklevel=3)
