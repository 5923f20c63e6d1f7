"""What stability functions take for a number. Texts of what they refuse are in tests/studies/messages.json."""

import numba
import numpy as np
import pytest

from disc_model import Parameters, floquet
from disc_model.engine import variational
from disc_model.stability.return_map import ReturnMap

P = Parameters(N=200, Omega=20, n_diameters=1)


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
def test_the_return_map_is_compiled_for_doubles_alone() -> None:
    """Numbers of another type had all of it compiled for them, and rounded in other ways."""
    usual = ReturnMap(P, 2.0**-30)
    flight = usual.evaluate(usual.static)
    compiled = len(variational._flight.signatures)
    odd = ReturnMap(P, np.float32(2.0**-30))
    static = np.repeat(usual.static, 2)[::2]
    static.setflags(write=False)
    again = odd.evaluate(static, releases=np.int8(1))
    assert len(variational._flight.signatures) == compiled
    np.testing.assert_equal(vars(again), vars(flight))
    assert floquet(P, releases=np.int64(1)).period == floquet(P).period
