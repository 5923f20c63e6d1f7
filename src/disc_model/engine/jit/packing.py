"""Named tuples that kernels receive as one pointer.

Numba would pass a tuple of arrays entry by entry: a model is 147 numbers to LLVM. A ``packed``
tuple is a block of memory with its numbers and, for each array, the address and the lengths. LLVM
is told that it is never written. An entry that is a tuple is a flag, (True,) or (): its length is a
part of the type, and it takes no memory.
"""

import ctypes
import functools
import hashlib
import struct
from typing import Any

import numba
import numpy as np

if getattr(numba.config, "DISABLE_JIT"):  # noqa: B009 - the attribute is made at run time

    def packed(cls):
        return cls

else:
    from llvmlite import ir
    from numba import extending, types
    from numba.core import cgutils
    from numba.core.typing.templates import AttributeTemplate

    _WORD, _BIT = ir.IntType(64), ir.IntType(1)

    class PackedType(types.Type):
        """``fields``: type of each entry, and the words of memory before it; an array is followed
        by its lengths."""

        def __init__(self, name, fields):
            self.fields = fields
            self.format = "".join(_format(kind) for kind, _ in fields.values())
            super().__init__(name=f"{name}_{hashlib.sha256(repr(fields).encode()).hexdigest()[:8]}")

    def _is_flag(kind):
        return isinstance(kind, types.UniTuple)

    def _format(kind):
        """The words of an entry, a character for each; an array is its address and its lengths."""
        if _is_flag(kind):
            return ""
        if isinstance(kind, types.Array):
            return "q" * (1 + kind.ndim)
        return "d" if kind == types.float64 else "q"

    _KNOWN: dict[Any, PackedType] = {}

    class _Packed:
        @functools.cached_property
        def numba_type(self):
            decisive = (
                type(self),
                *map(_decisive, self),
            )  # numba's own answers take 1 ms for the tuples of a case
            if decisive not in _KNOWN:
                fields, before = {}, 0
                for name, kind in zip(self._fields, map(_kind, self), strict=True):
                    fields[name] = kind, before
                    before += len(_format(kind))
                _KNOWN[decisive] = PackedType(type(self).__name__, fields)
            return _KNOWN[decisive]

        @functools.cached_property
        def address(self):
            words = [word for value in self for word in _words_of(value)]
            memory = np.frombuffer(struct.pack(self.numba_type.format, *words), np.int64)
            # two threads may come here at once: both get the block that is kept
            return self.__dict__.setdefault("_memory", memory).ctypes.data

    def _kind(value):
        flag = isinstance(value, tuple) and not isinstance(value, _Packed)
        return types.UniTuple(types.boolean, len(value)) if flag else numba.typeof(value)

    def _decisive(value):
        """What decides the type of an entry."""
        if isinstance(value, np.ndarray):
            return value.dtype, value.ndim, value.flags.num
        if isinstance(value, _Packed):
            return value.numba_type
        return value if isinstance(value, tuple) else type(value)

    def _words_of(value):
        if isinstance(value, np.ndarray):
            if not value.flags.c_contiguous:
                raise ValueError("an array of a packed tuple has to be contiguous")
            try:
                address = ctypes.addressof(ctypes.c_char.from_buffer(value))
            except (
                TypeError,
                ValueError,
            ):  # read-only or empty; for others this takes three times as long
                address = value.ctypes.data
            return address, *value.shape
        if isinstance(value, _Packed):
            return (value.address,)
        return () if isinstance(value, tuple) else (value,)

    def packed(cls):
        """Let kernels receive a class of named tuples as one pointer."""
        return type(
            cls.__name__, (_Packed, cls), {"__doc__": cls.__doc__, "__module__": cls.__module__}
        )

    @extending.typeof_impl.register(_Packed)
    def _typeof(value, context):
        return value.numba_type

    @extending.register_model(PackedType)
    class _PackedModel(extending.models.PrimitiveModel):
        def __init__(self, manager, kind):
            super().__init__(manager, kind, _WORD.as_pointer())

    @extending.unbox(PackedType)
    def _unbox(kind, value, c):
        address = c.pyapi.object_getattr_string(value, "address")
        exists = cgutils.is_not_null(c.builder, address)
        pointer = cgutils.alloca_once_value(c.builder, _WORD.as_pointer()(None))
        with c.builder.if_then(exists):
            c.builder.store(
                c.builder.inttoptr(c.pyapi.long_as_longlong(address), _WORD.as_pointer()), pointer
            )
            c.pyapi.decref(address)
        return extending.NativeValue(c.builder.load(pointer), is_error=c.builder.not_(exists))

    @extending.infer_getattr
    class _Attributes(AttributeTemplate):
        key = PackedType

        def generic_resolve(self, kind, name):
            return kind.fields.get(name, (None,))[0]

    @extending.lower_getattr_generic(PackedType)
    def _read(context, builder, kind, value, name):
        entry, before = kind.fields[name]

        def word(i, of=_WORD):
            pointer = builder.gep(value, [_WORD(before + i)])
            loaded = builder.load(builder.bitcast(pointer, of.as_pointer()))
            loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
            return loaded

        if isinstance(entry, types.Array):
            from numba.np.arrayobj import (
                np_cfarray,
            )  # takes long, and kernels from files do not need it

            lengths = types.UniTuple(types.intp, entry.ndim)
            shape = context.make_tuple(builder, lengths, [word(1 + i) for i in range(entry.ndim)])
            address = word(0, context.get_data_type(entry.dtype).as_pointer())
            return np_cfarray(
                context, builder, entry(types.CPointer(entry.dtype), lengths), (address, shape)
            )
        if _is_flag(entry):
            return context.make_tuple(builder, entry, [_BIT(1)] * entry.count)
        return (
            builder.trunc(word(0), _BIT)
            if entry == types.boolean
            else word(0, context.get_value_type(entry))
        )
