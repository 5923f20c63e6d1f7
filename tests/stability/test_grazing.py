"""What grazes: dips that miss a switch and dips that make it, on signals that are parabolas."""

import numpy as np
import pytest

from disc_model.stability.grazing import _nearest_dip, _shallowest

T = np.linspace(0.0, 1.0, 101)


def dipping(bottom: float, at: float = 0.503) -> tuple[np.ndarray, np.ndarray]:
    """A parabola whose lowest point lies between samples; watched as long as it is above 0."""
    values = bottom + 3 * (T - at) ** 2
    return values, (values > 0) & (np.cumsum(values < 0) == 0)


@pytest.mark.parametrize("bottom", [1e-6, 1e-2])
def test_a_dip_that_misses_is_as_high_as_its_parabola(bottom: float) -> None:
    values, during = dipping(bottom)
    assert _nearest_dip(values, during) == pytest.approx(bottom, rel=1e-9, abs=1e-15)
    assert _shallowest(values, during, np.zeros(0, int)) == np.inf


@pytest.mark.parametrize("depth", [1e-3, 1e-2])
def test_a_dip_that_makes_the_switch_goes_as_deep_as_its_parabola(depth: float) -> None:
    values, during = dipping(-depth)
    ended = np.array([np.flatnonzero(~during)[0]])
    assert _shallowest(values, during, ended) == pytest.approx(depth, rel=1e-9)
    assert _nearest_dip(values, during) == np.inf


def test_what_falls_to_zero_ever_faster_does_not_graze() -> None:
    values = 0.25 - (T - 0.1) ** 2
    assert _shallowest(values, values > 0, np.array([np.flatnonzero((values <= 0) & (T > 0.1))[0]])) == np.inf
    assert _nearest_dip(values, values > 0) == np.inf


def test_a_dip_at_the_edge_of_what_is_watched_is_none() -> None:
    values, _ = dipping(1e-3)
    assert _nearest_dip(values, T < 0.5) == np.inf
    assert _nearest_dip(values, T > 0.51) == np.inf
