"""Files of compiled kernels, with checksums.

Numba's own cache misses changes of a callee in another file and recompiles after every changed comment. It also trusts
its files: a cut file ends in a traceback, a changed byte in wrong numbers.  Here each signature of a kernel has one
file, in a folder named by a hash of the engine's code.  A file that does not fit is replaced by compiling again.
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
import numba

from disc_model.sources import code_hash

SUFFIX = ".kernel"
HELPERS = ".helpers"
"""Suffix of files with the helpers that were first compiled for a kernel, for kernels that are compiled later."""
_DIGEST = hashlib.sha256().digest_size


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


def hash_of(*of: object) -> str:
    """Hash of what compiled code depends on, beside the versions: 16 hexadecimal digits."""
    return hashlib.sha256(repr((*of, versions())).encode()).hexdigest()[:16]


@functools.cache
def stored_helpers(codegen: Any) -> dict[str, bytes]:
    """The helpers that were compiled for earlier kernels."""
    found: dict[str, bytes] = {}
    for path in sorted(folder().glob(f"*.{hash_of(codegen.magic_tuple())}{HELPERS}")):
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
