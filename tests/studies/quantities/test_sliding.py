"""Modes of steady sliding along a parameter."""

import numpy as np
import pytest

from disc_model import Parameters, steady_sliding
from disc_model.studies.quantities.sliding import Sliding
from disc_model.studies.quantity import Point
from tests.studies.conftest import computed

BASE = {"mu_s": 0.3, "mu_k": 0.2, "friction_decay": 2.0, "normalization": "orthonormal"}
FALLING = Parameters(N=385, Omega=15, **BASE)


def along(parameter: str, start: float, stop: float, p: Parameters) -> dict[str, np.ndarray]:
    scan = {"start": start, "stop": stop, "count": 3}
    values, message = Sliding(parameter=parameter, scan=scan).compute_point(Point(p))
    assert message == ""
    return values


def test_mu_s_rises_with_mu_k_only_where_that_would_be_larger() -> None:
    """Friction that falls with the speed depends on both, so that the motion does."""
    above = along("mu_k", 0.2, 0.5, FALLING)["largest_growth_rate"]
    for mu_k, rate in zip((0.2, 0.35, 0.5), above, strict=True):
        case = FALLING.replace(mu_k=mu_k, mu_s=max(mu_k, FALLING.mu_s))
        assert rate == steady_sliding(case).growth_rate
    below = along("mu_k", 0.1, 0.2, FALLING)["largest_growth_rate"]
    for mu_k, rate in zip((0.1, 0.15, 0.2), below, strict=True):
        assert rate == steady_sliding(FALLING.replace(mu_k=mu_k)).growth_rate
    # another parameter changes neither
    speeds = along("Omega", 10, 30, FALLING)
    for Omega, rate in zip((10, 20, 30), speeds["largest_growth_rate"], strict=True):
        assert rate == steady_sliding(FALLING.replace(Omega=Omega)).growth_rate


def test_columns_are_those_of_steady_sliding_at_each_value() -> None:
    values = along("Omega", 10, 50, FALLING)
    for i, Omega in enumerate((10, 30, 50)):
        sliding = steady_sliding(FALLING.replace(Omega=Omega))
        assert values["contact_force"][i] == sliding.contact_force
        assert values["unstable_modes"][i] == sliding.growing.size
        upper = sliding.eigenvalues[sliding.eigenvalues.imag > 0]
        there = np.isfinite(values["frequency"][i])
        assert sorted(2 * np.pi * values["frequency"][i][there]) == pytest.approx(
            sorted(upper.imag), rel=1e-10
        )
        growth = values["mode_growth_rate"][i][there]
        assert sorted(growth) == pytest.approx(sorted(upper.real), abs=1e-9)
        # of a mode of the angular frequency w that grows at g: -g / abs(g + i w)
        w = 2 * np.pi * values["frequency"][i][there]
        assert values["damping_ratio"][i][there] == pytest.approx(-growth / np.hypot(growth, w))


def test_where_there_is_no_sliding_the_message_says_at_which_value() -> None:
    scan = {"start": 0, "stop": 20, "count": 3}
    values, message = Sliding(scan=scan).compute_point(Point(FALLING))
    assert message.startswith("Omega = 0 rad/s: The disc is not driven")
    assert np.isnan(values["largest_growth_rate"][0])
    assert np.isfinite(values["largest_growth_rate"][1:]).all()


def test_modes_beyond_the_room_are_left_out_and_those_within_stay() -> None:
    scan = {"start": 10, "stop": 50, "count": 3}
    every, _ = Sliding(scan=scan).compute_point(Point(FALLING))
    options = {"scan": scan, "modes": 4}
    few = computed(quantity="sliding", options=options, base=BASE, axes={"N": [385]})
    few = few.isel(N=0)
    assert few["frequency"].shape == (3, 4)
    np.testing.assert_array_equal(few["frequency"], every["frequency"][:, :4])
    np.testing.assert_array_equal(few["mode_growth_rate"], every["mode_growth_rate"][:, :4])
    assert every["n_modes"] == few["n_modes"] == 10
    assert few["message"] == "10 were found along mode, which has room for 4: raise modes"
