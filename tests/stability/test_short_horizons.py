"""Attractors of motions that are followed for a short time, in which a kick's transient has not ended."""

from typing import Any

import numpy as np
import pytest

from disc_model import Disc, Parameters, basins

PAD: dict[str, Any] = {"r_0": 0.1, "k": 1e6, "k_p": 1e6, "c_p": 50, "m": 0.5}
BRAKE = {**PAD, "mu_s": 0.45, "mu_k": 0.35, "N": 8000, "Omega": 10, "friction_offset": "surface"}
KICKED = 1000.0  # J, at which contact is lost before the slider slides steadily


@pytest.mark.compiled
def test_a_kick_that_ends_in_steady_sliding_does_not_separate_for_good() -> None:
    """Each start had an attractor of its own, with up to 21 separations a second, and a critical
    energy of 42 J."""
    case = Parameters(**BRAKE, disc=Disc.from_csv("config/discs/brake.csv"))
    found = basins(case, [KICKED], 2, horizon=4)
    assert (found["lost_contact"] == "yes").all()
    assert (found["kind"] == "steady_sliding").all()
    assert found["attractor_starts"].values.tolist() == [2] + [0] * 11
    assert found["attractor_range"].values[0] == 0
    assert found["separating_fraction"] == 0
    assert np.isnan(found["critical_energy"])
    assert np.isnan(found["critical_energy_sampled"])


@pytest.mark.compiled
def test_a_slow_departure_is_followed_until_contact_is_lost() -> None:
    """A drift that does not slow down was taken for an approach 10 s before contact was lost."""
    found = basins(Parameters(N=385, Omega=14), [0.1], 3, horizon=60)
    assert (found["kind"] == "separating").all()
    assert (found["lost_contact"] == "yes").all()
