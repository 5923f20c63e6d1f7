"""Files of compiled kernels, with checksums, and locks by which processes compile each kernel once.

Numba's own cache misses changes of a callee in another file, recompiles after every changed
comment, and trusts damaged files.  Here each signature of a kernel has one file, in a folder named
by a hash of the engine's code; a damaged one is replaced by compiling again.
"""

import functools
import hashlib
import pickle
import sys
import uuid
import zlib
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

import llvmlite
import numba
from numba.core import event, serialize

from disc_model.sources import cache_folder, code_hash


@functools.cache
def folder() -> Path:
    """The folder of the kernels of this engine, named by a hash of its code without comments,
    docstrings and lines."""
    digest, engine = hashlib.sha256(), Path(__file__).parents[1]
    for path in sorted(engine.rglob("*.py")):
        digest.update(f"{path.relative_to(engine)}\0{code_hash(path)}\0".encode())
    return cache_folder() / f"engine-{digest.hexdigest()[:16]}"


def hash_of(*of: object) -> str:
    """Hash of what compiled code depends on but for the engine, with the versions of all that makes
    it."""
    python = f"{sys.implementation.name} {sys.version_info[0]}.{sys.version_info[1]} {sys.platform}"
    versions = f"numba {numba.__version__}, llvmlite {llvmlite.__version__}, {python}"
    return hashlib.sha256(repr((*of, versions)).encode()).hexdigest()[:16]


class _Listener(event.Listener):
    """Says once in a process that kernels are compiled."""

    said = False

    def on_start(self, event: Any) -> None:
        if not self.said:
            print("compiling kernels, once: 10 to 20 s for each kind", file=sys.stderr, flush=True)
            self.said = True

    def on_end(self, event: Any) -> None:
        pass


LISTENER = _Listener()


@contextmanager
def compiling() -> Iterator[None]:
    """Say so if the block compiles kernels; also usable as a decorator."""
    with event.install_listener("numba:compile", LISTENER):
        yield


@contextmanager
def lock(name: str) -> Iterator[None]:
    """Let other processes wait that come to a lock of the same name, where files can be locked."""
    with ExitStack() as stack:
        with suppress(ImportError, OSError):
            import fcntl

            folder().mkdir(parents=True, exist_ok=True)
            # never deleted: a process may wait for this file while the next one makes another
            file = stack.enter_context((folder() / f"{name}.lock").open("a"))
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


def write(path: Path, contents: object) -> None:
    """Write a file atomically; its compression contains a checksum."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{uuid.uuid4().hex}.tmp")
    try:
        temporary.write_bytes(zlib.compress(serialize.dumps(contents)))
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def read(path: Path) -> Any:
    """The contents of a file, or None if it is missing or damaged."""
    try:
        return pickle.loads(zlib.decompress(path.read_bytes()))
    except (OSError, zlib.error):
        return None
