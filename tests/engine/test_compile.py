"""How kernels, their helpers and what they are handed are compiled."""

import math
from typing import NamedTuple

import numpy as np
import pytest

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


@kernel
def _first(inner):  # type: ignore[no-untyped-def]
    return inner.numbers[0]


@pytest.mark.compiled
def test_an_array_with_gaps_is_not_packed() -> None:
    """Its address and lengths would not say where its numbers are."""
    with pytest.raises(ValueError, match="contiguous"):
        _first(Inner(np.zeros(4)[::2], 1.0))
