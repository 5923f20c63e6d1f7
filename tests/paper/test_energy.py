"""The balance of powers: contact passes on what the slope supplies, and impacts take it."""

import numpy as np
import pytest

from disc_model.parameters import Parameters
from workflow.paper.energy import Powers, at_range, in_the_end, power_history
from workflow.paper.measures import Absent

pytestmark = pytest.mark.compiled

GROWS = Parameters(N=385, Omega=15.1)
"""Separates after 54 s."""
SETTLES = Parameters(N=600, Omega=25, c=0.2)
"""The slider's damper takes nearly all."""


@pytest.mark.parametrize("p", [GROWS, SETTLES])
def test_while_contact_lasts_what_the_slope_supplies_is_damped_or_gained(p: Parameters) -> None:
    # of the whole time: the two hundred samples of a stage say little of powers that change their
    # sign, and 12,000 at random phases of the swing leave half a per cent
    whole = Powers(*np.mean(power_history(p, 30.0), axis=0).tolist())
    assert whole.impacts == pytest.approx(0, abs=0.01 * whole.supplied)
    assert whole.pulls == 0  # the contact force does not change its sign
    if p is GROWS:
        assert whole.gained > 0.7 * whole.supplied
    else:
        assert whole.gained < 0.05 * whole.supplied


def test_in_the_end_impacts_take_what_damping_does_not() -> None:
    """Contact is first lost at 11 s."""
    p = Parameters(N=800, Omega=40, n_diameters=2)
    end = in_the_end(power_history(p, 60.0))
    assert end.gained == pytest.approx(0, abs=0.01 * end.supplied)
    assert end.impacts > 5 * end.damped > 0


def test_a_growing_motion_is_met_where_its_range_has_a_width() -> None:
    """Its growth within an instant is small."""
    history = power_history(GROWS, 30.0)
    found = at_range(GROWS, 30.0, 8e-3, history)
    # the mean of instants within 5 %, on both sides of the width
    assert found.width == pytest.approx(8e-3, rel=0.02)
    # what is supplied is damped or gained, as 2000 samples an instant tell to some per cent
    assert found.supplied == pytest.approx(found.damped + found.gained, rel=0.05)
    assert found.gained > found.damped > 0
    with pytest.raises(Absent, match=r"maintained contact comes to [\d.]+ mm only"):
        at_range(GROWS, 30.0, 0.1, history)
