"""How helpers of kernels are compiled."""

from __future__ import annotations

import pytest

from disc_model.engine import stepping
from tests.engine.compiled import kernel


@kernel
def _share(error: float, scale: float) -> float:
    return stepping._relative(error, scale)  # type: ignore[no-any-return]


@pytest.mark.compiled
def test_a_helper_without_a_wrapper_refuses_a_call_from_python() -> None:
    # without the refusal the process would crash, after a kernel has had the helper compiled as well as before
    with pytest.raises(TypeError, match=r"_relative is called by kernels alone"):
        stepping._relative(1.0, 2.0)
    assert _share(1.0, 2.0) == 0.5
    with pytest.raises(TypeError, match=r"_relative is called by kernels alone"):
        stepping._relative(1.0, 2.0)
