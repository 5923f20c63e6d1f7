"""The stick-slip cycle: its multipliers, its status, what is stable."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from disc_model import Parameters, floquet, simulate, steady_sliding, sweep
from disc_model.data.variables import CycleStatus, Outcome
from disc_model.errors import DiscModelError
from disc_model.stability.cycle import CycleError, cycle_of, find_cycle, run_through_once
from disc_model.stability.follower import find_cycle_near
from disc_model.stability.return_map import RETURNED, Counts, Orbit, Passage, ReturnMap
from tests.stability.test_return_map import BASE, DAMPED, central_differences
from tests.validation.test_random_cases import drawn_case

P = Parameters(N=200, Omega=20, n_diameters=1)


@pytest.mark.parametrize("tol", [1e-6, 1e-8])
def test_a_rough_tolerance_finds_the_cycle(tol: float) -> None:
    """Flights as rough as the residual asked for scattered too much to reach it: no cycle was
    found, of any case."""
    found = floquet(P, tol=tol)
    fine = floquet(P)
    assert found.status is CycleStatus.OK
    assert found.residual <= tol
    # a point off by tol has a multiplier off by about tol, and a period is 0.01 s
    assert found.growth_rate == pytest.approx(fine.growth_rate, abs=100 * tol)


COMPILED = pytest.mark.compiled
CASES = {
    "small": (P, ()),
    "base": (BASE, COMPILED),
    "damped": (DAMPED, COMPILED),
    "soft spring": (Parameters(N=300, Omega=50, k_p=2e3), COMPILED),
    "orthonormal": (Parameters(N=600, Omega=30, normalization="orthonormal"), COMPILED),
    # its springs together are faster than the stiffest of them: 2e-7 if only the stiffest sets the
    # longest step
    "springs": (
        P.replace(N=20, m=0.03, k=5e5, normalization="orthonormal", contact_compliance=3.6e-6),
        COMPILED,
    ),
    # half a minute to compile
    "two blocks": (Parameters(N=200, Omega=20, n_diameters=6), (COMPILED, pytest.mark.slow)),
    "axisymmetric": (Parameters(N=200, Omega=20, n_diameters=0), COMPILED),
    "bonded": (Parameters(N=200, Omega=20, contact="bilateral"), COMPILED),
}


@pytest.mark.parametrize(
    "p", [pytest.param(p, marks=marks, id=name) for name, (p, marks) in CASES.items()]
)
def test_multipliers_agree_with_central_differences_of_the_return_map(p):
    result = floquet(p)
    map_ = ReturnMap(p)
    assert result.status is CycleStatus.OK
    x = map_.point(result.state)
    expected = central_differences(map_, x)
    mine = result.multipliers
    reference = np.linalg.eigvals(expected)
    apart = np.abs(mine[:, None] - reference[None, :])
    assert apart.min(axis=1).max() < 1e-6
    jacobian = map_.evaluate(x).jacobian
    assert np.max(np.abs(expected - jacobian)) < 1e-7
    rate = math.log(np.max(np.abs(reference))) / result.period
    assert result.growth_rate == pytest.approx(rate, abs=1e-4)


def test_the_cycle_is_found_again_from_a_simulation():
    result = floquet(P)
    later = simulate(P, 0.5 * result.period, initial_state=result.state, tol=1e-12).final_state
    again = find_cycle(P, guess=later)
    assert again.status is CycleStatus.OK
    assert again.message.endswith("with 1 release")
    map_ = ReturnMap(P)
    x = map_.point(again.state)
    np.testing.assert_allclose(x, map_.point(result.state), atol=1e-9 * np.linalg.norm(x))
    # run through twice it is the same cycle
    twice = find_cycle(P, guess=later, releases=2)
    assert twice.period == pytest.approx(2 * result.period, rel=1e-9)
    assert twice.releases == 2


class Logistic:
    """The map x -> r x (1 - x): its fixed point 1 - 1 / r doubles its period at r = 3."""

    size = 1
    deflection = 1.0
    tol = 1e-14

    def __init__(self, r: float) -> None:
        self.r = r

    def evaluate(self, x, *, releases, **_):
        start = x
        slope = np.eye(1)
        for _ in range(releases):
            slope = self.r * (1 - 2 * x[0]) * slope
            x = self.r * x * (1 - x)
        counts = Counts(releases, 0, 0, 0, releases)
        return Orbit(RETURNED, 0.01 * releases, 0.3, counts, start, x, slope, np.zeros((1, 0)))


def test_a_cycle_that_is_run_through_twice_is_told_from_one_of_double_period():
    """Which just beyond the doubling is 5e-4 of its size away from the simple one, to which
    Newton's method goes."""
    r = 3 + 1e-6
    simple = Logistic(r)
    double = (r + 1 + math.sqrt((r - 3) * (r + 1))) / (2 * r)
    for x, releases in ((1 - 1 / r + 1e-12, 1), (double, 2)):
        orbit = simple.evaluate(np.array([x]), releases=2)
        once = run_through_once(simple, orbit)
        assert once.counts.releases == releases


def test_a_motion_comes_to_a_stable_cycle_and_not_to_an_unstable_one():
    stable = P.replace(c=0.1)
    map_ = ReturnMap(stable)
    x = map_.point(floquet(stable).state)
    away = x + 1e-4 * np.linalg.norm(x) * np.eye(len(x))[0]
    found = find_cycle_near(map_, Passage(RETURNED, 0.0, away), 1e-4, 6)
    assert found.follows_cycle
    assert found.cycle.releases == 1  # not six times around
    assert found.kind is Outcome.STICK_SLIP
    assert found.cycle.growth_rate == pytest.approx(floquet(stable).growth_rate, rel=1e-6)

    # nor one that leaves it as the multipliers predict, unless that is asked for
    map_ = ReturnMap(P)
    x = map_.point(floquet(P).state)
    values, vectors = np.linalg.eig(map_.evaluate(x).jacobian)
    leaving = np.real(vectors[:, np.argmax(abs(values))])
    away = x + 0.001 * np.linalg.norm(map_.static) * leaving / np.linalg.norm(leaving)
    for start, waits, follows in ((x, (), False), (away, (), False), (away, (0.0,), True)):
        near = find_cycle_near(map_, Passage(RETURNED, 2.0, start), 0.0, 1, unstable=waits)
        assert near.follows_cycle is follows
        assert near.time == 2.0


@COMPILED
@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({"N": 385, "Omega": 15.1}, CycleStatus.NO_CYCLE),
        ({"Omega": 0}, CycleStatus.AT_REST),
        ({"N": 0}, CycleStatus.NO_STICK_SLIP),
        ({"mu_s": 0, "mu_k": 0}, CycleStatus.NO_STICK_SLIP),
        ({"k_p": 0}, CycleStatus.AT_REST),
        # the damper pulls with 64 N, between kinetic and static friction of 48 and 80 N
        ({"k_p": 0, "c_p": 32}, CycleStatus.AT_REST),
        ({"c_p": 5}, CycleStatus.NO_STICK_SLIP),
    ],
)
def test_without_a_cycle_the_status_says_what_was_found(changes, status):
    result = floquet(BASE.replace(**changes))
    assert result.status is status
    assert result.status.advice
    assert result.message.startswith(status.value)
    assert math.isnan(result.growth_rate)
    assert result.multipliers.shape == (0,)
    assert result.state is None
    assert not result.stable
    with pytest.raises(CycleError, match=status.value):
        result.raise_for_status()
    assert issubclass(CycleError, DiscModelError)


@pytest.mark.slow
@COMPILED
def test_multipliers_of_random_cases_are_those_of_a_differenced_return_map(seed: int) -> None:
    """Under all laws of contact. Two steps of differences say how good these are: near a graze only
    short ones are, and on a stiff contact perhaps none.

    Where friction does not fall, stick may last for no time, and the map has a corner.
    """
    rng = np.random.default_rng(seed)
    sure = 0
    passed_over = 0
    cases = (drawn_case(rng) for _ in range(200))
    cycles = (floquet(p) for p in cases if p.n_diameters >= 0 and p.mu_s > p.mu_k)
    for found in (cycle for cycle in cycles if cycle.status is CycleStatus.OK):
        map_ = ReturnMap(found.parameters)
        how = {"releases": found.releases}
        x = map_.point(found.state)
        size = np.linalg.norm(x)
        got = map_.evaluate(x, **how).jacobian
        for step in (1e-4, 1e-6, 1e-8):
            rough, fine = (
                central_differences(map_, x, h * size, **how) for h in (step, 0.3 * step)
            )
            error = np.abs(rough - fine).max()
            scale = max(1.0, np.abs(fine).max())
            if error <= 1e-3 * scale:
                # rounding of orbits, 3e-13, over the step
                assert np.abs(got - fine).max() <= 1e-11 / step * scale + 10 * error, (
                    found.parameters
                )
                break
        else:
            passed_over += 1
        assert np.sum(found.multipliers) == pytest.approx(
            np.trace(got), rel=1e-9, abs=1e-9 * np.abs(got).max()
        )
        sure += error < 1e-5
    assert sure > 10
    assert passed_over < 5


def test_numbers_of_a_cycle_are_of_its_period_and_over_the_deflection():
    counts = Counts(3, 2, 4, 5, 7)
    start = np.array([0.1])
    by = np.zeros((1, 0))
    orbit = Orbit(RETURNED, 0.02, 0.005, counts, start, start + 1e-6, np.array([[0.5]]), by)
    map_ = SimpleNamespace(parameters=P, tol=1e-12, deflection=0.5, state=lambda x: None)
    cycle = cycle_of(map_, orbit)
    assert tuple(getattr(cycle, name) for name in Counts._fields) == counts
    assert cycle.message.endswith("with 3 releases")
    assert cycle.stick_fraction == pytest.approx(0.25)
    assert cycle.stick_time == pytest.approx(0.005 / 3)
    assert math.isnan(cycle.slip_time), "the slider is off the disc for a part of the rest"
    # of the difference of two floats near 0.1
    assert cycle.residual == pytest.approx(2e-6, rel=1e-9)


@COMPILED
def test_times_and_rates_of_a_cycle_have_the_names_that_sweeps_give_them() -> None:
    case = Parameters(N=385, Omega=15)
    cycle = floquet(case)
    assert cycle.stick_time + cycle.slip_time == pytest.approx(cycle.period, rel=1e-12)
    assert cycle.sliding_growth_rate == steady_sliding(case).growth_rate
    swept = sweep(floquet, case, N=[385])
    assert swept["slip_time"].item() == cycle.slip_time
    assert swept["slip_time"].attrs["units"] == "s"
    assert swept["sliding_growth_rate"].item() == cycle.sliding_growth_rate


SLOW = Parameters(
    N=549,
    Omega=10.42,
    mu_s=0.379,
    mu_k=0.224,
    k_p=30590,
    k=40980,
    m=0.09,
    c_p=2,
    n_diameters=2,
    normalization="as_published",
)
"""A case whose motion from the static start comes slowly to its cycle."""


def test_a_motion_that_comes_slowly_to_its_cycle_is_followed_for_longer() -> None:
    """No cycle was found 60 releases after the static start, and it was said that there is none."""
    cycle = floquet(SLOW)
    later = floquet(SLOW, guess=simulate(SLOW, 20).final_state)
    assert cycle.stable
    assert cycle.period == pytest.approx(later.period, rel=1e-9)
