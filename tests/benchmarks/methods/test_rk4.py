"""Fixed steps: how they end, where they blow up, what they miss."""

import numpy as np
import pytest

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.scenes import Verdict
from tests.benchmarks.methods.problems import judge, vector
from tests.references.printed import P, lively


def test_fixed_steps_end_as_they_must():
    _, y, modes, c = vector(lively("slip", 1))

    def run(t_end, h, max_steps, room=4, y=y):
        filled = (np.empty(room), np.empty(room, np.int64), np.zeros(2))
        return kernels.rk4_run(modes, c, kernels.SLIP, 1, y.copy(), t_end, h, max_steps, False, *filled)

    assert run(1e-4, 1e-5, 3)[0] == kernels.STEP_LIMIT
    assert run(1e-4, 1e-5, 99)[0] == kernels.FINISHED
    assert run(1.0, 0.5, 99)[0] == kernels.NON_FINITE
    assert run(0.02, 1e-5, 9999, room=0)[0] == kernels.STALLED


def test_a_loss_of_contact_within_a_step_is_seen():
    """Contact is lost for 25 us: ends of steps of 1e-5 s are within that time, and none of 4e-5 s is."""
    p = P.replace(N=19.48)
    _, y, modes, c = vector(lively("slip", 1, p), p)

    def lost(h):
        times, kinds = np.empty(4), np.empty(4, np.int64)
        kernels.rk4_run(modes, c, kernels.SLIP, 1, y.copy(), 1.5e-3, h, 999, True, times, kinds, np.zeros(2))
        assert kinds[0] == kernels.LOSS_OF_CONTACT
        return times[0]

    # steps of 4e-5 s leave an error of 1.5e-7 s
    assert lost(4e-5) == pytest.approx(lost(1e-5), abs=3e-7, rel=0)


@pytest.mark.compiled
def test_rk4_sees_dips_shorter_than_a_step_and_misses_what_is_far_shorter():
    """The shortest of the 131 separations takes 34 us: at step ends of 1e-4 s alone, two went unseen."""
    result, found = judge("RK4", "separating", 1e-4)
    assert (result.separations, found.verdict) == (131, Verdict.CONVERGED)
    assert judge("RK4", "separating", 4e-4)[1].verdict is Verdict.WRONG_EVENTS
