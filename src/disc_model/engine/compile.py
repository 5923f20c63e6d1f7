"""How kernels are compiled: the same floating-point rules for all.

``contract`` allows a * b + c to be rounded once; nothing is reordered, so results do not depend on the optimiser's
mood, and division by zero gives inf or nan instead of an exception inside the kernel.

``inlined`` is for small helpers of hot loops: a call would pass every array of a ``Series`` field by field, which costs
more than the helper's own work. Those whose names begin with ``_`` are called by kernels alone: what lets Python call a
kernel holds all of it once more, and such wrappers of helpers were a fifth of what compilation takes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn

import numba

# Kernels allocate nothing, so reference counting (_nrt) is off: it cost more than the arithmetic. No C code calls them.
RULES: dict[str, Any] = {
    "cache": True, "fastmath": {"contract"}, "error_model": "numpy", "_nrt": False, "no_cfunc_wrapper": True,
}  # fmt: skip

kernel = numba.njit(**RULES)


def inlined(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a helper into what calls it."""
    inner = function.__name__.startswith("_")
    rules: dict[str, Any] = RULES | {"forceinline": True, "no_cpython_wrapper": inner}
    helper: Any = numba.njit(**rules)(function)
    if inner and helper is not function:  # which it is where compilation is switched off
        _keep_from_python(helper)
    return helper


def _keep_from_python(helper: Any) -> None:
    """Let a call from Python end in an error: without a wrapper it would end in a crash."""

    def refuse(*_: object, **__: object) -> NoReturn:
        raise TypeError(f"{helper.py_func.__name__} is called by kernels alone: its name begins with _")

    def add_overload(compiled: Any) -> None:
        helper.overloads[tuple(compiled.signature.args)] = compiled

    helper._compile_for_args = refuse
    helper.add_overload = add_overload


def compiled_for(function: Callable[..., Any], arguments: tuple[object, ...]) -> Callable[..., Any]:
    """The machine code of a kernel for arguments of these types, to be called with no others: nothing checks them.

    A kernel itself looks at the types of all arrays in its arguments at every call, which takes ten times as long as to
    hand them over.
    """
    if not hasattr(function, "compile"):  # where compilation is switched off
        return function
    code: Callable[..., Any] = function.compile(tuple(numba.typeof(argument) for argument in arguments))
    return code
