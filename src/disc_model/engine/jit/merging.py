"""Kernels and their files, and helpers that are compiled only as parts of kernels.

Numba optimises every function and generates its machine code before it links it into its callers.  Here a helper stays
unoptimised until its kernel is complete, which is then optimised as a whole. Its code is stored beside the kernel that
first needed it (``cache.HELPERS``), and linked into kernels that other processes compile later.

The module uses internals of numba that may change: `jit` does without it if one is missing.
"""

import gc
import pickle
from copy import copy
from typing import ClassVar

import llvmlite.binding as llvm
from numba.core.caching import NullCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, CompileResult, DefaultPassBuilder, compile_result
from numba.core.serialize import dumps
from numba.core.typed_passes import InlineOverloads, NopythonRewrites
from numba.core.untyped_passes import InlineClosureLikes, LiteralUnroll, WithLifting

from . import cache

# Raises AttributeError if numba's dispatcher would not call the caches below, or could not store what it compiles.
_NEEDED = NullCache().load_overload, NullCache().save_overload, CompileResult._reduce, CompileResult._rebuild

# Passes for what no helper contains: closures, expressions of whole arrays, ``with``, loops over mixed tuples.
NEEDLESS = {InlineClosureLikes, InlineOverloads, LiteralUnroll, NopythonRewrites, WithLifting}


class HelperLibrary(JITCodeLibrary):
    """A helper that is neither optimised nor turned into machine code."""

    @property
    def codegen(self):
        codegen = copy(self._codegen)
        codegen.set_env = lambda name, environment: None  # a helper has no environment, as it never touches Python
        return codegen

    def _optimize_functions(self, ll_module):
        ll_module.data_layout = self._codegen._data_layout

    def finalize(self):
        self._raise_if_finalized()
        self._finalized = True

    def get_pointer_to_function(self, name):
        return 0

    known: ClassVar[dict] = {}  # libraries by their keys, the function and the types of its arguments, or by their code
    key = None

    def stored(self):
        """Its code as bytes.  Helpers that it calls are named; other code that it calls is included."""
        parts = dict.fromkeys(self._linking_libraries)
        keys = (getattr(each, "key", None) for each in parts)
        links = [(e.name, key or e._get_module_for_linking().as_bitcode()) for e, key in zip(parts, keys, strict=True)]
        return dumps((self.name, self._final_module.as_bitcode(), links, self.result))

    @classmethod
    def of_code(cls, codegen, name, code):
        if code not in cls.known:
            cls.known[code] = cls(codegen, name)
            cls.known[code]._final_module, cls.known[code]._finalized = llvm.parse_bitcode(code), True
        return cls.known[code]

    @classmethod
    def restored(cls, codegen, key):
        """The library with a key, from files if need be.  Raises KeyError."""
        if key not in cls.known:
            name, code, links, result = pickle.loads(cache.stored_helpers(codegen)[key])
            self = cls.of_code(codegen, name, code)
            for called, link in links:
                stored = isinstance(link, str)
                part = cls.restored(codegen, link) if stored else cls.of_code(codegen, called, link)
                self._linking_libraries.append(part)
            self.key, self.result = key, result
            cls.known[key] = self
        return cls.known[key]


class KernelCache:
    """The files of one kernel, with the methods that numba's dispatcher calls."""

    def __init__(self, function):
        self._name = f"{function.__module__.rsplit('.')[-1]}.{function.__qualname__}"

    @property
    def cache_path(self):
        return str(cache.folder())

    def load_overload(self, signature, target):
        reduced = cache.read(cache.folder() / self._file(signature, target.codegen().magic_tuple()))
        return None if reduced is None else CompileResult._rebuild(target, *reduced)

    def save_overload(self, signature, compiled):
        """Save compiled code if possible: a full or read-only disk costs time, not the result."""
        processor, helpers = compiled.codegen.magic_tuple(), compiled.library.new_helpers()
        path = cache.folder() / self._file(signature, processor)
        try:
            cache.write(path, compiled._reduce())
            if helpers:
                cache.write(path.with_suffix(f".{cache.hash_of(processor)}{cache.HELPERS}"), helpers)
        except OSError as error:
            cache.warn_once(
                f"{path.parent}: compiled kernels cannot be kept there ({error.strerror}); "
                "every process compiles them again"
            )

    def _file(self, signature, processor):
        return f"{self._name}.{cache.hash_of(signature, processor)}.kernel"


class HelperCache:
    """The helpers of kernels compiled before, as in a `KernelCache`."""

    cache_path = None

    def __init__(self, function):
        self._name = f"{function.__module__}.{function.__qualname__}"

    def load_overload(self, signature, target):
        try:
            library = HelperLibrary.restored(target.codegen(), f"{self._name}{signature}")
        except KeyError:
            return None
        typed, descriptor = library.result
        return compile_result(
            target_context=target, typing_context=target.typing_context, library=library, entry_point=object(),
            fndesc=descriptor, signature=typed, objectmode=False,
        )  # fmt: skip

    def save_overload(self, signature, compiled):
        library, descriptor = compiled.library, compiled.fndesc
        descriptor.typemap = descriptor.calltypes = None  # not needed any more, and large
        library.key, library.result = f"{self._name}{signature}", (compiled.signature, descriptor)
        library.known[library.key] = library


class KernelLibrary(JITCodeLibrary):
    def new_helpers(self):
        """The helpers that are in no file yet, by their keys, as bytes."""
        stored = cache.stored_helpers(self._codegen)
        keys = {getattr(each, "key", None): each for each in self._linking_libraries}
        new = {key: each.stored() for key, each in keys.items() if key and key not in stored}
        stored |= new
        return new

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
    for part in library._linking_libraries if isinstance(library, HelperLibrary | KernelLibrary) else ():
        if part not in libraries:
            _visit(part, libraries)
    libraries.append(library)


class HelperCompiler(CompilerBase):
    library: type = HelperLibrary

    def define_pipelines(self):
        state = self.state
        if self.library is HelperLibrary:
            # usually a number that counts compilations: callers from files know helpers by their names
            state.func_id.unique_id = 0
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
        # nearly all objects of a compilation live until its end: garbage collection took a tenth of the time
        collects = gc.isenabled()
        gc.disable()
        try:
            return super().compile_extra(function)
        finally:
            if collects:
                gc.enable()
