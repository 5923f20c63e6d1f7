"""Where compiled kernels are kept: in a folder of ours, with checksums if numba has the parts that these need."""

from __future__ import annotations

import contextlib
import functools
import warnings
from collections.abc import Iterator
from typing import Any

import numba

# What a part of numba that is not there, or not as expected, ends in.
MISSING = (ImportError, AttributeError, TypeError)

# Type checkers do not know what settings there are, nor who makes caches.
_SETTINGS: Any = numba.config
_USER: Any = None
with contextlib.suppress(ImportError):
    from numba.core import dispatcher

    _USER = dispatcher


@contextlib.contextmanager
def kept_in(folder: str) -> Iterator[None]:
    """Keep the kernels that are defined meanwhile in a folder; other users of numba are left as they were."""
    before, own = _SETTINGS.CACHE_DIR, getattr(_USER, "FunctionCache", None)
    _SETTINGS.CACHE_DIR = folder
    if own is None:
        _say_once("numba.core.dispatcher has no FunctionCache")
    else:
        _USER.FunctionCache = functools.partial(_cache_of, own)
    try:
        yield
    finally:
        _SETTINGS.CACHE_DIR = before
        if own is not None:
            _USER.FunctionCache = own


def _cache_of(own, py_func):
    """The cache of one function: with checksums, or numba's own where it lacks the parts for that."""
    try:
        from .kernel_files import KernelCache

        return KernelCache(py_func)
    except MISSING as error:
        _say_once(str(error))
        return own(py_func)


@functools.cache
def _say_once(what: str) -> None:
    warnings.warn(
        f"numba {numba.__version__} keeps compiled kernels in another way than expected ({what}): "
        "its own files are used, which have no checksums",
        RuntimeWarning,
        stacklevel=2,
    )
