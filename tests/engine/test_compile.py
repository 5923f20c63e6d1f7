"""How kernels, their helpers and what they are handed are compiled."""

from typing import NamedTuple

import numpy as np
import pytest

from disc_model.engine.jit.packing import packed
from tests.engine.compiled import kernel


@packed
class Inner(NamedTuple):
    numbers: np.ndarray
    factor: float


@kernel
def _first(inner):  # type: ignore[no-untyped-def]
    return inner.numbers[0]


@pytest.mark.compiled
def test_an_array_with_gaps_is_not_packed() -> None:
    """Its address and lengths would not say where its numbers are."""
    with pytest.raises(ValueError, match="contiguous"):
        _first(Inner(np.zeros(4)[::2], 1.0))
