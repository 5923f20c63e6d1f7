"""Helpers that are compiled only as parts of kernels.

Numba optimises every function and generates its machine code before it links it into its callers.  Most of ours are
called only by others.  Here a helper stays unoptimised until its kernel is complete, which is then optimised and turned
into machine code as a whole.
"""

from __future__ import annotations

import gc

import llvmlite.binding as llvm
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.typed_passes import InlineOverloads, NopythonRewrites
from numba.core.untyped_passes import InlineClosureLikes, LiteralUnroll, WithLifting

# Passes for constructs that no helper contains: closures, expressions of whole arrays, ``with``, loops over mixed
# tuples.
NEEDLESS = {InlineClosureLikes, InlineOverloads, LiteralUnroll, NopythonRewrites, WithLifting}


class _Codegen:
    """Numba's code generator, but without environments of helpers, which never touch Python."""

    def __init__(self, codegen):
        self._codegen = codegen

    def __getattr__(self, name):
        return getattr(self._codegen, name)

    def set_env(self, name, environment):
        pass


class HelperLibrary(JITCodeLibrary):
    """A helper that is neither optimised nor turned into machine code."""

    @property
    def codegen(self):
        return _Codegen(self._codegen)

    def _optimize_functions(self, ll_module):
        ll_module.data_layout = self._codegen._data_layout

    def finalize(self):
        self._raise_if_finalized()
        self._finalized = True

    def get_pointer_to_function(self, name):
        return 0


class KernelLibrary(JITCodeLibrary):
    """A kernel with all its helpers."""

    def _optimize_functions(self, ll_module):
        ll_module.data_layout = self._codegen._data_layout

    def finalize(self):
        # callers come before callees: LLVM leaves out functions that nothing has requested yet
        found = []
        _visit(self, found)
        self._linking_libraries = found[-2::-1]
        super().finalize()

    def _optimize_final_module(self):
        # unrolling loops takes two thirds of the time of all passes without gain
        options = llvm.create_pipeline_tuning_options(speed_level=3)
        options.loop_unrolling, options.slp_vectorization = False, False
        builder = llvm.create_pass_builder(self._codegen._tm, options)
        builder.getModulePassManager().run(self._final_module, builder)


def _visit(library, found):
    """Append a library after all libraries that it is linked to."""
    parts = library._linking_libraries if isinstance(library, HelperLibrary | KernelLibrary) else ()
    for each in parts:
        if each not in found:
            _visit(each, found)
    found.append(library)


class _Compiler(CompilerBase):
    library: type

    def define_pipelines(self):
        state = self.state
        if state.library is None:
            state.library = self.library(state.targetctx.codegen(), state.func_id.func_qualname)
            state.library.enable_object_caching()
        passes = DefaultPassBuilder.define_nopython_pipeline(state)
        passes.passes = [each for each in passes.passes if each[0] not in NEEDLESS]
        passes.finalize()
        return [passes]


class HelperCompiler(_Compiler):
    library = HelperLibrary


class KernelCompiler(_Compiler):
    library = KernelLibrary

    def compile_extra(self, function):
        # nearly all objects of a compilation live until its end: garbage collection took a tenth of the time
        collects = gc.isenabled()
        gc.disable()
        try:
            return super().compile_extra(function)
        finally:
            if collects:
                gc.enable()
