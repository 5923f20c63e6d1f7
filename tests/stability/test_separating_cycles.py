"""Cycles that lose contact, with impacts: found, judged and followed, against simulations of the
same motions."""

import math

import numpy as np
import pytest

from disc_model import Parameters, floquet, simulate
from disc_model.data.variables import CycleStatus
from disc_model.simulation.states import State
from disc_model.stability.continuation import StepControl, continue_cycle
from disc_model.stability.cycle import FloquetResult, multipliers
from disc_model.stability.return_map import ReturnMap
from tests.stability.test_return_map import central_differences

pytestmark = pytest.mark.compiled

LOCKED = {
    "2 releases": (Parameters(N=385, Omega=15.1), 300.0, 2, 2),
    "damper": (Parameters(N=385, Omega=15.0, c_p=0.5), 200.0, 1, 2),
    "8 releases": (Parameters(N=200, Omega=15.0), 1300.0, 8, 59),
    # another law: a slope in the contact, an impact that changes the slider's speed
    "normal force": (Parameters(N=385, Omega=15.3, contact_force="normal"), 300.0, 1, 2),
}
"""Case, s after which the motion has settled, releases and separations of its period."""


def settled(p: Parameters, until: float, start: State | None = None) -> State:
    return simulate(p, until, initial_state=start).final_state


def releases_of(p: Parameters, start: State, duration: float) -> np.ndarray:
    """Times of the releases of stick, s."""
    events = simulate(p, start.time + duration, initial_state=start, tol=1e-12).events
    return events["time"].to_numpy()[events["kind"].to_numpy() == "stick_to_slip"]


# derivatives of a law take a minute to compile, and long cycles minutes to settle
PARAMS = [
    pytest.param(name, marks=() if name in ("2 releases", "damper") else pytest.mark.slow)
    for name in LOCKED
]


@pytest.fixture(scope="module", params=PARAMS)
def cycle(request: pytest.FixtureRequest) -> tuple[Parameters, State, FloquetResult, int]:
    """The case, a settled state of its motion, the cycle found from there, and how often that
    separates."""
    p, time, releases, separations = LOCKED[request.param]
    late = settled(p, time)
    return p, late, floquet(p, guess=late, releases=releases), separations


def test_the_cycle_closes(cycle) -> None:
    p, _, found, separations = cycle
    assert found.status is CycleStatus.OK
    assert found.separations == separations
    assert found.residual < 1e-10
    # followed by the engine alone, no map: modes end where they began
    end = simulate(
        p, found.period, initial_state=found.state.replace(time=0.0), tol=1e-12
    ).final_state
    for name in ("a", "b", "alpha", "beta"):
        one = getattr(found.state, name)
        other = getattr(end, name)
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-9 * np.max(np.abs(one)))


def test_its_period_is_the_simulated_motions(cycle) -> None:
    p, late, found, _ = cycle
    times = releases_of(p, late, 2.5 * found.period)
    # what the approach has left after a settling time of 30 and more times its own
    assert times[found.releases] - times[0] == pytest.approx(found.period, rel=0, abs=1e-8)


def test_its_multipliers_are_those_of_differences_of_the_map(cycle) -> None:
    p, _, found, _ = cycle
    map_ = ReturnMap(p, 1e-14, patient=True)
    x = map_.point(found.state)
    # a hundred times what keeps the order of switches, and far above the rounding of the orbit
    size = 1e-6 * float(np.linalg.norm(map_.static))
    jacobian = central_differences(map_, x, size, releases=found.releases)
    expected = multipliers(jacobian)
    apart = np.abs(found.multipliers[:, None] - expected[None, :])
    assert apart.min(axis=1).max() < 1e-5
    rate = math.log(abs(expected[0])) / found.period
    assert found.growth_rate == pytest.approx(rate, abs=1e-4)
    assert found.stable


def test_continuation_finds_the_simulated_motion_and_where_it_ends() -> None:
    """N = 385 N, two releases: up to 15.9717 rad/s, where a stop is grazed and left out."""
    p, time, *_ = LOCKED["2 releases"]
    late = settled(p, time)
    steps = StepControl(step=1e-2)
    branch = continue_cycle(
        p, "Omega", (14.0, 18.0), guess=late, releases=2, direction=1, steps=steps
    )
    end = float(branch.values[-1])
    assert end == pytest.approx(15.97174, abs=1e-4)
    assert branch.ended == "grazing"
    assert np.all(branch.growth_rate < 0)
    assert np.all(branch.separations == 2)
    # started a little beside the branch, motions come to it; a jump of the speed can lead elsewhere
    middle = int(np.argmin(np.abs(branch.values - 15.6)))
    for point, shift, found in ((middle, 0.0, True), (-1, -0.01, True), (-1, 0.01, False)):
        there = p.replace(Omega=float(branch.values[point]) + shift)
        x = ReturnMap(branch.case_at(point)).point(branch.state(point))
        direction = np.random.default_rng(0).normal(size=x.size) / np.sqrt(x.size)
        beside = x + 1e-3 * np.linalg.norm(x) * direction
        end_of_it = settled(there, 300.0, ReturnMap(there).state(beside))
        times = releases_of(there, end_of_it, 0.1)
        repeats = np.ptp(times[2:] - times[:-2]) < 1e-9
        assert repeats == found
        if shift == 0:
            period = times[2] - times[0]
            expected = branch.period[point]
            assert period == pytest.approx(expected, rel=0, abs=1e-9)


def test_a_branch_passes_a_grazing_at_which_the_map_is_continuous() -> None:
    """N = 385 N, one release: below 9.757 rad/s the cycle no longer separates."""
    p = Parameters(N=385, Omega=12)
    late = settled(p, 300.0, settled(p.replace(Omega=15.3), 100.0))
    branch = continue_cycle(p, "Omega", (9.0, 12.5), guess=late, direction=-1)
    assert branch.ended == "bound"
    [after] = np.flatnonzero(branch.kind == "grazing").tolist()
    assert np.all(branch.separations[: after + 1] == 1)
    assert not branch.separations[after + 1 :].any()
    # simulated some steps beside it, one cycle loses contact, and the other keeps it
    for i, separates in ((after - 3, True), (after + 4, False)):
        run = simulate(branch.case_at(i), branch.period[i], initial_state=branch.state(i))
        assert (run.statistics["n_separations"] > 0) == separates
