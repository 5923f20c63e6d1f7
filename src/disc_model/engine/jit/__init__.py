"""Compilation of kernels, with the same floating-point rules for all.

``contract`` allows a * b + c to be rounded once. Nothing is reordered. In a * b + c * d the
optimiser chooses which product is not rounded, by the code around it: the last bit may depend on
that. Division by zero gives inf or nan instead of an exception inside the kernel.

A ``kernel`` is separate machine code that Python calls and the cache stores.  A ``helper`` is
compiled only as a part of each kernel that calls it.  An ``inlined`` helper is merged into its
caller.
"""

import warnings
from typing import Any

import numba
from numba.core.compiler_lock import global_compiler_lock

from . import cache

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
_MERGED: dict[str, Any] = {"no_cpython_wrapper": True}
try:
    from .merging import HelperCompiler, KernelCache, KernelCompiler
except (
    ImportError,
    AttributeError,
    TypeError,
) as error:  # a part of numba is missing or has changed
    changed = f"numba {numba.__version__} compiles otherwise than expected ({error}): it takes four times as long"
    warnings.warn(changed, RuntimeWarning, stacklevel=2)
else:
    RULES["pipeline_class"] = KernelCompiler
    _MERGED["pipeline_class"] = HelperCompiler


def kernel(function):
    """Compile a function that Python calls, once for all processes."""
    made = numba.njit(**RULES)(function)
    if made is function:  # compilation is switched off
        return made
    if "pipeline_class" in RULES:
        made._cache = KernelCache(function)
    else:  # by numba's own means
        settings = numba.config
        before, settings.CACHE_DIR = settings.CACHE_DIR, str(cache.folder())
        try:
            made.enable_caching()
        finally:
            settings.CACHE_DIR = before
    compile_or_load = made.compile

    def compile_in_turn(signature):
        """Compile unless another process does so at present: wait for that one, and load its
        file."""
        if signature in made.overloads:
            return compile_or_load(signature)
        processor = made.targetctx.codegen().magic_tuple()
        # numba's lock first: a thread with only one of the two would wait for one with the other
        with (
            global_compiler_lock,
            cache.lock(f"{made.__name__}.{cache.hash_of(signature, processor)}"),
        ):
            return compile_or_load(signature)

    made.compile = compile_in_turn
    return made


def helper(function, forceinline=False):
    """Compile a function as a part of kernels. Python calls a separate kernel instead of it."""
    # set in either case: a helper would inherit it from the inlined one that was being compiled
    part = numba.njit(**(RULES | _MERGED), forceinline=forceinline)(function)
    if part is function:  # compilation is switched off
        return part
    template, called_by_python = part.get_call_template, numba.njit(**RULES)(function)

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
    """The machine code of a kernel for arguments of these types, which are not checked at calls. A
    kernel itself checks the types of all arrays in its arguments at every call, which takes ten
    times as long as passing them."""
    if not hasattr(function, "compile"):  # compilation is switched off
        return function
    return function.compile(tuple(map(numba.typeof, arguments)))
