"""The whole disc's deflection: against the engine's own samples at one point, and the plate's
clamp."""

import numpy as np
import pytest

from disc_model import Parameters, Window, deflection, simulate, snapshots

P = Parameters(N=200, Omega=20)


@pytest.fixture(scope="module", params=["as_published", "orthonormal"])
def p(request: pytest.FixtureRequest) -> Parameters:
    return P.replace(normalization=request.param)


def test_it_is_what_the_engine_samples_at_a_point_fixed_to_the_disc(p: Parameters) -> None:
    times = np.array([0.0, 0.013, 0.05, 0.2])
    states = snapshots(p, times)
    w = deflection(p, states, p.r_0, [0.0, 1.0])
    assert w.dims == ("time", "r", "theta")
    assert w.attrs["units"] == "m"
    assert np.array_equal(w["time"], times)
    windows = {
        str(theta): Window(start=0, stop=0.2, rate=1000, theta=theta) for theta in (0.0, 1.0)
    }
    sampled = simulate(p, 0.2, windows).samples
    for i, samples in enumerate(sampled.values()):
        there = np.searchsorted(samples["time"], times - 1e-9)
        # pieces of a run and one whole run differ by their truncation error, 1e-10 of the motion a
        # step
        assert np.allclose(
            w[:, 0, i], samples["w_point"][there], atol=1e-9 * np.abs(samples["w_point"]).max()
        )


def test_the_static_disc_is_lowest_under_the_slider(p: Parameters) -> None:
    (start,) = snapshots(p, 0.0)
    theta = np.linspace(-np.pi, np.pi, 181)
    w = deflection(p, start, [p.a, p.r_0], theta)
    assert float(w.isel(r=1)[0, 90]) == pytest.approx(start.u, rel=1e-12)
    assert np.allclose(w.isel(r=0), 0, atol=1e-9 * abs(start.u))
    assert np.allclose(w.isel(r=1), w.isel(r=1, theta=slice(None, None, -1)).values, atol=1e-15)
