"""Files of compiled kernels, with checksums.

Numba's own cache misses changes of a callee in another file and recompiles after every changed comment. It also trusts
its files: a cut file ends in a traceback, a changed byte in wrong numbers.  Here each signature of a kernel has one
file, in a folder named by a hash of the engine's code.  A file that does not fit is replaced by compiling again.

A package may ship kernels compiled for a level of x86-64 processors (`SHIPPED`).

The module uses internals of numba that may change: if one is missing, numba's own cache files are used.
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

from disc_model.bytecode import bytecode_of

SHIPPED = Path(__file__).parent / "kernels"
"""Kernels shipped with the package, a folder for each level; its file `VERSIONS` states what compiled them."""
VERSIONS = "versions.txt"
LEVELS = {
    "x86-64-v4": ("avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"),
    "x86-64-v3": ("avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"),
}
"""Processor features that a level needs, the highest level first."""
TARGETS = {"x86-64-v4": ("x86-64-v4", "-prefer-256-bit"), "x86-64-v3": ("x86-64-v3", "")}
"""Settings of numba for kernels of a level: ``NUMBA_CPU_NAME`` and ``NUMBA_CPU_FEATURES``."""

# Errors raised by a part of numba that is missing or has changed.
MISSING = (ImportError, AttributeError, TypeError)
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
        digest.update(f"{path.name}\0".encode() + bytecode_of(path))
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
    here = llvm.get_host_cpu_features()
    levels = [level for level, features in LEVELS.items() if all(here.get(name, False) for name in features)]
    if chosen_target() != (None, None):
        levels = [level for level in levels if TARGETS[level] == chosen_target()]
    if not levels:
        warn_once(f"{SHIPPED}: no kernels came with the package for this processor; they are compiled")
        return None
    try:
        compiled_with = (SHIPPED / levels[0] / VERSIONS).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        compiled_with = "unknown versions"
    if compiled_with != versions():
        warn_once(
            f"{SHIPPED / levels[0]}: these kernels are of {compiled_with}, here is {versions()}; they are compiled"
        )
        return None
    return levels[0]


def chosen_target() -> tuple[str | None, str | None]:
    """The processor and features chosen for numba, if any."""
    return _SETTINGS.CPU_NAME, _SETTINGS.CPU_FEATURES


def _processor(codegen: Any) -> object:
    """The processor on which machine code depends: a chosen level, or all known properties."""
    levels = [level for level, target in TARGETS.items() if target == chosen_target()]
    return levels[0] if levels else codegen.magic_tuple()


class KernelCache:
    """The files of one kernel; numba's dispatcher requests signatures and offers compiled ones."""

    def __init__(self, name: str) -> None:
        self._name = name

    @property
    def cache_path(self) -> str:
        """The folder of the files."""
        return str(folder())

    def load_overload(self, signature: Any, target: Any) -> Any:
        """The code compiled for a signature, or None if it is missing or damaged."""
        from numba.core.compiler import CompileResult

        place = folder() / self._file(signature, _processor(target.codegen()))
        found = read(place)
        level = shipped_level() if found is None else None
        if level:
            place = SHIPPED / level / self._file(signature, level)
            found = read(place)
            if found is None and place.exists():
                warn_once(f"{place}: is damaged; it is compiled, once")
        return None if found is None else CompileResult._rebuild(target, *found)

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Save compiled code if possible: a full or read-only disk costs time, not the result."""
        processor = _processor(compiled.codegen)
        path = folder() / self._file(signature, processor)
        helpers = compiled.library.new_helpers() if hasattr(compiled.library, "new_helpers") else {}
        try:
            write(path, compiled._reduce())
            if helpers:
                write(path.with_suffix(f".{_hash(processor)}{HELPERS}"), helpers)
        except OSError as error:
            warn_once(
                f"{path.parent}: compiled kernels cannot be kept there ({error.strerror}); "
                "every process compiles them again"
            )

    def _file(self, signature: Any, processor: object) -> str:
        return f"{self._name}.{_hash(signature, processor)}{SUFFIX}"


def _hash(*of: object) -> str:
    return hashlib.sha256(repr((*of, versions())).encode()).hexdigest()[:16]


@functools.cache
def stored_helpers(codegen: Any) -> dict[str, bytes]:
    """The helpers that were compiled for earlier kernels."""
    found: dict[str, bytes] = {}
    for path in sorted(folder().glob(f"*.{_hash(_processor(codegen))}{HELPERS}")):
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


def keep(kernel: Any) -> None:
    """Store the compiled code of a kernel in files."""
    function = kernel.py_func
    try:
        from numba.core import compiler, serialize

        parts: tuple[Any, ...] = kernel._cache.load_overload, kernel._cache.save_overload, serialize.dumps
        parts += compiler.CompileResult._reduce, compiler.CompileResult._rebuild
        kernel._cache = KernelCache(f"{function.__module__.rsplit('.')[-1]}.{function.__qualname__}")
    except MISSING as error:
        warn_once(f"numba {numba.__version__} keeps compiled kernels in another way than expected ({error})")
        before, _SETTINGS.CACHE_DIR = _SETTINGS.CACHE_DIR, str(folder())
        try:
            kernel.enable_caching()
        finally:
            _SETTINGS.CACHE_DIR = before


@functools.cache
def warn_once(what: str) -> None:
    """Warn once for each message."""
    warnings.warn(what, RuntimeWarning, stacklevel=3)
