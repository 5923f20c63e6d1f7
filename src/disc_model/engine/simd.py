"""Eight doubles side by side: the one vector type of the engine.

A value of type ``Lanes`` is an LLVM ``<8 x double>``; on a machine with AVX-512 it is one register, elsewhere
LLVM splits it.  Numba has no such type, and arrays of accumulators stay in memory, which costs a factor of six
in the convolutions of the slip series.  With ``NUMBA_DISABLE_JIT=1`` the same names are plain numpy functions,
so that every kernel runs unchanged without compilation.

Pairs of diametral modes fill a block of eight lanes as (a, a, a, a, b, b, b, b), so ``swap_halves`` exchanges
the two members of each pair.
"""

from typing import Any

import llvmlite.binding as llvm
import numba
import numpy as np

WIDTH = 8

_SETTINGS: Any = numba.config


def in_one_register():
    """Whether eight doubles fit into one register of the target processor, according to LLVM."""
    add = (
        "define <8 x double> @f(<8 x double> %a, <8 x double> %b) { %c = fadd <8 x double> %a, %b ret <8 x double> %c }"
    )
    cpu, features = _SETTINGS.CPU_NAME or llvm.get_host_cpu_name(), _SETTINGS.CPU_FEATURES
    if features is None:
        features = llvm.get_host_cpu_features().flatten()
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    machine = llvm.Target.from_default_triple().create_target_machine(cpu=cpu, features=features)
    return "zmm" in machine.emit_assembly(llvm.parse_assembly(add))


ONE_REGISTER = in_one_register()


def aligned(n):
    """Zeros, shape (n,), on a cache line: lanes that straddle two lines load and store at half the speed."""
    line = 64
    raw = np.zeros(n + line // 8)
    skip = -raw.ctypes.data % line // 8
    return raw[skip : skip + n]


def aligned_pieces(*sizes):
    """Zeros of these sizes, all but the last whole blocks, cut from one array: aligning takes as long as ten cuts."""
    block, pieces, start = aligned(sum(sizes)), [], 0
    for size in sizes:
        pieces.append(block[start : start + size])
        start += size
    return pieces


if getattr(numba.config, "DISABLE_JIT"):  # noqa: B009 - the attribute is made at run time
    add, sub, mul = np.add, np.subtract, np.multiply
    maximum, minimum, absolute, largest = np.maximum, np.minimum, np.abs, np.max

    def load(array, i):
        return array[i : i + WIDTH].copy()

    def store(array, i, v):
        array[i : i + WIDTH] = v

    def splat(x):
        return np.full(WIDTH, x)

    def spread(array, i):
        return np.full(WIDTH, array[i])

    def item(array, i):
        return array[i]

    def put(array, i, x):
        array[i] = x

    def fma(a, b, c):
        return a * b + c

    def swap_halves(v):
        return np.concatenate((v[4:], v[:4]))

    def total(v):
        """Sum in the order of the compiled version."""
        w = v[:4] + v[4:]
        w = w[:2] + w[2:]
        return w[0] + w[1]

else:
    from llvmlite import ir
    from numba import types
    from numba.core import cgutils
    from numba.extending import intrinsic, models, register_model

    _DOUBLE = ir.DoubleType()
    _VECTOR = ir.VectorType(_DOUBLE, WIDTH)
    _I32 = ir.IntType(32)

    class LanesType(types.Type):
        """Numba type of eight doubles."""

        def __init__(self):
            super().__init__(name="Float64x8")

    LANES = LanesType()

    @register_model(LanesType)
    class _LanesModel(models.PrimitiveModel):
        def __init__(self, dmm, fe_type):
            super().__init__(dmm, fe_type, _VECTOR)

    def _element(context, builder, sig, args):
        """Pointer to the element of the array and the index that come first."""
        data = context.make_array(sig.args[0])(context, builder, args[0]).data
        return builder.gep(data, [args[1]])

    def _block(context, builder, sig, args):
        """Pointer to the lanes that begin there."""
        return builder.bitcast(_element(context, builder, sig, args), _VECTOR.as_pointer())

    def _call(builder, name, result, *args):
        """Call of an LLVM intrinsic by its mangled name."""
        signature = ir.FunctionType(result, [a.type for a in args])
        return builder.call(cgutils.get_or_insert_function(builder.module, signature, name), args)

    def _shuffle(builder, v, indices):
        mask = ir.Constant(ir.VectorType(_I32, len(indices)), indices)
        return builder.shuffle_vector(v, ir.Constant(v.type, ir.Undefined), mask)

    def _copies(builder, x):
        """All lanes equal to x."""
        one = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), x, _I32(0))
        return _shuffle(builder, one, [0] * WIDTH)

    def _fold(builder, v, instruction):
        """Combine halves until one lane is left."""
        n = v.type.count
        while n > 1:
            n //= 2
            low = _shuffle(builder, v, list(range(n)))
            high = _shuffle(builder, v, list(range(n, 2 * n)))
            v = instruction(builder, low, high)
        return builder.extract_element(v, _I32(0))

    @intrinsic
    def load(typingctx, array, i):
        """Lanes array[i:i+8]."""

        def codegen(context, builder, sig, args):
            return builder.load(_block(context, builder, sig, args), align=8)

        return LANES(array, types.intp), codegen

    @intrinsic
    def store(typingctx, array, i, v):
        """array[i:i+8] = v."""

        def codegen(context, builder, sig, args):
            builder.store(args[2], _block(context, builder, sig, args), align=8)
            return context.get_dummy_value()

        return types.void(array, types.intp, LANES), codegen

    @intrinsic
    def splat(typingctx, x):
        """All lanes equal to x."""

        def codegen(context, builder, sig, args):
            return _copies(builder, args[0])

        return LANES(types.float64), codegen

    @intrinsic
    def spread(typingctx, array, i):
        """All lanes equal to array[i], i >= 0: no check of the sign, unlike ``splat(array[i])``."""

        def codegen(context, builder, sig, args):
            return _copies(builder, builder.load(_element(context, builder, sig, args)))

        return LANES(array, types.intp), codegen

    @intrinsic
    def item(typingctx, array, i):
        """array[i], i >= 0: no check of the sign, which took a third of the time where a loop counts down."""

        def codegen(context, builder, sig, args):
            return builder.load(_element(context, builder, sig, args))

        return types.float64(array, types.intp), codegen

    @intrinsic
    def put(typingctx, array, i, x):
        """array[i] = x, i >= 0: no check of the sign."""

        def codegen(context, builder, sig, args):
            builder.store(args[2], _element(context, builder, sig, args))
            return context.get_dummy_value()

        return types.void(array, types.intp, types.float64), codegen

    @intrinsic
    def fma(typingctx, a, b, c):
        """a * b + c, lane by lane; rounded once where the processor can, since software takes 500 times as long."""

        def codegen(context, builder, sig, args):
            return _call(builder, "llvm.fmuladd.v8f64", _VECTOR, *args)

        return LANES(LANES, LANES, LANES), codegen

    def _lane_by_lane(instruction):
        """An instruction of LLVM applied to two values lane by lane."""

        @intrinsic
        def operation(typingctx, a, b):
            return LANES(LANES, LANES), lambda context, builder, sig, args: instruction(builder, *args)

        return operation

    mul = _lane_by_lane(ir.IRBuilder.fmul)
    add = _lane_by_lane(ir.IRBuilder.fadd)
    sub = _lane_by_lane(ir.IRBuilder.fsub)
    maximum = _lane_by_lane(lambda builder, a, b: _call(builder, "llvm.maxnum.v8f64", _VECTOR, a, b))
    minimum = _lane_by_lane(lambda builder, a, b: _call(builder, "llvm.minnum.v8f64", _VECTOR, a, b))

    @intrinsic
    def swap_halves(typingctx, v):
        """Lanes 4..7, then 0..3."""

        def codegen(context, builder, sig, args):
            return _shuffle(builder, args[0], [4, 5, 6, 7, 0, 1, 2, 3])

        return LANES(LANES), codegen

    @intrinsic
    def total(typingctx, v):
        """Sum of the lanes, by halves."""

        def codegen(context, builder, sig, args):
            return _fold(builder, args[0], ir.IRBuilder.fadd)

        return types.float64(LANES), codegen

    @intrinsic
    def absolute(typingctx, v):
        """Lane by lane modulus."""

        def codegen(context, builder, sig, args):
            return _call(builder, "llvm.fabs.v8f64", _VECTOR, *args)

        return LANES(LANES), codegen

    @intrinsic
    def largest(typingctx, v):
        """Largest lane."""

        def larger(builder, low, high):
            return _call(builder, f"llvm.maxnum.v{low.type.count}f64", low.type, low, high)

        return types.float64(LANES), lambda context, builder, sig, args: _fold(builder, args[0], larger)
