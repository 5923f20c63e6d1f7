"""Files of compiled kernels, with checksums.

Numba's own cache does not notice that a callee in another file has changed, trusts what it finds (a cut file ends in a
traceback, a changed byte in wrong numbers), and compiles again after every changed comment.  Here each signature of a
kernel has one file, in a folder that is named by a hash of the engine's code.  What does not fit is compiled anew.

A package may bring kernels that were compiled for a level of x86-64 processors (`SHIPPED`).

This stands on parts of numba that it may change: where one is missing, numba's own files are used.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import os
import pickle
import sys
import types
import uuid
import warnings
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import llvmlite
import llvmlite.binding as llvm
import numba

SHIPPED = Path(__file__).parent / "kernels"
"""Kernels that come with the package, a folder for each level; `VERSIONS` in it says what they were compiled with."""
VERSIONS = "versions.txt"
LEVELS = {
    "x86-64-v4": ("avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"),
    "x86-64-v3": ("avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"),
}
"""What a processor must have for a level, the highest first."""

# What a part of numba that is not there, or not as expected, ends in.
MISSING = (ImportError, AttributeError, TypeError)
SUFFIX = ".kernel"
_DIGEST = hashlib.sha256().digest_size
_SETTINGS: Any = numba.config


@functools.cache
def source_hash(folder: Path = Path(__file__).parent) -> str:
    """Hash of the engine's code without comments, docstrings and line numbers: 16 hexadecimal digits."""
    digest = hashlib.sha256()
    for path in sorted(folder.glob("*.py")):
        code = compile(path.read_bytes(), path.name, "exec", optimize=2, dont_inherit=True)
        digest.update(repr((path.name, *_contents(code))).encode())
    return digest.hexdigest()[:16]


def _contents(code: types.CodeType) -> Iterator[object]:
    yield code.co_name, code.co_code, code.co_names, code.co_varnames, code.co_argcount, code.co_flags
    for constant in code.co_consts:
        yield tuple(_contents(constant)) if isinstance(constant, types.CodeType) else repr(constant)


@functools.cache
def folder() -> Path:
    """Where kernels are kept."""
    from platformdirs import user_cache_dir

    return Path(os.environ.get("NUMBA_CACHE_DIR") or user_cache_dir("disc_model")) / f"engine-{source_hash()}"


def versions() -> str:
    """What kernels can be read by."""
    python = f"{sys.implementation.name} {sys.version_info[0]}.{sys.version_info[1]} {sys.platform}"
    return f"engine {source_hash()}, numba {numba.__version__}, llvmlite {llvmlite.__version__}, {python}"


@functools.cache
def shipped_level() -> str | None:
    """The highest level of this processor of which kernels came with the package, if they fit the versions here."""
    if not SHIPPED.is_dir() or _SETTINGS.CPU_NAME or _SETTINGS.CPU_FEATURES is not None:
        return None
    here = llvm.get_host_cpu_features()
    for level in (level for level, features in LEVELS.items() if all(here.get(name, False) for name in features)):
        with contextlib.suppress(OSError):
            compiled_with = (SHIPPED / level / VERSIONS).read_text()
            if compiled_with == versions():
                return level
            warn_once(f"{SHIPPED / level}: kernels of {compiled_with} are not used here ({versions()})")
            return None
    return None


class KernelCache:
    """The files of one kernel; numba's dispatcher asks for signatures and offers what it has compiled."""

    def __init__(self, name: str) -> None:
        self._name = name

    @property
    def cache_path(self) -> str:
        """The folder of the files."""
        return str(folder())

    def load_overload(self, signature: Any, target: Any) -> Any:
        """What was compiled for a signature, or None if that is not there or not intact."""
        from numba.core.compiler import CompileResult

        target.refresh()
        level = shipped_level()
        places = [(folder(), target.codegen().magic_tuple())]
        if level:
            places.append((SHIPPED / level, level))
        for place, processor in places:
            found = read(place / self._file(signature, processor))
            if found is not None:
                return CompileResult._rebuild(target, *found)
            if processor == level:
                warn_once(f"{place}: {self._name} did not come with the package, or is damaged; it is compiled")
        return None

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Save if there is room: a full or read-only disk costs time, not the result."""
        path = folder() / self._file(signature, compiled.codegen.magic_tuple())
        try:
            write(path, compiled._reduce())
        except OSError as error:
            warn_once(
                f"{path.parent}: compiled kernels cannot be kept there ({error.strerror}); "
                "every process compiles them again"
            )

    def _file(self, signature: Any, processor: object) -> str:
        key = repr((signature, processor, versions()))
        return f"{self._name}.{hashlib.sha256(key.encode()).hexdigest()[:16]}{SUFFIX}"


def write(path: Path, contents: object) -> None:
    """Write a file in one piece, behind its checksum."""
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
    """The contents of a file, or None if it is not there, not intact, or another's."""
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
    """Have what is compiled of a kernel kept in files."""
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
    """Warn, of each thing once."""
    warnings.warn(what, RuntimeWarning, stacklevel=3)
