"""Compilation of kernels, with the same floating-point rules for all.

``contract`` allows a * b + c to be rounded once. Nothing is reordered. In a * b + c * d the
optimiser chooses which product is not rounded, by the code around it: the last bit may depend on
that. Division by zero gives inf or nan instead of an exception inside the kernel.

A ``kernel`` is separate machine code that Python calls and the cache stores.  A ``helper`` is
compiled only as a part of each kernel that calls it.  An ``inlined`` helper is merged into its
caller.

Kernels compile in half the time with `merging`, and in half of that with `blocks`, which use internals of
numba. Without them, because the variable `PLAIN` is set in the environment or because numba has
changed, numba compiles as it usually does, with the same results.
"""

import os
import warnings
from typing import Any

import numba
from numba.core.compiler_lock import global_compiler_lock

from . import cache

PLAIN = "DISC_MODEL_PLAIN_NUMBA"  # environment variable: compile without `merging` and `blocks`

# Kernels allocate nothing, so reference counting (_nrt) is off: it cost more than the arithmetic.
# No C code calls them. Nor do they touch Python's objects, so that threads run them side by side
# (nogil).
RULES: dict[str, Any] = {
    "fastmath": {"contract"},
    "error_model": "numpy",
    "_nrt": False,
    "no_cfunc_wrapper": True,
    "nogil": True,
}
_OF_HELPERS: dict[str, Any] = {**RULES, "no_cpython_wrapper": True}


def _merge() -> None:
    """Let kernels compile by `merging`, if numba has all that it needs."""
    try:
        from .merging import HelperCompiler, KernelCompiler
    except (ImportError, AttributeError, TypeError) as error:
        changed = f"numba {numba.__version__} compiles otherwise than expected ({error})"
        warnings.warn(f"{changed}: it takes twice as long", RuntimeWarning, stacklevel=2)
    else:
        RULES["pipeline_class"] = KernelCompiler
        _OF_HELPERS["pipeline_class"] = HelperCompiler


if not os.environ.get(PLAIN):
    _merge()


def kernel(function):
    """Compile a function that Python calls, once for all processes."""
    compiled = numba.njit(**RULES)(function)
    if compiled is function:  # compilation is switched off
        return compiled
    compiled._cache = cache.KernelCache(function)
    compile_or_load = compiled.compile

    def compile_in_turn(signature):
        """Compile unless another process does so at present: wait for that one, and load its
        file."""
        if signature in compiled.overloads:
            return compile_or_load(signature)
        # numba's lock first: a thread with only one of the two would wait for one with the other
        with global_compiler_lock, cache.lock(compiled.__name__, signature):
            return compile_or_load(signature)

    compiled.compile = compile_in_turn
    return compiled


def helper(function, forceinline=False):
    """Compile a function as a part of kernels. Python calls a separate kernel instead of it."""
    # set in either case: a helper would inherit it from the inlined one that was being compiled
    part = numba.njit(**_OF_HELPERS, forceinline=forceinline)(function)
    if part is function:  # compilation is switched off
        return part
    template = part.get_call_template
    called_by_python = numba.njit(**RULES)(function)

    def add_overload(compiled):
        part.overloads[tuple(compiled.signature.args)] = compiled

    part._compile_for_args = lambda *_, **__: called_by_python
    part.add_overload = add_overload
    part.get_call_template = lambda args, kws: template(
        tuple(map(numba.types.unliteral, args)), kws
    )
    return part


def inlined(function):
    """Compile a function into its callers: a small helper of hot loops, where a call would cost
    more than its work."""
    return helper(function, forceinline=True)


def compiled_for(function, arguments: tuple[object, ...]):
    """Return the machine code of a kernel for arguments of these types, which are not checked at
    calls. A kernel itself checks the types of all arrays in its arguments at every call, which
    takes ten times as long as passing them."""
    if not hasattr(function, "compile"):  # compilation is switched off
        return function
    return function.compile(tuple(map(numba.typeof, arguments)))
