"""How kernels are compiled: the same floating-point rules for all.

``contract`` allows a * b + c to be rounded once; nothing is reordered, so results do not depend on the optimiser's
mood, and division by zero gives inf or nan instead of an exception inside the kernel.

``inlined`` is for small helpers of hot loops: a call would pass every array of a ``Series`` field by field, which costs
more than the helper's own work.
"""

from __future__ import annotations

from typing import Any

import numba

# Kernels allocate nothing, so reference counting (_nrt) is off: it cost more than the arithmetic.
RULES: dict[str, Any] = {"cache": True, "fastmath": {"contract"}, "error_model": "numpy", "_nrt": False}

kernel = numba.njit(**RULES)
inlined = numba.njit(forceinline=True, **RULES)
