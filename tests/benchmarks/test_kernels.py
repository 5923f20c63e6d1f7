"""Compiled conditions and switches, and the fixed steps on them."""

import numpy as np
import pytest

from disc_model.benchmarks.methods import kernels
from disc_model.benchmarks.methods.base import ENDS
from disc_model.benchmarks.methods.kernels import Physics
from disc_model.data.variables import PHASES
from tests.benchmarks.problems import vector
from tests.references.printed import MOTIONS, P, lively

BONDED = P.replace(contact="bilateral")


def switched(start, cause, p=P):
    """Phase, direction and kinds after a switch, and the state."""
    _, y, modes, c = vector(start, p)
    kinds = np.full(2, -1, np.int64)
    phase, direction, count = kernels.switch(modes, c, PHASES.index(start.phase), cause, y, kinds)
    return (PHASES[phase], direction, list(kinds[:count])), y


@pytest.mark.parametrize(("phase", "direction"), MOTIONS)
@pytest.mark.parametrize("p", [P, BONDED], ids=["unilateral", "bilateral"])
def test_nothing_is_violated_within_a_phase(p, phase, direction):
    _, y, modes, c = vector(lively(phase, direction, p), p)
    out = np.full(3, np.nan)
    count = kernels.switch_values(modes, c, PHASES.index(phase), direction, y, out)
    assert count == np.isfinite(out).sum() == ENDS[PHASES.index(phase)]
    assert kernels.violated(out, count) == -1


def test_violations_are_told_apart():
    def violated(start, **changes):
        physics, y, modes, c = vector(start)
        for name, value in changes.items():
            y[getattr(physics, name)] = value
        values = np.empty(3)
        count = kernels.switch_values(modes, c, PHASES.index(start.phase), start.direction, y, values)
        return kernels.violated(values, count)

    assert violated(lively("separation"), u=-1.0) == 0
    assert violated(lively("slip", 1), f=-1e-3) == 1
    assert violated(lively("stick"), psi=1.0) == 1
    assert violated(lively("stick"), psi=-1.0) == 2
    lifted = lively("slip", 1)
    assert violated(lifted.replace(a=lifted.a - 0.01 * np.sign(Physics(P).shape))) in (-1, 0)
    assert violated(lifted.replace(a=lifted.a + 0.01 * np.sign(Physics(P).shape))) == 0  # the disc pulls away


def test_at_rest_the_spring_decides():
    start = lively("slip", 1)
    assert switched(start.replace(psi=0.004), 1)[0] == ("stick", 0, [kernels.SLIP_TO_STICK])
    (after, y) = switched(start.replace(psi=-1.0), 1)
    assert after == ("slip", -1, [kernels.SLIP_REVERSAL])
    assert y[Physics(P).f] == 0
    assert switched(start.replace(psi=1.0), 1)[0] == ("slip", 1, [kernels.SLIP_REVERSAL])


def test_a_state_that_is_not_finite_is_no_event():
    start = lively("slip", 1)
    _, y, modes, c = vector(start.replace(psi=np.inf), P)
    phase, _, count = kernels.switch(modes, c, PHASES.index(start.phase), 1, y, np.zeros(2, np.int64))
    assert (PHASES[phase], count) == ("slip", -1)


@pytest.mark.parametrize("direction", [1, -1])
def test_after_an_impact_slip_goes_on_as_the_slider_did(direction):
    falling = lively("separation").replace(u_velocity=-1.0, f=30.0 * direction)
    assert switched(falling, 1)[0] == ("slip", direction, [kernels.REATTACHMENT])


def test_contact_that_would_pull_is_lost_at_once():
    """At rest, where stick breaks, and after an impact."""
    shape = Physics(P).shape
    start = lively("slip", 1)
    pulling = start.replace(a=start.a + 0.01 * np.sign(shape), psi=0.004)
    assert switched(pulling, 1)[0] == ("separation", 0, [kernels.LOSS_OF_CONTACT])
    assert switched(pulling, 1, BONDED)[0] == ("slip", 1, [kernels.SLIP_REVERSAL])
    falling = lively("separation").replace(u_velocity=-1.0)
    assert switched(falling, 0)[0][0] in ("slip", "separation")
    falling = falling.replace(a=falling.a + 0.01 * np.sign(shape))
    kinds = [kernels.REATTACHMENT, kernels.LOSS_OF_CONTACT]
    assert switched(falling, 0)[0] == ("separation", 0, kinds)
    (after, y) = switched(start, 0)
    assert after == ("separation", 0, [kernels.LOSS_OF_CONTACT])
    assert y[Physics(P).u] == pytest.approx(start.u, rel=1e-12)
    assert y[Physics(P).v] == pytest.approx(start.u_velocity, rel=1e-12)


def fixed_steps(y, case, limits, room=4):
    """What `kernels.rk4_run` returns of a slip forwards, and the times and kinds of events."""
    track = np.empty(room), np.empty(room, np.int64), np.zeros(2)
    return kernels.rk4_run(*case, kernels.SLIP, 1, y.copy(), limits, track), track


def test_fixed_steps_end_as_they_must():
    _, y, *case = vector(lively("slip", 1))
    for limits, room, why in (
        ((1e-4, 1e-5, 3, False), 4, kernels.STEP_LIMIT),
        ((1e-4, 1e-5, 99, False), 4, kernels.FINISHED),
        ((1.0, 0.5, 99, False), 4, kernels.NON_FINITE),
        ((0.02, 1e-5, 9999, False), 0, kernels.STALLED),
    ):
        assert fixed_steps(y, case, limits, room)[0][0] == why


def test_a_loss_of_contact_within_a_step_is_seen():
    """Contact is lost for 25 us: ends of steps of 1e-5 s are within that time, and none of 4e-5 s is."""
    p = P.replace(N=19.48)
    _, y, *case = vector(lively("slip", 1, p), p)

    def lost(h):
        _, (times, kinds, _) = fixed_steps(y, case, (1.5e-3, h, 999, True))
        assert kinds[0] == kernels.LOSS_OF_CONTACT
        return times[0]

    # steps of 4e-5 s leave an error of 1.5e-7 s
    assert lost(4e-5) == pytest.approx(lost(1e-5), abs=3e-7, rel=0)
