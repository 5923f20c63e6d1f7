"""Eight doubles side by side, called lanes: the one vector type of the engine.

A value is an LLVM ``<8 x double>``: one register with AVX-512; elsewhere LLVM splits it.  Numba has
no such type, and arrays of accumulators stay in memory, which costs a factor of six in the
convolutions of the slip series.  Lanes are added, subtracted and multiplied by ``+``, ``-`` and
``*``, also with a number, which then stands in every lane; a product that is added to something is
rounded once where the processor can (see `jit`).  With ``NUMBA_DISABLE_JIT=1`` the same names are
plain numpy functions: every kernel runs unchanged without compilation.
"""

import functools
import operator
from typing import Any

import llvmlite.binding as llvm
import numba
import numpy as np
from numba.core.registry import cpu_target

WIDTH = 8

_SUM = "define <8 x double> @f(<8 x double> %a, <8 x double> %b) { %c = fadd <8 x double> %a, %b ret <8 x double> %c }"
_MACHINE: Any = cpu_target.target_context.codegen()._tm
ONE_REGISTER = "zmm" in _MACHINE.emit_assembly(
    llvm.parse_assembly(_SUM)
)  # whether eight doubles fit into one


def aligned(n):
    """Zeros, shape (n,), on a cache line: lanes that straddle two lines load and store at half the
    speed."""
    line = 64
    raw = np.zeros(n + line // 8)
    skip = -raw.ctypes.data % line // 8
    return raw[skip : skip + n]


if getattr(numba.config, "DISABLE_JIT"):  # noqa: B009 - the attribute is made at run time
    maximum = np.maximum
    minimum = np.minimum
    absolute = np.abs
    largest = np.max
    total = np.sum
    item = operator.getitem
    whole = operator.getitem
    put = operator.setitem

    def load(array, i):
        return array[i : i + WIDTH].copy()

    def store(array, i, v):
        array[i : i + WIDTH] = v

    def splat(x):
        return np.full(WIDTH, x)

    def spread(array, i):
        return np.full(WIDTH, array[i])

    def powers_of(x):
        return x ** np.arange(float(WIDTH))

    def swap_halves(v):
        return np.roll(v, WIDTH // 2)

    def swap_pairs(v):
        return v.reshape(-1, 2, 2)[:, ::-1].ravel()

    def swap_singles(v):
        return v.reshape(-1, 2)[:, ::-1].ravel()

    def low_halves(a, b):
        return np.concatenate((a[:4], b[:4]))

    def high_halves(a, b):
        return np.concatenate((a[4:], b[4:]))

else:
    from llvmlite import ir
    from numba import types
    from numba.core import cgutils
    from numba.core.typing.templates import AbstractTemplate, infer_global, signature
    from numba.extending import intrinsic, lower_builtin, models, register_model

    _DOUBLE = ir.DoubleType()
    _VECTOR = ir.VectorType(_DOUBLE, WIDTH)
    _I32 = ir.IntType(32)

    class LanesType(types.Type):
        def __init__(self):
            super().__init__(name="Float64x8")

    LANES = LanesType()

    @register_model(LanesType)
    class _LanesModel(models.PrimitiveModel):
        def __init__(self, dmm, fe_type):
            super().__init__(dmm, fe_type, _VECTOR)

    def _operator(symbol, write):
        """Let kernels apply an operator to two lanes, or to lanes and a number."""

        class Operator(AbstractTemplate):
            def generic(self, args, kws):
                known = all(kind in (LANES, types.float64) for kind in args)
                return signature(LANES, *args) if known and LANES in args else None

        def lower(context, builder, sig, args):
            operands = [
                value if kind == LANES else _copies(builder, value)
                for kind, value in zip(sig.args, args, strict=True)
            ]
            return write(builder, *operands)

        infer_global(symbol)(Operator)
        for kinds in ((LANES, LANES), (LANES, types.float64), (types.float64, LANES)):
            lower_builtin(symbol, *kinds)(lower)

    def _instruction(result, *arguments):
        """Let kernels call a function that writes LLVM code; types: None for an array, whose
        address it receives."""

        def made(write):
            @intrinsic
            @functools.wraps(write)  # numba reads the names of the arguments
            def instruction(typingctx, *given):
                def codegen(context, builder, sig, args):
                    values = [
                        context.make_array(kind)(context, builder, value).data
                        if stated is None
                        else value
                        for stated, kind, value in zip(arguments, sig.args, args, strict=True)
                    ]
                    written = write(builder, *values)
                    return context.get_dummy_value() if result == types.void else written

                return result(
                    *(stated or kind for stated, kind in zip(arguments, given, strict=True))
                ), codegen

            return instruction

        return made

    def _block(builder, array, i):
        """Pointer to the lanes that begin at an element."""
        return builder.bitcast(builder.gep(array, [i]), _VECTOR.as_pointer())

    def _call(builder, name, *args):
        """Call one of LLVM's functions on vectors of equal length."""
        signature = ir.FunctionType(args[0].type, [a.type for a in args])
        name = f"llvm.{name}.v{args[0].type.count}f64"
        return builder.call(cgutils.get_or_insert_function(builder.module, signature, name), args)

    def _larger(builder, a, b):
        return _call(builder, "maxnum", a, b)

    def _shuffle(builder, v, indices, second=None):
        """Entries of a vector, or of two: those of the second follow those of the first."""
        mask = ir.Constant(ir.VectorType(_I32, len(indices)), indices)
        return builder.shuffle_vector(
            v, ir.Constant(v.type, ir.Undefined) if second is None else second, mask
        )

    def _copies(builder, x):
        first = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), x, _I32(0))
        return _shuffle(builder, first, [0] * WIDTH)

    def _fold(builder, v, instruction):
        """Combine halves until one lane is left."""
        n = v.type.count
        while n > 1:
            n //= 2
            low = _shuffle(builder, v, list(range(n)))
            high = _shuffle(builder, v, list(range(n, 2 * n)))
            v = instruction(builder, low, high)
        return builder.extract_element(v, _I32(0))

    @_instruction(LANES, None, types.intp)
    def load(builder, array, i):
        return builder.load(_block(builder, array, i), align=8)

    @_instruction(types.void, None, types.intp, LANES)
    def store(builder, array, i, v):
        builder.store(v, _block(builder, array, i), align=8)

    @_instruction(LANES, types.float64)
    def splat(builder, x):
        """All lanes equal to x."""
        return _copies(builder, x)

    @_instruction(LANES, None, types.intp)
    def spread(builder, array, i):
        """All lanes equal to array[i], i >= 0: no check of the sign, unlike ``splat(array[i])``."""
        return _copies(builder, builder.load(builder.gep(array, [i])))

    @_instruction(types.float64, None, types.intp)
    def item(builder, array, i):
        """array[i], i >= 0: no check of the sign, which took a third of the time where a loop
        counts down."""
        return builder.load(builder.gep(array, [i]))

    @_instruction(types.intp, None, types.intp)
    def whole(builder, array, i):
        """array[i] of whole numbers, i >= 0: no check of the sign."""
        return builder.load(builder.gep(array, [i]))

    @_instruction(types.void, None, types.intp, types.float64)
    def put(builder, array, i, x):
        """array[i] = x, i >= 0: no check of the sign."""
        builder.store(x, builder.gep(array, [i]))

    @_instruction(LANES, types.float64)
    def powers_of(builder, x):
        square = builder.fmul(x, x)
        fourth = builder.fmul(square, square)
        powers = ones = ir.Constant(_VECTOR, [1.0] * WIDTH)
        for bit, power in enumerate((x, square, fourth)):
            chosen = [lane + WIDTH * (lane >> bit & 1) for lane in range(WIDTH)]
            powers = builder.fmul(powers, _shuffle(builder, ones, chosen, _copies(builder, power)))
        return powers

    _operator(operator.add, ir.IRBuilder.fadd)
    _operator(operator.sub, ir.IRBuilder.fsub)
    _operator(operator.mul, ir.IRBuilder.fmul)

    def _of_two(write):
        # not `write` itself: numba counts arguments by their names, and those of llvmlite have a
        # `name` as well
        return _instruction(LANES, LANES, LANES)(lambda builder, a, b: write(builder, a, b))

    maximum = _of_two(_larger)
    minimum = _of_two(lambda builder, a, b: _call(builder, "minnum", a, b))
    low_halves = _of_two(lambda builder, a, b: _shuffle(builder, a, [0, 1, 2, 3, 8, 9, 10, 11], b))
    high_halves = _of_two(
        lambda builder, a, b: _shuffle(builder, a, [4, 5, 6, 7, 12, 13, 14, 15], b)
    )

    swap_halves = _instruction(LANES, LANES)(
        lambda builder, v: _shuffle(builder, v, [4, 5, 6, 7, 0, 1, 2, 3])
    )
    swap_pairs = _instruction(LANES, LANES)(
        lambda builder, v: _shuffle(builder, v, [2, 3, 0, 1, 6, 7, 4, 5])
    )
    swap_singles = _instruction(LANES, LANES)(
        lambda builder, v: _shuffle(builder, v, [1, 0, 3, 2, 5, 4, 7, 6])
    )
    absolute = _instruction(LANES, LANES)(lambda builder, v: _call(builder, "fabs", v))
    total = _instruction(types.float64, LANES)(
        lambda builder, v: _fold(builder, v, ir.IRBuilder.fadd)
    )
    largest = _instruction(types.float64, LANES)(lambda builder, v: _fold(builder, v, _larger))
