"""The event-driven engine: kernels on floats and arrays, nothing else.

Numba's cache does not notice that a callee in another file has changed.  The cache therefore lives in a folder named
by a hash of all sources of this package, set before the kernels are defined; `cache` says what is in it.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

from .cache import kept_in


def source_hash() -> str:
    """Hash of the engine's sources, comments included: 16 hexadecimal digits.

    Numba stamps a kernel with its file's content and names it by its line, so that it would compile after a changed
    comment all the same; and copies that differ in comments would write over each other's kernels in one folder.
    """
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _cache_folder() -> str:
    from platformdirs import user_cache_dir

    base = os.environ.get("NUMBA_CACHE_DIR") or user_cache_dir("disc_model")
    return str(Path(base) / f"engine-{source_hash()}")


with kept_in(_cache_folder()):
    from . import machine, variational  # and with them all that is compiled

__all__ = ["machine", "source_hash", "variational"]
