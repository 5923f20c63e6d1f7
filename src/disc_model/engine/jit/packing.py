"""Which named tuples kernels receive as one pointer, see `blocks`.

With ``NUMBA_DISABLE_JIT=1``, with the variable `PLAIN`, or if numba has changed so that `blocks`
cannot be imported, they are plain named tuples, which numba passes entry by entry: the results are
the same, and compiling takes twice as long.
"""

import os
import warnings
from typing import NamedTuple

import numba

from . import PLAIN


class Part(NamedTuple):
    """An array that is a part of another one of its tuple."""

    whole: str  # name of that array
    start: int
    length: int


def _unpacked(parts=None):
    """Leave a class of named tuples as it is."""
    return lambda cls: cls


def _packing():
    if getattr(numba.config, "DISABLE_JIT") or os.environ.get(PLAIN):  # noqa: B009 - made at run time
        return _unpacked
    try:
        from .blocks import packed
    except (ImportError, AttributeError, TypeError) as error:
        changed = f"numba {numba.__version__} passes tuples otherwise than expected ({error})"
        warnings.warn(f"{changed}: compiling takes twice as long", RuntimeWarning, stacklevel=2)
        return _unpacked
    return packed


packed = _packing()
