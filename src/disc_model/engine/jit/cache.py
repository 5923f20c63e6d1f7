"""Files of compiled kernels, and the lock by which processes compile each kernel once.

The files are those of numba's own cache, but in a folder named by a hash of the engine's code:
numba does not notice that a function in another file has changed, and would compile again after
every changed comment.
"""

import functools
import hashlib
import sys
import warnings
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

from filelock import FileLock
from numba.core import event
from numba.core.caching import CompileResultCacheImpl, FunctionCache, _CacheLocator

from disc_model.provenance import cache_folder, code_hash


@functools.cache
def folder() -> Path:
    """Return the folder of the kernels of this engine, named by a hash of its code without
    comments, docstrings and lines."""
    digest = hashlib.sha256()
    engine = Path(__file__).parents[1]
    for path in sorted(engine.rglob("*.py")):
        digest.update(f"{path.relative_to(engine)}\0{code_hash(path)}\0".encode())
    return cache_folder() / f"engine-{digest.hexdigest()[:16]}"


class _EngineFolder(_CacheLocator):
    """Where numba keeps the files of a kernel: what decides about them is in the folder's name."""

    def get_cache_path(self) -> str:
        return str(folder())

    def get_source_stamp(self) -> str:
        return folder().name

    def get_disambiguator(self) -> str:
        return "kernel"

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> "_EngineFolder":
        return cls()


class _KernelFiles(CompileResultCacheImpl):
    _locator_classes: list[type[object]] = [_EngineFolder]  # noqa: RUF012 - as numba declares it


class KernelCache(FunctionCache):
    """numba's cache of a kernel, without which everything works, but compiles in every process."""

    _impl_class = _KernelFiles

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return a kernel from its file, or None if there is none, or only a damaged one, which is
        then forgotten."""
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # whatever a damaged file makes pickle raise
            with suppress(OSError):
                self.flush()
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Save a kernel if possible: a full or read-only disk costs time, not the result."""
        try:
            # numba reads the index and writes it again: two processes would give one file two kernels
            with lock("index"):
                super().save_overload(sig, data)
        except OSError as error:
            reason = f"compiled kernels cannot be kept there ({error.strerror})"
            text = f"{folder()}: {reason}; every process compiles them again"
            warnings.warn(text, RuntimeWarning, stacklevel=2)


@contextmanager
def lock(name: str, signature: Any = "") -> Iterator[None]:
    """Let other processes wait that come to the lock of the same kernel for the same types, where
    files can be locked."""
    types = hashlib.sha256(str(signature).encode()).hexdigest()[:12]
    with ExitStack() as stack:
        with suppress(OSError, NotImplementedError):
            folder().mkdir(parents=True, exist_ok=True)
            stack.enter_context(FileLock(folder() / f"{name}-{types}.lock"))
        yield


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
