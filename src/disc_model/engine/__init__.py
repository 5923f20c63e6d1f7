"""The event-driven engine: kernels on floats and arrays, nothing else.

Numba's cache does not notice that a callee in another file has changed.  The cache therefore lives in a folder named
by a hash of all sources of this package, set before the kernels are defined.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import numba


def source_hash() -> str:
    """Hash of the engine's sources: 16 hexadecimal digits."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _cache_folder() -> str:
    from platformdirs import user_cache_dir

    base = os.environ.get("NUMBA_CACHE_DIR") or user_cache_dir("disc_model")
    return str(Path(base) / f"engine-{source_hash()}")


_SETTING = "CACHE_DIR"
# Only the kernels of this package go there: the setting of other users of numba is put back.
_before = getattr(numba.config, _SETTING)
setattr(numba.config, _SETTING, _cache_folder())
try:
    from . import audit, evaluate, layout, machine, polynomial, sampling, series, switches, variational
finally:
    setattr(numba.config, _SETTING, _before)

__all__ = [
    "audit",
    "evaluate",
    "layout",
    "machine",
    "polynomial",
    "sampling",
    "series",
    "source_hash",
    "switches",
    "variational",
]
