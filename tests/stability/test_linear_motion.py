"""Motions near a cycle: where and when they are there, and what follows."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from disc_model.data.variables import Outcome
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.stability.cycle import find_cycle
from disc_model.stability.follower import (
    NearCycle,
    close_return,
    cycle_of_static_start,
    find_cycle_near,
)
from disc_model.stability.return_map import ReturnMap

pytestmark = pytest.mark.compiled


def near_start(p: Parameters) -> NearCycle:
    near = cycle_of_static_start(p)
    assert isinstance(near, NearCycle)
    return near


@pytest.mark.parametrize(
    ("N", "Omega", "waits"),
    [(50.0, 15.0, 0.0), (540.0, 24.5, 1.5), (584.5, 40.1, 6.0), (429.2966, 28.01568, 15.0)],
)
def test_a_motion_near_a_cycle_is_the_simulated_one_at_its_time(N, Omega, waits) -> None:
    """Also if it follows the cycle only after strongly damped modes have decayed."""
    near = near_start(Parameters(N=N, Omega=Omega))
    assert near.follows_cycle
    first = near.map.first_release.time
    assert near.time - first == pytest.approx(waits, abs=0.02)  # a period
    assert (near.time == first) == (waits == 0)
    # a picosecond before the release
    there = simulate(near.cycle.parameters, near.time - 1e-12, tol=1e-13).final_state
    x = near.map.point(there)
    # a motion that grows at 0.3/s keeps what a tolerance of 1e-13 leaves, and a picosecond moves it
    apart = np.linalg.norm(x - near.x - near.distance)
    assert apart < 1e-8 * near.map.deflection


def test_a_cycle_near_a_later_release_has_the_time_of_that_release() -> None:
    p = Parameters(N=50, Omega=15, c=0.1)
    map_ = ReturnMap(p)
    end = simulate(p, 40.0).final_state
    release = map_.next_release(end)
    run = simulate(p, 40.1, initial_state=end, tol=1e-13)
    wanted = run.events["time"][run.events["kind"] == "stick_to_slip"].iloc[0]
    assert release.time == pytest.approx(wanted, abs=1e-9)
    near = find_cycle_near(map_, release, *close_return(map_, release.x))
    assert near is not None
    assert near.follows_cycle
    assert near.time >= release.time
    assert near.kind is Outcome.STICK_SLIP


def test_a_release_in_contact_is_no_release_after_a_loss_of_contact() -> None:
    """A motion about to separate came to the section, and was then tested as if it had not."""
    p = Parameters(N=385, Omega=15.1)
    late = simulate(p, 60.0)
    assert late.events["kind"].eq("separation").any()
    strict = ReturnMap(p)
    patient = ReturnMap(p, patient=True)
    in_contact = []
    for i in range(1, 16):
        run = simulate(p, 60.0 + i * 1e-3, initial_state=late.final_state)
        in_contact.append(strict.next_release(run.final_state).reached)
        assert patient.next_release(run.final_state).reached
    assert not all(in_contact)


def test_a_start_that_never_sticks_is_near_no_cycle() -> None:
    """The damper pulls it loose at once: its spring never has what a release needs."""
    p = Parameters(N=200, Omega=20, c_p=45.0)
    near = cycle_of_static_start(p)
    assert not isinstance(near, NearCycle)
    assert near.status == find_cycle(p).status == "no_stick_slip"


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ([0.4, 0.3, 0.001, 0.4, 0.3, 0.0009], (0.001, 3)),  # about as close, and earlier
        ([0.4, 0.3, 0.01, 0.4, 0.3, 0.0009], (0.0009, 6)),
        ([0.4, 0.3], (0.4, 1)),
        ([], (math.nan, 0)),
    ],
)
def test_the_first_return_that_is_nearly_the_closest_counts(
    changes: list[float], expected: tuple[float, int]
) -> None:
    start = np.array([1.0, -1.0])
    later = [start + np.array([change, 0.0]) for change in changes]
    map_ = SimpleNamespace(
        returns=lambda *_, **__: later,
        patient=False,
        apart=lambda x, y: float(np.linalg.norm(x - y)),
    )
    assert close_return(map_, start) == pytest.approx(expected, nan_ok=True)
