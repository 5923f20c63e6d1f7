"""The vector type: every operation against numpy."""

from __future__ import annotations

import llvmlite.binding as llvm
import numpy as np
import pytest

from disc_model.engine import lanes
from tests.engine.compiled import kernel


@kernel
def _arithmetic(a, b, c, out):
    x, y, z = lanes.load(a, 0), lanes.load(b, 0), lanes.load(c, 0)
    lanes.store(out, 0, lanes.fma(x, y, z))
    lanes.store(out, 8, lanes.sub(lanes.add(x, y), lanes.mul(y, z)))
    lanes.store(out, 16, lanes.swap_halves(x))
    lanes.store(out, 24, lanes.maximum(x, lanes.minimum(y, lanes.absolute(z))))
    lanes.store(out, 32, lanes.splat(lanes.total(x)))
    lanes.store(out, 40, lanes.splat(lanes.largest(x)))
    lanes.store(out, 48, lanes.spread(a, 3))
    lanes.store(out, 56, lanes.splat(lanes.item(a, 5)))
    lanes.put(out, 64, lanes.item(b, 2))


@pytest.fixture
def values() -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(7)
    return tuple(rng.normal(size=8) for _ in range(3))


def test_operations_agree_with_numpy(values: tuple[np.ndarray, ...]) -> None:
    a, b, c = values
    out = np.zeros(65)
    _arithmetic(a, b, c, out)
    rows = out[:64].reshape(8, 8)
    # one rounding more or less: fma rounds once, numpy twice
    close = {"rtol": 1e-15, "atol": 1e-15}
    np.testing.assert_allclose(rows[0], a * b + c, **close)
    np.testing.assert_allclose(rows[1], a + b - b * c, **close)
    np.testing.assert_array_equal(rows[2], np.roll(a, 4))
    np.testing.assert_array_equal(rows[3], np.maximum(a, np.minimum(b, np.abs(c))))
    np.testing.assert_allclose(rows[4], a.sum(), **close)
    np.testing.assert_array_equal(rows[5], a.max())
    np.testing.assert_array_equal(rows[6], a[3])
    np.testing.assert_array_equal(rows[7], a[5])
    assert out[64] == b[2]


@pytest.mark.skipif("x86" not in llvm.get_default_triple(), reason="the names are of such processors")
@pytest.mark.parametrize(("cpu", "features", "expected"), [("haswell", "", False), ("x86-64-v4", "", True),
                                                          ("haswell", "+avx512f", True)])  # fmt: skip
def test_what_fits_into_one_register_is_asked_of_the_compiler(cpu, features, expected, monkeypatch) -> None:
    monkeypatch.setattr(lanes._SETTINGS, "CPU_NAME", cpu)
    monkeypatch.setattr(lanes._SETTINGS, "CPU_FEATURES", features)
    assert lanes.in_one_register() is expected


def test_unaligned_lanes_are_loaded_and_stored_whole() -> None:
    a = np.arange(24.0)
    out = np.zeros(65)
    _arithmetic(a[3:11], a[5:13], a[1:9], out)
    np.testing.assert_array_equal(out[:8], a[3:11] * a[5:13] + a[1:9])
