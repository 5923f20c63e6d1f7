"""Compilation of kernels, with the same floating-point rules for all.

``contract`` allows a * b + c to be rounded once. Nothing is reordered. In a * b + c * d the optimiser chooses which
product is not rounded, by the code around it: the last bit may depend on that.
Division by zero gives inf or nan instead of an exception inside the kernel.

A ``kernel`` is separate machine code that Python calls and the cache stores.  A ``helper`` is compiled only as a part
of each kernel that calls it.  An ``inlined`` helper is merged into its caller.
"""

import functools
from collections.abc import Callable
from types import FunctionType, ModuleType
from typing import Any

import numba
from numba.core.compiler_lock import global_compiler_lock

from . import cache

# Kernels allocate nothing, so reference counting (_nrt) is off: it cost more than the arithmetic. No C code calls them.
# Nor do they touch Python's objects, so that threads run them side by side (nogil).
RULES: dict[str, Any] = {
    "fastmath": {"contract"},
    "error_model": "numpy",
    "_nrt": False,
    "no_cfunc_wrapper": True,
    "nogil": True,
}
_MERGED: dict[str, Any] = {"no_cpython_wrapper": True}
try:
    from .merging import HelperCache, HelperCompiler, KernelCache, KernelCompiler
except (ImportError, AttributeError, TypeError) as error:  # a part of numba is missing or has changed
    cache.warn_once(
        f"numba {numba.__version__} compiles otherwise than expected ({error}): it takes four times as long"
    )
else:
    RULES["pipeline_class"] = KernelCompiler
    _MERGED["pipeline_class"] = HelperCompiler


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function that Python calls, once for all processes."""
    made: Any = numba.njit(**RULES)(function)
    if made is not function:  # which it is where compilation is switched off
        _keep(made)
        made.compile = functools.partial(_compile_in_turn, made, made.compile)
    return made


def _compile_in_turn(kernel: Any, compile_or_load: Callable[..., Any], signature: Any) -> Any:
    """Compile a kernel unless another process does so at present: wait for that one, and load its file."""
    if signature in kernel.overloads:
        return compile_or_load(signature)
    processor = kernel.targetctx.codegen().magic_tuple()
    # numba's lock first: a thread with only one of the two would wait for one with the other
    with global_compiler_lock, cache.lock(f"{kernel.__name__}.{cache.hash_of(signature, processor)}"):
        return compile_or_load(signature)


def _keep(kernel: Any) -> None:
    """Store the compiled code of a kernel in files: by numba's own means where `merging` does not work."""
    if "pipeline_class" in RULES:
        kernel._cache = KernelCache(kernel.py_func)
        return
    settings: Any = numba.config
    before, settings.CACHE_DIR = settings.CACHE_DIR, str(cache.folder())
    try:
        kernel.enable_caching()
    finally:
        settings.CACHE_DIR = before


def helper(function: Callable[..., Any], forceinline: bool = False) -> Callable[..., Any]:
    """Compile a function as a part of kernels."""
    # set in either case: a helper would inherit it from the inlined one that was being compiled
    part: Any = numba.njit(**(RULES | _MERGED), forceinline=forceinline)(function)
    if part is not function:  # which it is where compilation is switched off
        _make_part(part, numba.njit(**RULES)(function))
    return part


def inlined(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function into its callers. This is for small helpers of hot loops, where a call would cost more than
    the helper's own work."""
    return helper(function, forceinline=True)


def _make_part(part: Any, kernel: Any) -> None:
    """Let Python call a separate kernel instead of a helper, and specialise on no more of the types than it uses."""
    template = part.get_call_template

    def add_overload(compiled: Any) -> None:
        part.overloads[tuple(compiled.signature.args)] = compiled

    def narrowed(kind: Any) -> Any:
        kind = numba.types.unliteral(kind)
        return kind.narrowed(_names(part.py_func)) if hasattr(kind, "narrowed") else kind

    part._compile_for_args = lambda *_, **__: kernel
    part.add_overload = add_overload
    part.get_call_template = lambda args, kws: template(tuple(map(narrowed, args)), kws)
    if "pipeline_class" in RULES:
        part._cache = HelperCache(part.py_func)


@functools.cache
def _names(function: FunctionType) -> frozenset[str]:
    """All names in the code of a function and of those that it calls."""
    names, found, left = set[str](), {function}, [function]
    while left:
        one = left.pop()
        here, known = one.__code__.co_names, one.__globals__
        modules = (vars(known[name]) for name in here if isinstance(known.get(name), ModuleType))
        called = {getattr(place.get(name), "py_func", function) for place in (known, *modules) for name in here}
        names.update(here)
        left += called - found
        found |= called
    return frozenset(names)


def compiled_for(function: Callable[..., Any], arguments: tuple[object, ...]) -> Callable[..., Any]:
    """The machine code of a kernel for arguments of these types, which are not checked at calls. A kernel itself checks
    the types of all arrays in its arguments at every call, which takes ten times as long as passing them."""
    if not hasattr(function, "compile"):  # where compilation is switched off
        return function
    code: Callable[..., Any] = function.compile(tuple(numba.typeof(argument) for argument in arguments))
    return code
