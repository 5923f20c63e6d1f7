"""Named tuples that kernels receive as one pointer.

Numba would pass a tuple of arrays entry by entry: a model is 147 numbers to LLVM. A ``packed``
tuple is a block of memory with its numbers and, for each array, the address and the lengths. LLVM
is told that it is never written. An entry that is a tuple is a flag, (True,) or (): its length is a
part of the type, and it takes no memory.

How a tuple gets into a kernel: numba asks for its type (`_typeof`), which has a place in memory for
each field, and is kept by what decides it. When a kernel is called, numba unboxes the tuple
(`_unbox`): it takes the address of the block, which is made at the first call and kept with the
tuple. In a kernel, ``tuple.field`` loads the words of that field (`_read`), an array as address and
lengths.

An array may be declared a `packing.Part` of another one. Kernels then compute its address from that
of the whole: with an address for each, loops run out of registers (5 % of a step).
"""

import ctypes
import functools
import hashlib
import struct
from typing import Any, NamedTuple

import numba
import numpy as np
from llvmlite import ir
from numba import extending, types
from numba.core import cgutils
from numba.core.typing.templates import AttributeTemplate

_WORD = ir.IntType(64)
_BIT = ir.IntType(1)


class Field(NamedTuple):
    """An entry of a packed tuple."""

    kind: Any  # numba's type
    before: int  # words of memory before it
    part: Any  # `packing.Part` or None


class PackedType(types.Type):
    """Type of a packed tuple in kernels; fields: `Field` by name."""

    def __init__(self, name, fields):
        self.fields = fields
        self.format = "".join(_format(field.kind) for field in fields.values())
        digest = hashlib.sha256(repr(fields).encode()).hexdigest()[:8]
        super().__init__(name=f"{name}_{digest}")


# ---- In Python


def packed(parts=None):
    """Let kernels receive a class of named tuples as one pointer.

    parts : `packing.Part` by name of field, for arrays that always lie there
    """

    def decorate(cls):
        names = {"__doc__": cls.__doc__, "__module__": cls.__module__, "_parts": parts or {}}
        return type(cls.__name__, (_Packed, cls), names)

    return decorate


class _Packed:
    """What a packed tuple has besides its entries."""

    _parts: dict[str, Any]

    @functools.cached_property
    def numba_type(self):
        """Type in kernels; numba's own answers take 1 ms for the tuples of a case."""
        decisive = type(self), *map(_decisive, self)
        if decisive not in _KNOWN:
            _KNOWN[decisive] = _type_of(self)
        return _KNOWN[decisive]

    @functools.cached_property
    def address(self):
        """Address of the block of memory."""
        words = []
        for value in self:
            words += _words_of(value)
        memory = np.frombuffer(struct.pack(self.numba_type.format, *words), np.int64)
        # two threads may come here at once: both get the block that is kept
        return self.__dict__.setdefault("_memory", memory).ctypes.data


_KNOWN: dict[Any, PackedType] = {}


def _type_of(value):
    fields = {}
    before = 0
    for name, entry in zip(value._fields, value, strict=True):
        kind = _kind(entry)
        fields[name] = Field(kind, before, value._parts.get(name))
        before += len(_format(kind))
    return PackedType(type(value).__name__, fields)


def _kind(value):
    """Numba's type of an entry."""
    if isinstance(value, tuple) and not isinstance(value, _Packed):
        return types.UniTuple(types.boolean, len(value))
    return numba.typeof(value)


def _is_flag(kind):
    return isinstance(kind, types.UniTuple)


def _format(kind):
    """The words of an entry, a character for each; an array is its address and its lengths."""
    if _is_flag(kind):
        return ""
    if isinstance(kind, types.Array):
        return "q" * (1 + kind.ndim)
    return "d" if kind == types.float64 else "q"


def _decisive(value):
    """What decides the type of an entry."""
    if isinstance(value, np.ndarray):
        return value.dtype, value.ndim, value.flags.num
    if isinstance(value, _Packed):
        return value.numba_type
    return value if isinstance(value, tuple) else type(value)


def _words_of(value):
    """The words of an entry's value."""
    if isinstance(value, np.ndarray):
        return _address_of(value), *value.shape
    if isinstance(value, _Packed):
        return (value.address,)
    return () if isinstance(value, tuple) else (value,)


def _address_of(array):
    if not array.flags.c_contiguous:
        raise ValueError("an array of a packed tuple has to be contiguous")
    try:
        return ctypes.addressof(ctypes.c_char.from_buffer(array))
    except (TypeError, ValueError):
        # read-only or empty; for others this takes three times as long
        return array.ctypes.data


# ---- In kernels


@extending.typeof_impl.register(_Packed)
def _typeof(value, context):
    return value.numba_type


@extending.register_model(PackedType)
class _PackedModel(extending.models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, _WORD.as_pointer())


@extending.unbox(PackedType)
def _unbox(kind, value, c):
    """Take the address of the block from the attribute ``address``; a null pointer with an
    error if that raises."""
    address = c.pyapi.object_getattr_string(value, "address")
    exists = cgutils.is_not_null(c.builder, address)
    pointer = cgutils.alloca_once_value(c.builder, _WORD.as_pointer()(None))
    with c.builder.if_then(exists):
        number = c.pyapi.long_as_longlong(address)
        c.builder.store(c.builder.inttoptr(number, _WORD.as_pointer()), pointer)
        c.pyapi.decref(address)
    return extending.NativeValue(c.builder.load(pointer), is_error=c.builder.not_(exists))


@extending.infer_getattr
class _Attributes(AttributeTemplate):
    key = PackedType

    def generic_resolve(self, kind, name):
        return kind.fields[name].kind if name in kind.fields else None


@extending.lower_getattr_generic(PackedType)
def _read(context, builder, kind, value, name):
    """Load a field."""
    field = kind.fields[name]
    if _is_flag(field.kind):
        return context.make_tuple(builder, field.kind, [_BIT(1)] * field.kind.count)
    if isinstance(field.kind, types.Array):
        return _read_array(context, builder, kind, value, field)
    if field.kind == types.boolean:
        return builder.trunc(_load_word(builder, value, field.before), _BIT)
    return _load_word(builder, value, field.before, context.get_value_type(field.kind))


def _read_array(context, builder, kind, value, field):
    from numba.np.arrayobj import np_cfarray  # takes long, and kernels from files do not need it

    pointer_type = context.get_data_type(field.kind.dtype).as_pointer()
    if field.part is None:
        address = _load_word(builder, value, field.before, pointer_type)
        lengths = [_load_word(builder, value, field.before + 1 + i) for i in range(field.kind.ndim)]
    else:
        whole = kind.fields[field.part.whole]
        address = _load_word(builder, value, whole.before, pointer_type)
        address = builder.gep(address, [_WORD(field.part.start)])
        lengths = [_WORD(field.part.length)]
    shape_type = types.UniTuple(types.intp, field.kind.ndim)
    shape = context.make_tuple(builder, shape_type, lengths)
    signature = field.kind(types.CPointer(field.kind.dtype), shape_type)
    return np_cfarray(context, builder, signature, (address, shape))


def _load_word(builder, block, place, kind=_WORD):
    """Load a word that is never written."""
    pointer = builder.bitcast(builder.gep(block, [_WORD(place)]), kind.as_pointer())
    loaded = builder.load(pointer)
    loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
    return loaded
