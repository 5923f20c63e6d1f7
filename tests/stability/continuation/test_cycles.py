"""Branches of stick-slip cycles: compared with shorter steps, with `floquet`, with simulations, and
their ends with the margins of the events."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

from disc_model import Parameters, Window, continue_cycle, floquet, simulate
from disc_model.data.variables import CycleStatus, value_with_unit
from disc_model.errors import ParameterError
from disc_model.simulation.states import State
from disc_model.stability.continuation import Branch, StepControl
from disc_model.stability.return_map import ReturnMap
from tests.blocks import RIG
from tests.refusals import refusal

pytestmark = pytest.mark.compiled

SHORT = StepControl(step=0.002, longest=0.01, max_points=20_000)
STEEL = {
    "normalization": "orthonormal",
    "a": 0.04,
    "b": 0.15,
    "r_0": 0.13,
    "h": 0.006,
    "E": 210e9,
    "rho": 7800,
    "nu": 0.3,
    "m": 0.3,
    "k": 5e5,
    "k_p": 2e5,
    "c_p": 5,
    "mu_s": 0.45,
    "mu_k": 0.35,
    "damping_ratio": 5e-4,
}
BRANCHES = {
    "published": (Parameters(N=200, Omega=20), (4, 50)),
    "orthonormal": (Parameters(N=300, Omega=20, normalization="orthonormal"), (10, 40)),
    "steel": (Parameters(N=9000, Omega=16, friction_offset="surface", **STEEL), (15, 30)),
}


@pytest.fixture(scope="module", params=BRANCHES)
def branch(request: pytest.FixtureRequest) -> Branch:
    p, bounds = BRANCHES[request.param]
    return continue_cycle(p, "Omega", bounds)


def folds_with_periods(branch: Branch) -> np.ndarray:
    """Values and periods of the folds, (n, 2): cycles of one value differ in their periods."""
    folds = [each for each in branch.special if each.kind == "fold"]
    return np.array([(each.values[0], each.period) for each in folds]).reshape(-1, 2)


def test_no_fold_is_listed_twice_and_shorter_steps_find_the_same(branch: Branch) -> None:
    folds = folds_with_periods(branch)
    apart = np.abs(folds[:, None] / folds[None] - 1).max(axis=2) + np.eye(len(folds))
    assert apart.min(initial=1.0) > 1e-7
    p = branch.case
    bounds = next(bounds for case, bounds in BRANCHES.values() if case == p)
    fine = continue_cycle(p, "Omega", bounds, steps=SHORT)
    assert len(fine) > len(branch)
    assert fine.ended == branch.ended
    # both are located to rounding, 1e-11 as a rule
    np.testing.assert_allclose(folds_with_periods(fine), folds, rtol=1e-9)


def test_points_are_the_cycles_of_floquet(branch: Branch) -> None:
    """Away from folds, where Newton's method from the point itself comes to it again."""
    simple = np.flatnonzero(np.abs(branch.multipliers[:, 0]) < 1.3)
    for i in simple[:: max(1, len(simple) // 12)]:
        near_fold = np.abs(branch.multipliers[i] - 1).min() < 1e-3
        if near_fold:
            continue
        found = floquet(branch.case_at(i), guess=branch.state(i))
        assert found.status is CycleStatus.OK
        # residuals of 1e-12 over the distance of a multiplier from 1, at least 1e-3, for both cycles
        assert found.period == pytest.approx(branch.period[i], rel=2e-9)
        apart = np.abs(found.multipliers[:, None] - branch.multipliers[i][None, :]).min(axis=1)
        assert apart.max() < 1e-6


def test_a_state_of_a_branch_repeats_in_simulation_though_unstable(branch: Branch) -> None:
    unstable = np.flatnonzero(branch.growth_rate > 0)
    for i in unstable[:: max(1, len(unstable) // 6)]:
        state = branch.state(i)
        run = simulate(branch.case_at(i), branch.period[i], initial_state=state, tol=1e-13)
        # the residual, some 1e-11 of the deflection, moves the period, and with it fast modes
        allowed = 1e-7 * max(1.0, abs(branch.multipliers[i, 0]))
        for name in ("a", "b", "alpha", "beta"):
            start = getattr(state, name)
            end = getattr(run.final_state, name)
            scale = max(np.abs(getattr(state, pair)).max() for pair in _OF_ONE_SIZE[name])
            assert np.abs(end - start).max() < allowed * scale


_OF_ONE_SIZE = {
    "a": ("a", "b"),
    "b": ("a", "b"),
    "alpha": ("alpha", "beta"),
    "beta": ("alpha", "beta"),
}


def test_ranges_are_those_of_simulated_periods(branch: Branch) -> None:
    numbers = [0, len(branch) // 2, -1]
    for i in numbers:
        p = branch.case_at(i)
        state = branch.state(i)
        stop = float(branch.period[i])
        period = Window(start=0.0, stop=stop, rate=1e6 / stop)
        run = simulate(p, stop, {"period": period}, initial_state=state)
        samples = run.samples["period"]
        size = float(np.ptp(samples["u"]))
        # samples miss a peak by 1e-10 of the range at most, the parabola of the branch by 1e-7
        assert branch.range[i] == pytest.approx(size, rel=1e-6)


def test_a_table_of_special_points_tells_a_state_by_time_and_phase(branch: Branch) -> None:
    """The numbers of each state made a row 120 characters longer."""
    state = branch.special[0].state
    assert "State(0 s, stick)" in branch.special_points.to_string()
    assert f"psi={state.psi:.6g} rad" in repr(state)


def test_special_points_have_their_multipliers(branch: Branch) -> None:
    for special in branch.special:
        if special.kind not in ("fold", "neimark_sacker", "period_doubling"):
            continue
        assert abs(special.multiplier) == pytest.approx(1, abs=1e-6)
        run = simulate(special.case, special.period, initial_state=special.state, tol=1e-13)
        # it is a cycle: the slider is where it was
        assert run.final_state.u == pytest.approx(special.state.u, abs=1e-9 * abs(special.state.u))


def test_stability_changes_at_the_first_neimark_sacker_point_of_a_stable_cycle() -> None:
    p = Parameters(N=300, Omega=20, normalization="orthonormal")
    branch = continue_cycle(p.replace(Omega=18.5), "Omega", (18.5, 22), direction=1)
    [point] = [each for each in branch.special if each.kind == "neimark_sacker"]
    speed = float(point.values[0])
    below, above = (floquet(p.replace(Omega=speed + shift)) for shift in (-1e-3, 1e-3))
    assert below.growth_rate < 0 < above.growth_rate
    # both are as far, and the rate is linear over so little
    assert abs(below.growth_rate + above.growth_rate) < 0.05 * above.growth_rate


@pytest.fixture(scope="module")
def doubled() -> Branch:
    """Separating cycles of two releases."""
    p = Parameters(N=385, Omega=15.1)
    state = simulate(p, 100.0).final_state
    return continue_cycle(p, "Omega", (9.0, 18.0), guess=state, releases=2)


def test_a_branch_of_twice_the_period_ends_at_the_doubling(doubled: Branch) -> None:
    """It had gone on along the same cycles, half a period later, with folds that are none."""
    assert "a period doubling at Omega = 14.28" in doubled.ended
    assert not len(doubled.folds)
    first = doubled.special[0]
    assert first.kind == "period_doubling"
    p = first.case
    single = continue_cycle(p, "Omega", (14.0, 14.6), guess=first.state)
    kinds = [each.kind for each in single.special]
    number = kinds.index("period_doubling")
    doubling = single.special[number]
    # a double zero of the equations of twice the period: half of the digits
    assert first.values[0] == pytest.approx(doubling.values[0], rel=1e-7)
    assert first.period == pytest.approx(2 * doubling.period, rel=1e-7)


def test_a_branch_of_twice_the_period_begins_at_the_doubling(doubled: Branch) -> None:
    start = doubled.special[0]
    p = start.case
    branch = continue_cycle(p, "Omega", (14.0, 14.6), guess=start.state, releases=2)
    assert branch.ended.startswith("a period doubling at Omega = 14.28")
    kinds = [special.kind for special in branch.special]
    assert kinds == ["period_doubling", "end"]
    assert branch.special[0].values == pytest.approx(start.values, rel=1e-7)
    assert np.all(np.diff(branch.values[:, 0]) > 0)
    # at the other end it is the branch that came to the doubling
    speeds = doubled.values[:, 0]
    i = np.searchsorted(speeds, 14.6)
    known = continue_cycle(
        doubled.case_at(i), "Omega", (14.5, 16.0), guess=doubled.state(i), releases=2, values=[14.6]
    )
    there = known.values[:, 0] == 14.6
    [period] = known.period[there]
    last = branch.period[-1]
    assert last == pytest.approx(period, rel=1e-9)


def test_a_cycle_is_not_followed_with_twice_its_releases(doubled: Branch) -> None:
    doubling = doubled.special[0]
    p = doubling.case
    single = continue_cycle(p, "Omega", (13.0, 14.6), guess=doubling.state)
    p = single.case_at(0)
    state = single.state(0)
    rule = "repeats after 1 release; follow it with releases=1"
    with refusal(rule):
        continue_cycle(p, "Omega", (12, 15), guess=state, releases=2)


def test_stability_that_changes_twice_within_a_step_is_found() -> None:
    start = Parameters(N=359.452, Omega=12.6441, normalization="orthonormal")
    points = continue_cycle(start, "Omega", (12.5, 15.1)).special
    speeds = [point.values[0] for point in points if point.changes_stability]
    assert len(speeds) == 3
    _, regained, lost = speeds
    assert 0.2 < lost - regained < 0.3  # rad/s; a step there is one of 0.3 rad/s
    for speed, stable in (
        (regained - 0.001, False),
        (regained + 0.001, True),
        (lost - 0.001, True),
        (lost + 0.001, False),
    ):
        assert floquet(start.replace(Omega=speed)).stable == stable


def test_a_branch_can_stop_where_the_cycle_first_loses_stability() -> None:
    p = Parameters(N=300, Omega=18.5, normalization="orthonormal")
    branch = continue_cycle(p, "Omega", (18.2, 30), direction=1, stop_at="neimark_sacker")
    assert branch.ended.startswith("the first Neimark-Sacker bifurcation, at Omega = 19.")
    assert np.all(branch.growth_rate[:-1] < 0)
    assert branch.growth_rate[-1] == pytest.approx(0, abs=1e-5)


# ---- Ends

STEEL_ALONE = Parameters(N=5139, Omega=34.65, **STEEL)
FALLING = {"normalization": "orthonormal", "friction_decay": 8.0}
ENDS = {
    "stick vanishes: the cycle touches zero slip speed": (STEEL_ALONE, 1, "stop"),
    "a grazing release: during stick the pull touches friction's limit": (
        Parameters(N=507, Omega=12.8, normalization="orthonormal"),
        1,
        "earlier release",
    ),
    "a grazing release: the pull touches friction's limit where stick ends": (
        Parameters(N=200, Omega=9.8),
        -1,
        "release",
    ),
    "a grazing stop: the cycle touches zero slip speed during slip": (
        Parameters(N=253, Omega=6.16),
        1,
        "earlier stop",
    ),
    "contact is lost: the contact force touches zero": (
        Parameters(N=334, Omega=11.1, normalization="orthonormal"),
        1,
        "contact",
    ),
}


def margins(branch: Branch, i: int) -> dict[str, float]:
    """Margins of a cycle's events over its preload and period, from samples of a simulation: how
    steeply slip and stick end, and how near to an event the motion comes elsewhere."""
    p = branch.case_at(i)
    period = branch.period[i]
    count = 40_000
    windows = {"all": Window(rate=count / period)}
    run = simulate(p, period, windows, initial_state=branch.state(i), tol=1e-12)
    samples = run["all"]
    force = samples["P"].values / p.N
    f = (p.Omega - samples["psi_velocity"].values) / p.Omega
    pull = p.r_0 * (p.k_p * samples["psi"].values + p.c_p * samples["psi_velocity"].values)
    left = force - np.abs(pull) / (p.mu_s * p.N)  # of friction's limit
    stick = samples["phase"].values == 0

    def least(values: np.ndarray, where: np.ndarray) -> float:
        inner = (values[1:-1] < values[:-2]) & (values[1:-1] < values[2:])
        inner &= where[1:-1] & where[:-2] & where[2:]
        return float(values[1:-1][inner].min(initial=np.inf))

    [stop] = np.flatnonzero(np.diff(stick.astype(int)) == 1)
    return {
        "stop": float(f[stop - 2] - f[stop - 1]) * count,
        "release": float(left[-4] - left[-3]) * count,
        "earlier release": least(left, stick),
        "earlier stop": least(f, ~stick),
        "contact": float(force.min()),
    }


@pytest.mark.parametrize("ended", ENDS)
def test_the_reason_of_an_end_is_the_margin_that_vanishes_there(ended: str) -> None:
    p, direction, vanishing = ENDS[ended]
    branch = continue_cycle(p, "Omega", (4, 60), direction=direction)
    assert branch.ended == ended
    assert branch.special[-1].kind == "grazing"
    found = margins(branch, -1)
    # touching leaves the square root of 1e-7 in a slope, at the shortest step, and all of it in a distance
    smallest = min(found, key=lambda name: found[name])
    assert smallest == vanishing
    assert abs(found[smallest]) < 0.02
    others = [value for name, value in found.items() if name != vanishing]
    assert min(others) > 2 * abs(found[smallest])


def test_a_branch_in_a_parameter_without_columns_reaches_a_grazing_release() -> None:
    """Differences of orbits whose dependence on mu_k is a square root there ended it at 0.059185."""
    case = Parameters(N=400, Omega=14, mu_k=0.07)
    single = continue_cycle(case, "mu_k", (0.066, 0.071))
    doubling = next(each for each in single.special if each.kind == "period_doubling")
    branch = continue_cycle(doubling.case, "mu_k", (0.05, 0.1), guess=doubling.state, releases=2)
    released = "a grazing release: the pull touches friction's limit where stick ends"
    assert branch.ended.endswith(released)
    end = branch.special[-1]
    assert end.kind == "grazing"
    # the multiplier grows without bounds towards the grazing; at 0.059185 it is 10
    assert end.multiplier.real > 1e3
    shorter = continue_cycle(
        doubling.case, "mu_k", (0.05, 0.1), guess=doubling.state, releases=2, steps=SHORT
    )
    # both end at about the square of the distance at which a difference of orbits fails, 1e-4
    assert end.values[0] == pytest.approx(shorter.special[-1].values[0], abs=1e-6)


def test_a_branch_ends_where_a_release_turns_round() -> None:
    """It said that no step succeeds. Contact force and pull vanish there where stick ends; the
    period goes on smoothly, with one forward release instead of two."""
    case = Parameters(N=385, Omega=15.1)
    settled = simulate(case, 120).final_state
    bounds = (0.15, 0.38)
    twice = continue_cycle(case, "mu_k", bounds, direction=-1, guess=settled, releases=2)
    turned = (
        "a release turns round: the contact force and the pull touch zero together where stick ends"
    )
    assert twice.ended == (
        f"{turned}; the cycle beyond has 1 release: start again there with releases=1"
    )
    end = twice.special[-1]
    assert end.kind == "grazing"
    events = simulate(end.case, 0.9 * end.period, initial_state=end.state).events
    release = events[events["kind"] == "stick_to_slip"].iloc[-1]
    # of preloads of 385 N: the step ends within 1e-7 of the place, where the force falls like a root
    assert 0 < release["P"] < 0.02

    # from beyond the same place is found
    beyond = end.case.replace(mu_k=end.case.mu_k - 1e-5)
    settled = simulate(beyond, 60, initial_state=end.state).final_state
    once = continue_cycle(beyond, "mu_k", bounds, direction=1, guess=settled)
    assert once.ended.startswith(turned)
    assert once.ended.endswith("start again there with releases=2")
    # the shortest step over the scale of mu_k, 0.16, on either side
    assert once.special[-1].values[0] == pytest.approx(end.values[0], abs=1e-6)
    assert once.period[-1] == pytest.approx(end.period, rel=1e-6)

    # and a search for two releases there says that the cycle has one
    found = floquet(beyond, guess=settled, releases=2)
    assert found.period == pytest.approx(2 * once.period[0], rel=1e-9)
    assert found.message.endswith("it repeats after 1 release: find it with releases=1")
    assert "repeats" not in floquet(case, guess=twice.state(0), releases=2).message


def test_a_continuation_tells_how_far_it_is(capsys: pytest.CaptureFixture[str]) -> None:
    p = Parameters(N=385, Omega=14.9)
    branch = continue_cycle(p, "Omega", (14.8, 15))
    assert capsys.readouterr() == ("", "")
    continue_cycle(p, "Omega", (14.8, 15), progress=True)
    told = re.findall(
        r"continue_cycle at Omega = ([0-9.]+) rad/s +([0-9]+) 0:00", capsys.readouterr().err
    )
    value, count = told[-1]
    assert 14.8 <= float(value) <= 15
    assert int(count) == len(branch) - 1  # all but that from which it starts
    with refusal("progress='yes': must be True or False"):
        continue_cycle(p, "Omega", (14.8, 15), progress="yes")  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def separating() -> State:
    """A settled motion that separates and sticks twice in a period, at 385 N and 15.1 rad/s."""
    return simulate(Parameters(N=385, Omega=15.1), 100).final_state


def test_a_doubled_branch_ends_at_the_doubling_of_the_single_one(separating: State) -> None:
    """It listed four folds beside it, which were rounding, and the doubling 1e-8 away."""
    doubled = continue_cycle(
        Parameters(N=385, Omega=15.1), "N", (300, 450), guess=separating, releases=2
    )
    assert [each.kind for each in doubled.special] == ["grazing", "period_doubling"]
    end = doubled.special[-1]
    single = continue_cycle(end.case, "N", (400, 410), guess=end.state)
    doubling = next(each for each in single.special if each.kind == "period_doubling")
    # both are roots to some 1e-13 in the parameter
    assert end.values[0] == pytest.approx(doubling.values[0], rel=1e-11)
    # the same cycle has the same range, twice
    assert end.range == pytest.approx(doubling.range, rel=1e-6)


def test_a_doubled_branch_that_soon_ends_is_followed(separating: State) -> None:
    """Its cycles are within 5e-3 of the doubling, where the first one was sought."""
    case = Parameters(N=385, Omega=15.1)
    long = continue_cycle(case, "k_p", (2.0e4, 2.6e4), guess=separating, releases=2)
    at_end = long.special[-1]
    single = continue_cycle(at_end.case, "k_p", (2.0e4, 2.6e4), guess=at_end.state)
    doubling = next(each for each in single.special if each.kind == "period_doubling")
    assert doubling.values[0] == pytest.approx(20436.19, abs=0.01)
    short = continue_cycle(doubling.case, "k_p", (2.0e4, 2.6e4), guess=doubling.state, releases=2)
    assert short.ended.endswith("stick vanishes: the cycle touches zero slip speed")
    assert short.values.max() < 20450


def test_a_guess_of_another_number_of_releases_is_told_when_it_repeats(separating: State) -> None:
    p = Parameters(N=385, Omega=15.1)
    rule = (
        "no cycle with 3 releases near the given state; the motion from there repeats after 2 rel"
    )
    with refusal(rule):
        continue_cycle(p, "Omega", (15, 16), guess=separating, releases=3)


def test_the_end_of_stick_on_a_rigid_disc_is_a_grazing() -> None:
    """It was no reason: stick ends so shortly before the release that this was not compared."""
    branch = continue_cycle(RIG.replace(Omega=2.2), "Omega", (2.2, 3), direction=1)
    assert branch.ended == "stick vanishes: the cycle touches zero slip speed"
    assert branch.special[-1].kind == "grazing"


def test_a_hopf_point_has_no_folds_beside_it() -> None:
    block = RIG.replace(m=0.4, k_p=7000, c_p=6)
    branch = continue_cycle(block, "Omega", (1, 3), kind="slipping")
    assert [each.kind for each in branch.special] == ["hopf", "grazing"]


def test_growth_rates_lie_between_those_of_neighbouring_points(separating: State) -> None:
    """A line from 14.0 rad/s to the period doubling at 14.29 showed half the decay at 14.15."""
    p = Parameters(N=385, Omega=15.1)
    doubled = continue_cycle(p, "Omega", (14, 18), guess=separating, releases=2)
    doubling = doubled.special[0]
    single = continue_cycle(doubling.case, "Omega", (13, 15), guess=doubling.state)
    speeds = single.values[:, 0]
    between = 14.15
    i = int(np.argmin(np.abs(speeds - between)))
    cycle = floquet(p.replace(Omega=between), guess=single.state(i))
    drawn = np.interp(between, speeds, single.growth_rate)
    assert drawn == pytest.approx(cycle.growth_rate, rel=0.2)  # which is `LITTLE_CHANGE`


def test_cycles_are_found_by_their_value() -> None:
    p = Parameters(N=385, Omega=14.9)
    branch = continue_cycle(p, "Omega", (14.8, 15.2), values=["143 rpm"])
    numbers = branch.at("143 rpm")
    assert len(numbers) == 2  # on both sides of the fold
    assert branch.values[numbers, 0] == pytest.approx(143 * np.pi / 30, rel=1e-12)
    assert branch.at(14.97) == []
    with refusal("value='15 Hz'"):
        branch.at("15 Hz")
    with refusal("value='fast'"):
        branch.at("fast")


@pytest.mark.parametrize("name", ["damping_ratio", "friction_decay", "contact_compliance"])
def test_a_number_that_does_not_act_cannot_be_continued(name: str) -> None:
    with refusal(f"name='{name}': does not act in this case"):
        continue_cycle(Parameters(N=385, Omega=14.9), name, (0.1, 1))


# ---- Random starts


@pytest.mark.slow
@pytest.mark.parametrize("seed", [*range(24), 710])
def test_branches_of_random_cases_are_those_of_shorter_steps(seed: int) -> None:
    rng = np.random.default_rng(seed)
    if seed % 3 == 2:
        offset = ("surface", 0.0)[seed % 2]
        load = rng.uniform(5000, 10_000)
        speed = rng.uniform(12, 30)
        p = Parameters(N=load, Omega=speed, friction_offset=offset, **STEEL)
    else:
        modes = ("as_published", "orthonormal")[seed % 3]
        load = rng.uniform(50, 350)
        speed = rng.uniform(8, 50)
        p = Parameters(N=load, Omega=speed, normalization=modes)
    bounds = (0.6 * p.Omega, 60.0)
    coarse = continue_cycle(p, "Omega", bounds)
    fine = continue_cycle(p, "Omega", bounds, steps=SHORT)
    folds = folds_with_periods(coarse)
    np.testing.assert_allclose(folds_with_periods(fine), folds, rtol=1e-6)
    assert fine.ended == coarse.ended
    assert "no step from" not in coarse.ended
    assert "meets itself" not in coarse.ended


FOLDED = Parameters(N=385, Omega=14.9)
"""On the stable half of a branch that turns back at 15.09 rad/s."""


def test_a_case_without_a_cycle_is_told_what_to_do() -> None:
    """The message called the case p, which is no argument, and said nothing else."""
    case = FOLDED.replace(Omega=15.1)
    rule = "^case: must have a cycle of one release"
    with refusal(rule) as raised:
        continue_cycle(case, "Omega", (14, 16))
    advice = (
        "where stick-slip goes on; start from another value of Omega, or give a state near a cycle"
        " as guess, such as the last one of a longer simulation"
    )
    message = str(raised.value)
    assert message.endswith(advice)
    assert message.count("as guess") == 1


@pytest.mark.parametrize(("value", "text"), [(17, "17"), ("13 rad/s", "'13 rad/s'")])
def test_a_value_outside_the_bounds_is_refused(value: object, text: str) -> None:
    """It was accepted in silence."""
    bounds = (14, 16)
    rule = "must lie within the bounds, 14 to 16 rad/s"
    with pytest.raises(ParameterError) as raised:
        continue_cycle(FOLDED, "Omega", bounds, values=[15, value])
    message = str(raised.value)
    assert message == f"values={text}: {rule}"


def test_values_that_are_not_reached_are_said() -> None:
    """One is beyond the fold; a bound and the start are reached."""
    reached = [14.8, 14.9, 15.05]
    bounds = (14.8, 16)
    branch = continue_cycle(FOLDED, "Omega", bounds, values=[*reached, 15.5])
    assert branch.not_reached == [15.5]
    assert {*reached} < {*branch.values[:, 0]}
    said = "; not reached: Omega = 15.5 rad/s"
    assert said in repr(branch)


def test_nothing_is_said_of_values_that_are_all_reached() -> None:
    bounds = (14.8, 15)
    branch = continue_cycle(FOLDED, "Omega", bounds, values=[14.85])
    assert "not reached" not in repr(branch)


def test_a_special_point_given_for_its_state_is_told_so() -> None:
    case = Parameters(N=385, Omega=14.9)
    point = SimpleNamespace(state=None)
    with refusal(r"guess=.*must be a State, such as its attribute state"):
        continue_cycle(case, "Omega", (14.8, 15.0), guess=point)  # type: ignore[arg-type]


STIFF = Parameters(N=385, Omega=14.9, contact_compliance=1e-8)


@pytest.fixture(scope="module")
def stiff() -> Branch:
    return continue_cycle(STIFF, "Omega", (14.85, 15.3))


def test_a_stiff_contact_is_followed_past_the_bends_of_its_vibration(stiff: Branch) -> None:
    """It ended at 15.044 rad/s from 14.9 rad/s, and at 15.0402 rad/s from beyond, with branch points
    that moved with the start."""
    assert stiff.ended == "the bound Omega = 14.85 rad/s was reached"
    for speed in (15.043, 15.06):  # within such a bend, and beyond it
        other = continue_cycle(STIFF.replace(Omega=speed), "Omega", (14.85, 15.3))
        kinds = {special.kind for special in (*stiff.special, *other.special)}
        assert kinds == {"end", "fold", "neimark_sacker"}
        assert stiff.folds[:, 0] == pytest.approx(
            other.folds[:, 0], rel=1e-9
        )  # rounding of the map

    # a known compliance softens the contact: the fold moves away from that of the rigid one evenly
    softer = continue_cycle(STIFF.replace(contact_compliance=2e-8), "Omega", (14.85, 15.3))
    rigid = continue_cycle(FOLDED, "Omega", (14.85, 15.3))
    moves = rigid.folds[0, 0] - np.array([stiff.folds[0, 0], softer.folds[0, 0]])
    assert moves[1] / moves[0] == pytest.approx(2, rel=0.02)  # of the second order in it


def test_a_stiff_contact_grazes_the_limit_within_a_vibration_of_its_release() -> None:
    case = Parameters(N=385, Omega=15.0, friction_offset="surface", contact_compliance=1e-8)
    branch = continue_cycle(case, "Omega", (15.0, 15.4), direction=1)
    assert branch.ended == "a grazing release: during stick the pull touches friction's limit"
    left = margins(branch, -1)
    assert abs(left["earlier release"]) < 1e-3  # of the preload; samples are 1e-4 apart there
    assert left["release"] > 1


def test_cycles_of_a_stiff_contact_are_those_of_floquet(stiff: Branch) -> None:
    for i in range(0, len(stiff), 12):
        cycle = floquet(stiff.case_at(i), guess=stiff.state(i))
        assert cycle.status is CycleStatus.OK
        # floquet accepts residuals up to 1e-8 where rounding stops it: the contact's force changes by
        # 100 N in a micrometre
        assert cycle.period == pytest.approx(stiff.period[i], rel=1e-8)
        assert cycle.growth_rate == pytest.approx(stiff.growth_rate[i], abs=1e-4)


def test_a_push_along_the_unstable_direction_grows_by_the_multiplier() -> None:
    branch = continue_cycle(FOLDED, "Omega", (14.8, 15.2))
    cycle = branch.state(-1)
    section = ReturnMap(branch.case_at(-1))
    x = section.point(cycle)
    for push in (1e-5, -1e-5):
        pushed = branch.state(-1, push)
        assert (pushed.psi - cycle.psi) * push > 0
        moved = section.point(pushed) - x
        assert np.linalg.norm(moved) == pytest.approx(1e-5 * section.deflection, rel=1e-9)
        after = section.evaluate(x + moved).end - x
        growth = float(after @ moved) / float(moved @ moved)
        # the map's second derivatives, of order one to a hundred, over a move of 1e-5
        assert growth == pytest.approx(branch.multipliers[-1, 0].real, abs=2e-3)


@pytest.mark.parametrize("push", [np.nan, "1e-3", None])
def test_a_push_that_is_no_number_is_refused(push: object) -> None:
    branch = continue_cycle(FOLDED, "Omega", (14.8, 14.95), direction=1)
    with refusal(r"push=.*: must be a finite number"):
        branch.state(0, push)  # type: ignore[arg-type]


def test_bounds_in_hertz_are_refused_with_the_reason() -> None:
    """The message was that they must be two ascending numbers."""
    with refusal("Hz may mean turns or radians"):
        continue_cycle(FOLDED, "Omega", ("2.3 Hz", 16))


@pytest.mark.parametrize(("name", "value"), [("contact_arc", 0.1), ("damping_ratio", 1e-4)])
def test_a_branch_reaches_the_least_value_of_its_parameter(name: str, value: float) -> None:
    """It ended above 0, where a difference of orbits on both sides needs a value below it."""
    case = Parameters(N=385, Omega=14.9, n_diameters=1, **{name: value})
    branch = continue_cycle(case, name, (0, 1.5 * value), values=[0], direction=-1)
    assert f"the bound {value_with_unit(name, 0.0)} was reached" in branch.ended
    [last] = branch.at(0)
    there = floquet(case.replace(**{name: 0}))
    assert branch.period[last] == pytest.approx(there.period, rel=1e-9)
    assert branch.growth_rate[last] == pytest.approx(there.growth_rate, abs=1e-6)
