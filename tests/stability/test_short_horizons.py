"""Attractors of motions that are followed for a short time, in which a kick's transient has not ended."""

from typing import Any

import numpy as np
import pytest

from disc_model import Disc, Parameters, basins
from disc_model.data.variables import Outcome
from disc_model.stability.follower import Attractor
from tests.stability.test_attractor import basins_without_motions, stretch

PAD: dict[str, Any] = {"r_0": 0.1, "k": 1e6, "k_p": 1e6, "c_p": 50, "m": 0.5}
BRAKE = {**PAD, "mu_s": 0.45, "mu_k": 0.35, "N": 8000, "Omega": 10, "friction_offset": "surface"}
KICKED = 1000.0  # J, at which contact is lost before the slider slides steadily
LOSES = stretch(separation_rate=15.0)
SLIDES = stretch(separation_rate=0.0, u_max=1e-5)


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


@pytest.mark.parametrize(
    ("first", "second", "same"),
    [
        ((Outcome.STEADY_SLIDING, LOSES), (Outcome.STEADY_SLIDING, SLIDES), True),
        ((Outcome.AT_REST, LOSES), (Outcome.AT_REST, SLIDES), True),
        ((Outcome.AT_REST, SLIDES), (Outcome.STEADY_SLIDING, SLIDES), False),
        ((Outcome.STEADY_SLIDING, SLIDES), (Outcome.STICK_SLIP, SLIDES), False),
        ((Outcome.UNDECIDED, SLIDES), (Outcome.STEADY_SLIDING, SLIDES), True),
        ((Outcome.UNDECIDED, LOSES), (Outcome.STEADY_SLIDING, SLIDES), False),
    ],
)
def test_an_equilibrium_is_one_attractor_whatever_came_before(
    first: tuple[Outcome, Any], second: tuple[Outcome, Any], same: bool
) -> None:
    known = basins_without_motions()
    assert known._same(Attractor(*first), Attractor(*second)) is same
    assert known._same(Attractor(*second), Attractor(*first)) is same
