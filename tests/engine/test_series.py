"""The fast series against its plain twin, for one and for several blocks of lanes."""

from __future__ import annotations

import numpy as np
import pytest

from disc_model import Parameters
from disc_model.engine import layout, series
from disc_model.simulation.result import engine_case
from tests.references import plain

ORDER = 23
SHAPES = {
    "base": {},
    "two blocks": {"n_diameters": 7, "n_circles": 1, "c": 0.3, "c_p": 0.4},
    "many blocks": {"n_diameters": 4, "n_circles": 9},
    "no pairs": {"n_diameters": 0},
    "one pair": {"n_diameters": 1, "c_p": 0.2},
}


def _filled(model: layout.Model, phase: str, order: int) -> layout.Series:
    """A series whose coefficients 0 are a lively state."""
    s = layout.build_series(model, order)
    rng = np.random.default_rng(1)
    width, n0 = len(model.shift), len(model.force0)
    used = model.stiffness > 0
    s.z[:width] = (1e-3 * rng.normal(size=width)) * used
    s.e[:width] = rng.normal(size=width) * used
    s.y[:n0], s.g[:n0] = 1e-3 * rng.normal(size=n0), rng.normal(size=n0)
    s.psi[0], s.f[0] = 0.03, 0.0 if phase == "stick" else -12.3
    s.u[0], s.v[0] = model.u_0 + 1e-3, 0.2
    return s


@pytest.mark.parametrize("phase", ["slip", "stick", "separation"])
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("order", [8, ORDER, ORDER + 1])
def test_fast_and_plain_series_agree(shape: str, phase: str, order: int) -> None:
    model = engine_case(Parameters(N=385, Omega=15.1, **SHAPES[shape])).model
    fast, slow = _filled(model, phase, order), _filled(model, phase, order)
    if phase == "slip":
        denominator = plain.slip_series(model, slow, order, -1.0)
        assert series.slip_series(model, fast, order, -1.0) == pytest.approx(denominator, rel=1e-14)
    else:
        getattr(series, f"{phase}_series")(model, fast, order)
        getattr(plain, f"{phase}_series")(model, slow, order)
    width = len(model.shift)
    for name in ("z", "e", "f", "psi", "u", "v", "P", "switch", *(("switch2",) if phase == "stick" else ())):
        columns = width if name in ("z", "e") else 1
        degree = order if name in ("P", *(("switch", "switch2") if phase == "stick" else ())) else order + 1
        got = getattr(fast, name)[: degree * columns].reshape(degree, columns)
        expected = getattr(slow, name)[: degree * columns].reshape(degree, columns)
        # each order's error is measured by the largest coefficient of the order; sums of 23 terms of either sign in
        # another order, and quantities that cancel (F - mu_k P / r_0), lose up to five digits
        scale = np.maximum(np.abs(expected).max(axis=1, keepdims=True), 1e-300)
        assert np.max(np.abs(got - expected) / scale) < 1e-10, name
    n0 = len(model.force0)
    for name in ("y", "g"):
        degree = (order + 1) * n0
        np.testing.assert_allclose(getattr(fast, name)[:degree], getattr(slow, name)[:degree], rtol=1e-10, atol=1e-300)
