"""Files of compiled kernels: numba's cache, with checksums.

Numba trusts what it finds there: a cut file ends in a traceback, a changed byte of machine code in a crash or in wrong
numbers.  It also keeps an index of each kernel's files that is read and written back without a lock, so that processes
that compile at the same time can come to load each other's code.  Here each compiled signature has one file, named by
what was compiled.  The file begins with a checksum and says what it holds; what does not fit is compiled anew.

This stands on parts of numba that it may change: see `cache`, which does without where one is missing.
"""

from __future__ import annotations

import contextlib
import glob
import hashlib
import os
import pickle
import uuid
import warnings

import numba
from numba.core import caching
from numba.core.serialize import dumps


class KernelFiles:
    """The files of one kernel; stands in for numba's index and data files."""

    def __init__(self, folder, name, source_stamp):
        self._folder = folder
        self._name = name
        self._stamp = (numba.__version__, source_stamp)

    def load(self, key):
        """What was saved for a signature, or None if that is not there or not intact."""
        try:
            with open(self._path(key), "rb") as file:
                digest, body = file.read(_DIGEST), file.read()
        except OSError:
            return None
        if hashlib.sha256(body).digest() != digest:
            return None
        stamp, rest = pickle.loads(body)
        if stamp != self._stamp:
            return None  # and the rest may name what this version of numba does not have
        found, data = pickle.loads(rest)
        return data if found == key else None

    def save(self, key, data):
        """Write one file, in one piece."""
        body = dumps((self._stamp, dumps((key, data))))
        temporary = os.path.join(self._folder, f"{self._name}.{uuid.uuid4().hex}.tmp")
        try:
            with open(temporary, "wb") as file:
                file.write(hashlib.sha256(body).digest() + body)
            os.replace(temporary, self._path(key))
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(temporary)
            raise

    def flush(self):
        """Forget all signatures."""
        for path in glob.glob(f"{glob.escape(os.path.join(self._folder, self._name))}.*{_SUFFIX}"):
            with contextlib.suppress(FileNotFoundError):
                os.unlink(path)

    def _path(self, key):
        # The text of a key is the same in every process, since no kernel is handed a function.
        name = hashlib.sha256(repr(key).encode()).hexdigest()[:16]
        return os.path.join(self._folder, f"{self._name}.{name}{_SUFFIX}")


_SUFFIX = ".kernel"
_DIGEST = hashlib.sha256().digest_size


class _Locator(caching.UserProvidedCacheLocator):
    @classmethod
    def get_suitable_cache_subpath(cls, py_file):
        # the folder is named by a hash of the sources: copies of them elsewhere may share it
        return ""


class _Implementation(caching.CompileResultCacheImpl):
    _locator_classes = [_Locator, *caching.CompileResultCacheImpl._locator_classes]  # noqa: RUF012 - numba's own type


class KernelCache(caching.FunctionCache):
    """Numba's cache of one function, kept in `KernelFiles`."""

    _impl_class = _Implementation

    def __init__(self, py_func):
        super().__init__(py_func)
        locator = self._impl.locator
        if not hasattr(self, "_cache_file"):
            raise AttributeError("a cache has no _cache_file")
        self._cache_file = KernelFiles(self.cache_path, self._impl.filename_base, locator.get_source_stamp())

    def save_overload(self, sig, data):
        """Save if there is room: a full or read-only disk costs time, not the result."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            warnings.warn(
                f"{self.cache_path}: compiled kernels cannot be kept there ({error.strerror}); "
                "every process compiles them again",
                RuntimeWarning,
                stacklevel=2,
            )
