"""Kernels, and helpers that are compiled only as parts of kernels.

Numba optimises every function and generates its machine code before it links it into its callers.
Here a helper stays unoptimised until its kernel is complete, which is then optimised as a whole.

The module uses internals of numba that may change: `jit` does without it if one is missing, or if
it is switched off there.
"""

import gc
from copy import copy

import llvmlite.binding as llvm
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.typed_passes import InlineOverloads, NopythonRewrites
from numba.core.untyped_passes import InlineClosureLikes, LiteralUnroll, WithLifting

# Passes for what no helper contains: closures, expressions of whole arrays, ``with``, loops over
# mixed tuples.
NEEDLESS = {InlineClosureLikes, InlineOverloads, LiteralUnroll, NopythonRewrites, WithLifting}


class HelperLibrary(JITCodeLibrary):
    """A helper that is neither optimised nor turned into machine code."""

    @property
    def codegen(self):
        codegen = copy(self._codegen)
        # a helper has no environment, as it never touches Python
        codegen.set_env = lambda name, environment: None
        return codegen

    def _optimize_functions(self, ll_module):
        ll_module.data_layout = self._codegen._data_layout

    def finalize(self):
        self._raise_if_finalized()
        self._finalized = True

    def get_pointer_to_function(self, name):
        return 0


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
        options.loop_unrolling = False
        options.slp_vectorization = False
        builder = llvm.create_pass_builder(self._codegen._tm, options)
        builder.getModulePassManager().run(self._final_module, builder)


def _visit(library, libraries):
    """Append a library after all libraries that it is linked to."""
    if isinstance(library, HelperLibrary | KernelLibrary):
        for part in library._linking_libraries:
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
