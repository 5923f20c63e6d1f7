"""How kernels, their helpers and what they are handed are compiled."""

import gc
import math
from typing import NamedTuple

import llvmlite.binding as llvm
import numba
import numpy as np
import pytest

from disc_model.engine.jit import helper, inlined, simd
from disc_model.engine.jit.packing import packed
from tests.engine.compiled import kernel


@packed
class Inner(NamedTuple):
    numbers: np.ndarray
    factor: float


@packed
class Outer(NamedTuple):
    table: np.ndarray
    counts: np.ndarray
    count: int
    below: int
    holds: bool
    not_a_number: float
    no: tuple[bool, ...]
    yes: tuple[bool, ...]
    inner: Inner


@kernel
def _entries(outer, out):  # type: ignore[no-untyped-def]
    out[0], out[1] = outer.table[1, 2], outer.table.shape[1]
    out[2], out[3] = outer.counts[-1], len(outer.counts)
    out[4], out[5], out[6] = outer.count, outer.below, 1.0 if outer.holds else 0.0
    out[7], out[8], out[9], out[10] = outer.not_a_number, len(outer.no), outer.yes[0], 1.0 if outer.yes else 0.0
    out[11], out[12] = outer.inner.numbers[0] * outer.inner.factor, outer.inner.numbers.sum()
    outer.counts[0] = 9


def test_kernels_read_every_entry_of_a_packed_tuple_and_write_into_its_arrays() -> None:
    counts, out = np.array([4, 5, 6]), np.zeros(13)
    inner = Inner(np.array([3.0, 4.0]), 0.5)
    outer = Outer(np.arange(6.0).reshape(2, 3), counts, 2**40, -7, True, math.nan, (), (True,), inner)
    _entries(outer, out)
    np.testing.assert_array_equal(out, [5.0, 3.0, 6.0, 3.0, 2.0**40, -7.0, 1.0, math.nan, 0.0, 1.0, 1.0, 1.5, 7.0])
    assert counts[0] == 9
    _entries(outer._replace(inner=inner._replace(factor=2.0), holds=False), out)
    assert (out[6], out[11]) == (0.0, 6.0)


@helper
def _total(outer):  # type: ignore[no-untyped-def]
    return outer.inner.factor + (9.0 if outer.yes else 8.0)


@helper
def _longer(outer):  # type: ignore[no-untyped-def]
    return _total(outer) + len(outer.no)


@kernel
def _with_flags(outer):  # type: ignore[no-untyped-def]
    return _longer(outer)


@pytest.mark.compiled
def test_a_helper_is_compiled_once_for_all_flags_that_it_does_not_read() -> None:
    inner = Inner(np.zeros(1), 0.5)
    outer = Outer(np.zeros((2, 3)), np.zeros(3, int), 4, -7, True, 1.0, (), (True,), inner)
    assert [_with_flags(outer._replace(no=flag)) for flag in ((), (True,))] == [9.5, 10.5]
    assert (len(_total.overloads), len(_longer.overloads)) == (1, 2)  # type: ignore[attr-defined]


@helper
def _third(x):  # type: ignore[no-untyped-def]
    return x / 3.0


@inlined
def _thirds(x):  # type: ignore[no-untyped-def]
    return 2.0 * _third(x)


@kernel
def _with_thirds(x):  # type: ignore[no-untyped-def]
    return _thirds(x)


@pytest.mark.compiled
def test_helpers_of_inlined_helpers_are_not_forced_into_them() -> None:
    """Numba hands that order on: the engine became one function, and LLVM took three times as long."""
    assert _with_thirds(6.0) == 4.0
    forced = [
        any("alwaysinline" in made.library.get_llvm_str() for made in part.overloads.values())
        for part in (_third, _thirds)
    ]
    assert forced == [False, True]


@pytest.mark.compiled
def test_garbage_is_collected_after_a_compilation_that_fails() -> None:
    with pytest.raises(numba.TypingError):
        _with_thirds("six")
    assert gc.isenabled()


@kernel
def _first(inner):  # type: ignore[no-untyped-def]
    return inner.numbers[0]


@pytest.mark.compiled
def test_an_array_with_gaps_is_not_packed() -> None:
    """Its address and lengths would not say where its numbers are."""
    with pytest.raises(ValueError, match="contiguous"):
        _first(Inner(np.zeros(4)[::2], 1.0))


@pytest.mark.skipif("x86" not in llvm.get_default_triple(), reason="the names are of such processors")
@pytest.mark.parametrize(("cpu", "features", "expected"), [("haswell", "", False), ("x86-64-v4", "", True),
                                                          ("haswell", "+avx512f", True)])  # fmt: skip
def test_what_fits_into_one_register_is_asked_of_the_compiler(cpu, features, expected, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.setattr(numba.core.config, "CPU_NAME", cpu)
    monkeypatch.setattr(numba.core.config, "CPU_FEATURES", features)
    assert simd.in_one_register() is expected
