"""Kernels and their files, and helpers that are compiled only as parts of kernels.

Numba optimises every function and generates its machine code before it links it into its callers.
Here a helper stays unoptimised until its kernel is complete, which is then optimised as a whole.

The module uses internals of numba that may change: `jit` does without it if one is missing.
"""

import gc
import warnings
from copy import copy

import llvmlite.binding as llvm
from numba.core.caching import NullCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, CompileResult, DefaultPassBuilder
from numba.core.typed_passes import InlineOverloads, NopythonRewrites
from numba.core.untyped_passes import InlineClosureLikes, LiteralUnroll, WithLifting

from . import cache

# Raises AttributeError if numba's dispatcher would not call the caches below, or could not store
# what it compiles.
_NEEDED = (
    NullCache().load_overload,
    NullCache().save_overload,
    CompileResult._reduce,
    CompileResult._rebuild,
)

# Passes for what no helper contains: closures, expressions of whole arrays, ``with``, loops over
# mixed tuples.
NEEDLESS = {InlineClosureLikes, InlineOverloads, LiteralUnroll, NopythonRewrites, WithLifting}


class HelperLibrary(JITCodeLibrary):
    """A helper that is neither optimised nor turned into machine code."""

    @property
    def codegen(self):
        codegen = copy(self._codegen)
        codegen.set_env = lambda name, environment: (
            None
        )  # a helper has no environment, as it never touches Python
        return codegen

    def _optimize_functions(self, ll_module):
        ll_module.data_layout = self._codegen._data_layout

    def finalize(self):
        self._raise_if_finalized()
        self._finalized = True

    def get_pointer_to_function(self, name):
        return 0


class KernelCache:
    """The files of one kernel, with the methods that numba's dispatcher calls."""

    def __init__(self, function):
        self._name = f"{function.__module__.rsplit('.')[-1]}.{function.__qualname__}"

    @property
    def cache_path(self):
        return str(cache.folder())

    def load_overload(self, signature, target):
        reduced = cache.read(self._path(signature, target.codegen()))
        return None if reduced is None else CompileResult._rebuild(target, *reduced)

    def save_overload(self, signature, compiled):
        """Save compiled code if possible: a full or read-only disk costs time, not the result."""
        path = self._path(signature, compiled.codegen)
        try:
            cache.write(path, compiled._reduce())
        except OSError as error:
            reason = f"compiled kernels cannot be kept there ({error.strerror}); every process compiles them again"
            warnings.warn(f"{path.parent}: {reason}", RuntimeWarning, stacklevel=2)

    def _path(self, signature, codegen):
        return (
            cache.folder()
            / f"{self._name}.{cache.hash_of(signature, codegen.magic_tuple())}.kernel"
        )


class KernelLibrary(JITCodeLibrary):
    def _optimize_functions(self, ll_module):
        ll_module.data_layout = self._codegen._data_layout

    def finalize(self):
        # callers come before callees: LLVM leaves out functions that nothing has requested yet
        libraries = []
        _visit(self, libraries)
        self._linking_libraries = libraries[-2::-1]
        super().finalize()

    def _optimize_final_module(self):
        # unrolling loops takes two thirds of the time of all passes without gain
        options = llvm.create_pipeline_tuning_options(speed_level=3)
        options.loop_unrolling, options.slp_vectorization = False, False
        builder = llvm.create_pass_builder(self._codegen._tm, options)
        builder.getModulePassManager().run(self._final_module, builder)


def _visit(library, libraries):
    """Append a library after all libraries that it is linked to."""
    for part in (
        library._linking_libraries if isinstance(library, HelperLibrary | KernelLibrary) else ()
    ):
        if part not in libraries:
            _visit(part, libraries)
    libraries.append(library)


class HelperCompiler(CompilerBase):
    library: type = HelperLibrary

    def define_pipelines(self):
        state = self.state
        if state.library is None:
            state.library = self.library(state.targetctx.codegen(), state.func_id.func_qualname)
            state.library.enable_object_caching()
        passes = DefaultPassBuilder.define_nopython_pipeline(state)
        passes.passes = [each for each in passes.passes if each[0] not in NEEDLESS]
        passes.finalize()
        return [passes]


class KernelCompiler(HelperCompiler):
    library = KernelLibrary

    def compile_extra(self, function):
        # nearly all objects of a compilation live until its end: garbage collection took a tenth of
        # the time
        collects = gc.isenabled()
        gc.disable()
        try:
            return super().compile_extra(function)
        finally:
            if collects:
                gc.enable()
