"""How kernels are compiled: the same floating-point rules for all.

``contract`` allows a * b + c to be rounded once; nothing is reordered, so results do not depend on the optimiser's
mood, and division by zero gives inf or nan instead of an exception inside the kernel.

``inlined`` is for small helpers of hot loops: a call would pass every array of a ``Series`` field by field, which costs
more than the helper's own work.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba

# Kernels allocate nothing, so reference counting (_nrt) is off: it cost more than the arithmetic.
RULES: dict[str, Any] = {"cache": True, "fastmath": {"contract"}, "error_model": "numpy", "_nrt": False}

kernel = numba.njit(**RULES)
inlined = numba.njit(forceinline=True, **RULES)


def compiled_for(function: Callable[..., Any], arguments: tuple[object, ...]) -> Callable[..., Any]:
    """The machine code of a kernel for arguments of these types, to be called with no others: nothing checks them.

    A kernel itself looks at the types of all arrays in its arguments at every call, which takes ten times as long as to
    hand them over.
    """
    if not hasattr(function, "compile"):  # where compilation is switched off
        return function
    code: Callable[..., Any] = function.compile(tuple(numba.typeof(argument) for argument in arguments))
    return code
