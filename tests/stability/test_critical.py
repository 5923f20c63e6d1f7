"""Values of a parameter at which stability changes."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from disc_model import Parameters, continue_cycle, floquet, neutral_curves, simulate, sweep
from disc_model.data.variables import STABLE_CYCLES
from disc_model.display import Bar
from disc_model.figures.selection import not_near
from disc_model.stability import critical, parameter_scan
from disc_model.stability.continuation import spectrum
from disc_model.stability.sliding import SlidingStatus, steady_sliding
from tests.blocks import RIG
from tests.refusals import refusal
from tests.stability.test_sliding_motion import SQUEALS


@pytest.mark.compiled
def test_a_narrow_tongue_between_two_values_is_seen() -> None:
    """Two stable stretches between six values from 260 to 400 N, a hundredth of the range wide."""
    p = Parameters(N=302, Omega=11.3, normalization="orthonormal", friction_offset="surface")
    found = critical.critical(p, "N", (260, 400), points=6, precision=1e-4)
    # Neimark-Sacker points of `continue_cycle`, located to rounding; the precision is 1e-4
    tongues = [[274.843534, 276.503088], [370.465968, 371.635283]]
    stable = np.column_stack([found.unstable[:-1, 1], found.unstable[1:, 0]])
    np.testing.assert_allclose(stable, tongues, rtol=0, atol=1.1e-4)
    assert found.unstable_above.tolist() == [False, True, False, True]
    for crossing, unstable in zip(found.crossings, found.unstable_above, strict=True):
        below = floquet(p.replace(N=crossing - 2e-4))
        above = floquet(p.replace(N=crossing + 2e-4))
        assert below.stable == unstable
        assert above.stable == (not unstable)
    assert found.resolution == np.diff(found.values).max() <= 28


@pytest.fixture
def short_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search from the static start does not follow motions that come slowly to a cycle."""
    monkeypatch.setattr("disc_model.stability.cycle.NEAR_REPEAT", 0.0)


@pytest.mark.usefixtures("short_search")
@pytest.mark.compiled
def test_a_stable_cycle_is_followed_to_its_fold() -> None:
    """From 26,848.9 N/m on Newton's method from the static start finds no cycle, and then the
    unstable one; that was the border."""
    case = Parameters(N=300, Omega=14)
    found = critical.critical(case, "k_p", (26700, 26900), points=21)
    branch = continue_cycle(case.replace(k_p=26840), "k_p", (26830, 26880), stop_at="fold")
    # the upper end of an interval of a millionth of the range
    assert found.crossings == pytest.approx(branch.folds[-1], abs=2.1e-4)
    assert found.value == found.crossings[0]
    assert np.all(found.growth_rate[found.values < found.value] < 0)
    # as the motion from the static start says
    for k_p in (26850.0, 26858.0):
        there = case.replace(k_p=k_p)
        assert not floquet(there).stable
        assert floquet(there, guess=simulate(there, 120).final_state).stable


@pytest.mark.usefixtures("short_search")
@pytest.mark.compiled
@pytest.mark.parametrize("speed", [20.15, 22.715, 28.09])
def test_stretches_in_which_the_search_finds_nothing_are_no_tongues(speed: float) -> None:
    """Three of a thousandth of the range and less were said to be unstable."""
    p = Parameters(
        N=385,
        Omega=33,
        E=70e9,
        rho=2700,
        nu=0.33,
        h=0.004,
        D_star=Parameters(N=1, Omega=1).D_star,
        normalization="orthonormal",
        mu_k_over_mu_s=0.6,
    )
    there = p.replace(Omega=speed)
    assert floquet(there).motion == "no_cycle"
    assert floquet(there, guess=simulate(there, 100).final_state).stable
    found = critical.critical(p, "Omega", (speed - 0.5, speed + 0.5), points=11, precision=1e-4)
    assert math.isnan(found.value)


@pytest.mark.compiled
def test_an_unstable_cycle_at_which_the_motion_stays_is_not_passed_over() -> None:
    """A stable one exists, too, far from the motion from the static start."""
    p = Parameters(N=251, Omega=12.9, normalization="orthonormal", friction_offset="surface")
    found = critical.critical(p, "k_p", (22400, 22650), points=26)
    there = p.replace(k_p=22500.0)
    # it leaves the cycle by a factor of e in 56 s
    assert not floquet(there, guess=simulate(there, 100).final_state).stable
    assert any(low < 22500 < high for low, high in found.unstable)


def scan_of(
    stretches: list[tuple[float, float]], monkeypatch: pytest.MonkeyPatch, **how: float
) -> critical.Critical:
    """A scan from 0 to 1 of a made-up motion that is unstable within stretches and has no cycle."""

    def find_cycle(p: Parameters, tol: float) -> SimpleNamespace:
        grows = any(low < p.c < high for low, high in stretches)
        word = "steady_sliding"
        if grows:
            word = "unstable_sliding"
        return SimpleNamespace(motion=word, multipliers=np.zeros(0), growth_rate=math.nan)

    monkeypatch.setattr(parameter_scan, "find_cycle", find_cycle)
    return critical.critical(Parameters(N=1, Omega=1), "c", (0.0, 1.0), **how)


def test_nothing_wider_than_the_resolution_is_overlooked(monkeypatch: pytest.MonkeyPatch) -> None:
    """It was the width to which crossings are bisected, however far apart the values were."""
    rng = np.random.default_rng(2)
    for points in (5, 21, 201):
        edges = np.sort(rng.uniform(0, 1, 8)).reshape(4, 2)
        found = scan_of(edges.tolist(), monkeypatch, points=points)
        assert found.resolution == np.diff(found.values).max() <= 1 / (points - 1) + 1e-15
        for low, high in edges:
            inside = (found.values > low) & (found.values < high)
            if high - low > found.resolution:
                assert inside.any()
        seen = [x for x in found.values if any(low < x < high for low, high in edges)]
        assert found.value == min(seen)
        # no crossing is further than a millionth of the range from a true one
        apart = np.abs(found.crossings[:, None] - edges.ravel()).min(axis=1)
        assert apart.max(initial=0) <= 1e-6


def test_crossings_are_the_upper_ends_of_their_intervals(monkeypatch: pytest.MonkeyPatch) -> None:
    """So that the motion at `value` is unstable."""
    edge = 0.123456
    found = scan_of([(edge, 0.7)], monkeypatch, points=11, precision=1e-4)
    first, last = found.crossings
    assert edge < first <= edge + 1e-4
    assert 0.7 <= last <= 0.7 + 1e-4
    assert found.value == first
    assert found.unstable_above.tolist() == [True, False]
    np.testing.assert_allclose(found.unstable, [[first, last]])
    # unstable from the lower bound on
    begins = scan_of([(-1, 0.2), (0.45, 0.65)], monkeypatch, points=11)
    assert begins.value == 0.0
    assert begins.unstable_above.tolist() == [False, True, False]
    assert begins.unstable[0, 0] == 0.0
    # and nowhere, as far as was seen
    assert math.isnan(scan_of([(0.41, 0.49)], monkeypatch, points=11).value)


@pytest.mark.parametrize(
    ("stretch", "message"),
    [
        ((-1.0, 0.2), "already unstable at the lower bound, c = 0 N s/m"),
        ((0.2, 0.7), ""),
        (
            (0.41, 0.49),
            "motion near the static start is stable at all 11 values computed from 0 to 1 N s/m; steady",
        ),
    ],
)
def test_a_value_that_is_no_border_is_said_to_be_none(
    stretch: tuple[float, float], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The lower bound was given as the critical value in silence, 15 times of 40 in a sweep."""
    found = scan_of([stretch], monkeypatch, points=11)
    assert found.message.startswith(message)
    assert bool(found.message) == bool(message)
    assert found.at_lower_bound == ("lower bound" in message)
    assert message in repr(found)


BLOCK = RIG.replace(m=0.5, k_p=7e3, c_p=6)


def test_sliding_of_a_block_is_stable_above_the_slope_of_friction() -> None:
    """mu falls by (mu_s - mu_k) decay / (1 + decay v)^2 per m/s, here 4/9 at 0.2 m/s, so that 10 N
    need a damper of 40/9 N s/m."""
    found = critical.critical(BLOCK, "c_p", (0.1, 6.0), points=11, kind="sliding")
    assert found.kind == "sliding"
    # bisected to a millionth of the range of 5.9
    assert found.crossings.tolist() == pytest.approx([40 / 9], abs=6e-6)
    assert found.unstable_above.tolist() == [False]
    assert found.message == "already unstable at the lower bound, c_p = 0.1 N s/m"
    assert "N s/m, 1 crossing" in repr(found)


def test_the_critical_speed_of_sliding_is_where_its_growth_rate_is_zero() -> None:
    """`critical` followed the cycle in silence, stable at all speeds, while sliding grew."""
    case = SQUEALS.replace(Omega=60)

    def rate(speed: float) -> float:
        return steady_sliding(case.replace(Omega=speed)).growth_rate

    found = critical.critical(case, "Omega", (20, 80), points=7, precision=1e-4, kind="sliding")
    assert found.value == pytest.approx(brentq(rate, 20, 80), abs=1e-4)
    assert rate(found.value) > 0 > rate(found.value - 1e-4)
    assert not found.at_lower_bound
    assert found.message == ""


def test_a_peak_of_growth_between_two_values_is_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """Modes that meet may grow for a stretch that is narrower than the steps."""

    def sliding(case: Parameters) -> SimpleNamespace:
        rate = 0.01 - (case.c - 0.4321) ** 2
        values = np.array([rate + 1j])
        growing = values[values.real > 0]
        return SimpleNamespace(
            status=SlidingStatus.OK, growth_rate=rate, growing=growing, eigenvalues=values
        )

    monkeypatch.setattr(parameter_scan, "steady_sliding", sliding)
    case = Parameters(N=1, Omega=1)
    found = critical.critical(case, "c", (0.0, 1.2), points=5, kind="sliding")
    # steps of 0.3: 0.3 and 0.6 lie beyond the stretch from 0.3321 to 0.5321
    assert found.crossings.tolist() == pytest.approx([0.3321, 0.5321], abs=2e-6)


def test_a_bar_counts_values_between_the_points_too(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    shares = iter([[0.5]])
    monkeypatch.setattr(parameter_scan, "_doubtful_shares", lambda low, high: next(shares, []))
    scan_of([(0.5, 0.7)], monkeypatch, points=2, progress=True)
    assert "3/3" in capsys.readouterr().err
    with refusal(r"kind='slide': must be 'stick_slip', .* or 'sliding', steady sliding; "):
        critical.critical(BLOCK, "c", (0, 1), kind="slide", progress=3)


@pytest.mark.compiled
def test_a_sweep_keeps_what_is_said_of_a_critical_value() -> None:
    case = Parameters(N=385, Omega=15)
    found = sweep(
        critical.critical, case, N=[385.0, 400.0], name="Omega", bounds=(15.2, 16), points=3
    )
    said = found["message"].values
    expected = "already unstable at the lower bound, Omega = 15.2 rad/s"
    assert said[0] == expected
    assert found["value"][0] == 15.2
    assert found["at_lower_bound"].values.tolist() == [True, False]


@pytest.mark.compiled
def test_a_critical_value_says_where_the_motion_is_not_near_the_cycle() -> None:
    """The growth rate of 0.28/s at 7.35 rad/s stood for that of a motion near another cycle."""
    case = Parameters(N=375, Omega=7)
    found = critical.critical(case, "Omega", (7.35, 7.4), points=3)
    cycle = floquet(case.replace(Omega=found.value))
    assert found.near_motion is cycle.near_motion is False
    assert found.other_growth_rate == cycle.other_growth_rate
    assert "near another cycle there, with growth rate 0.000399" in found.message
    assert found.message.startswith("already unstable at the lower bound")
    assert found.message in repr(found)


@pytest.mark.compiled
def test_a_critical_value_at_which_the_motion_is_near_the_cycle_says_nothing_of_another() -> None:
    found = critical.critical(Parameters(N=375, Omega=7), "Omega", (7.34, 7.36), points=2)
    assert found.near_motion is True
    assert math.isnan(found.other_growth_rate)
    assert found.message == "already unstable at the lower bound, Omega = 7.34 rad/s"


@pytest.mark.compiled
def test_a_sweep_of_critical_values_has_what_they_say_of_the_motion() -> None:
    axes = {"N": [375.0, 385.0]}
    case = Parameters(N=375, Omega=7)
    found = sweep(critical.critical, case, name="Omega", bounds=(7.35, 7.4), points=3, **axes)
    assert found["near_motion"].values.tolist() == [False, True]
    assert "near the cycle" in found["near_motion"].attrs["long_name"]
    assert found["other_growth_rate"].values[0] == pytest.approx(0.0004, abs=1e-4)
    away = not_near(found, "value")
    assert away is not None
    assert away.values.tolist() == [True, False]
    assert not_near(found, "growth_rate") is None


@pytest.mark.usefixtures("short_search")
@pytest.mark.compiled
def test_a_cycle_that_ends_between_two_values_is_looked_for() -> None:
    """At 207.0 to 207.5 N and 212.5 to 213.5 N the search finds none; the scan stepped over both. The
    cycle of other preloads goes on there and the motion settles on it, up to 215.15 N."""
    p = Parameters(N=1, Omega=9.452728864087778, normalization="orthonormal")
    found = critical.critical(p, "N", (195, 216), points=15)
    for N in (207.2, 213.0):
        assert floquet(p.replace(N=N)).status == "no_cycle"
        settled = simulate(p.replace(N=N), 200).final_state
        assert floquet(p.replace(N=N), guess=settled).stable
    assert found.unstable.shape == (1, 2)
    assert not floquet(p.replace(N=found.value)).stable


@pytest.mark.compiled
def test_a_pair_that_only_touches_the_axis_is_looked_for() -> None:
    """Between 10,200 and 10,300 N/m a pair passes through 1 and comes back: its angle has the same
    sign at both. The cycle folds twice there, and the motion from the static start settles on one of
    the two stable ones."""
    p = Parameters(N=182.84010057915575, Omega=9.219889478738258, normalization="orthonormal")
    found = critical.critical(p, "k_p", (10_100, 10_300), points=3)
    there = p.replace(k_p=10_233.7228)
    assert not floquet(there).stable
    assert floquet(there, guess=simulate(there, 150).final_state).stable
    inside = (found.values > 10_232) & (found.values < 10_235.5)
    assert inside.any()
    assert math.isnan(found.value)


def shares_of_meetings(angles: list[float], turns: list[float]) -> list[float]:
    """Where undamped multipliers of these angles meet while they turn by these."""
    before = np.exp(1j * np.array(angles))
    after = before * np.exp(1j * np.array(turns))
    return [each.share for each in spectrum.passings(spectrum.turns_of(before, after))]


def test_places_where_multipliers_meet_are_found_by_their_angles() -> None:
    """Linear in the share of the way, which is known then."""
    # two that cross each other, at equal angles
    assert shares_of_meetings([0.5, 0.6], [0.2, 0.0]) == pytest.approx([0.5])
    # one that comes to -1, and one to 1
    assert shares_of_meetings([math.pi - 0.1], [0.4]) == pytest.approx([0.25])
    assert shares_of_meetings([0.1], [-0.4]) == pytest.approx([0.25])
    assert shares_of_meetings([0.5, 1.0], [0.1, 0.1]) == []


def test_pairs_that_may_have_turned_back_at_the_axis_are_found() -> None:
    """Linear in the share of the way, which is known then."""
    # through the axis and back: from 0.1 to -0.3 looks like 0.3
    one = np.array([0.1, 2.0])
    two = np.array([0.3, 2.1])
    assert parameter_scan._returns_from_axis(one, two, 0.4) == pytest.approx([0.25])
    upside_down = parameter_scan._returns_from_axis(math.pi - one, math.pi - two, 0.4)
    assert upside_down == pytest.approx([0.25])
    assert parameter_scan._returns_from_axis(one, two, 0.1) == []


def test_a_pair_that_passes_another_is_no_pair_that_pushes_it_on() -> None:
    """Near 12,379 N/m a pair passes one that stays where it is. Matched by the sum of distances, each
    seemed to take the other's place, and the tongue between was overlooked."""

    def cycle(*angles: float) -> SimpleNamespace:
        upper = np.exp(1j * math.pi * np.array(angles))
        return SimpleNamespace(multipliers=np.concatenate([upper, upper.conj()]))

    shares = parameter_scan._doubtful_shares(cycle(0.808, 0.821), cycle(0.837, 0.821))
    assert any(share == pytest.approx(13 / 29, rel=1e-3) for share in shares)
    # of two cycles only one of which exists the middle is computed, and of none nothing
    without = SimpleNamespace(multipliers=np.zeros(0))
    assert parameter_scan._doubtful_shares(cycle(0.5), without) == [0.5]
    assert parameter_scan._doubtful_shares(without, cycle(0.5)) == [0.5]
    assert parameter_scan._doubtful_shares(without, without) == []
    # multipliers that turn far cannot be told apart
    assert 0.5 in parameter_scan._doubtful_shares(cycle(0.3), cycle(0.42))
    assert parameter_scan._doubtful_shares(cycle(0.3), cycle(0.32)) == []


@pytest.mark.slow
@pytest.mark.compiled
def test_scans_overlook_nothing_against_dense_ones(seed: int) -> None:
    """Eight parameters drawn, against 600 values each."""
    rng = np.random.default_rng(seed)
    ranges = {
        "Omega": (6, 25),
        "mu_s": (0.3, 0.6),
        "N": (100, 700),
        "k": (1e4, 2e5),
        "k_p": (1e4, 5e4),
        "c_p": (0, 1),
        "m": (0.03, 0.3),
        "mu_k": (0.1, 0.4),
        "c": (0, 1),
        "D_star": (1e-6, 5e-5),
    }
    too_high = 0
    for name in rng.choice([*ranges], 8, replace=False):
        log_N = rng.uniform(math.log(100), math.log(700))
        log_Omega = rng.uniform(math.log(8), math.log(30))
        normalization = str(rng.choice(["as_published", "orthonormal"]))
        p = Parameters(
            N=float(np.exp(log_N)), Omega=float(np.exp(log_Omega)), normalization=normalization
        )
        found = critical.critical(p, str(name), ranges[name])

        # the same by brute force
        values = np.linspace(*ranges[name], 600)
        motions = [floquet(p.replace(**{str(name): value})).motion for value in values.tolist()]
        grows = np.array([motion not in STABLE_CYCLES for motion in motions])

        said = np.zeros(len(values), bool)
        for low, high in found.unstable:
            said |= (values >= low) & (values <= high)
        # where the search from the static start misses a stable cycle, the motion tells
        for i in np.flatnonzero(grows & ~said):
            there = p.replace(**{str(name): float(values[i])})
            run = simulate(there, 150, stop_at="first_separation")
            grows[i] = not floquet(there, guess=run.final_state).stable

        # each stretch that is wider than the resolution was seen
        changes = np.flatnonzero(np.diff(grows)) + 1
        for run in np.split(np.arange(len(values)), changes):
            low = values[run[0]]
            high = values[run[-1]]
            if high - low > found.resolution:
                assert (said[run] == grows[run]).any(), (p, name, low, high)
        # a narrower stretch than the resolution may lie below
        if grows.any():
            too_high += int(not found.value <= values[grows][0])
    # of 91 scans against 1,199 values, none
    assert too_high <= 1


@pytest.mark.compiled
def test_bounds_may_have_units_and_those_of_another_kind_are_refused():
    p = Parameters(N=385, Omega=14.95, mu_k_over_mu_s=0.6)
    found = critical.critical(p, "Omega", ("142.5 rpm", "15 rad/s"), points=3)
    first = 142.5 * math.tau / 60
    last = 15
    ends = found.values[[0, -1]]
    assert ends.tolist() == pytest.approx([first, last])
    branch = continue_cycle(p, "Omega", ("142.5 rpm", "15 rad/s"))
    assert "the bound Omega = 14.9226 rad/s was reached" in branch.ended
    plane = neutral_curves(
        p, {"Omega": ("142.5 rpm", "15 rad/s"), "h": ("2 mm", "2.1 mm")}, [0.00205], points=2
    )
    assert plane.bounds["h"] == pytest.approx((2e-3, 2.1e-3))
    with refusal(r"^bounds='5 kg': must be a number in rad/s"):
        critical.critical(p, "Omega", ("5 kg", 15))
    with refusal(r"^mu_k=0\.24: must be <= mu_s=0\.1$"):
        critical.critical(Parameters(N=385, Omega=14.95), "mu_s", (0.1, 0.9))


@pytest.mark.parametrize(
    ("first", "crossings", "unstable_above", "unstable"),
    [
        (0.5, [0.5, 0.7], [True, False], [(0.5, 0.7)]),
        (0.0, [0.5, 0.7], [False, True], [(0.0, 0.5), (0.7, 1.0)]),
        (0.3, [0.3], [True], [(0.3, 1.0)]),
        (0.0, [], [], [(0.0, 1.0)]),
        (np.nan, [], [], []),
    ],
)
def test_intervals_of_instability_lie_between_crossings(
    first: float,
    crossings: list[float],
    unstable_above: list[bool],
    unstable: list[tuple[float, float]],
) -> None:
    found = critical.Critical(
        Parameters(N=385, Omega=15),
        "mu_s",
        first,
        np.array(crossings),
        np.array(unstable_above, dtype=bool),
        np.linspace(0, 1, 11),
        np.zeros(11),
        0.1,
    )
    assert [tuple(row) for row in found.unstable.tolist()] == unstable


def test_multipliers_meet_where_their_angles_come_to_a_whole_turn() -> None:
    """Two of the upper half, at 0.2 and 0.3 turns: with a conjugate at 0.5, itself at 0 or 0.5."""

    def shares(first: float, second: float) -> list[float]:
        angles = [0.2 * math.tau, 0.45 * math.tau]
        return shares_of_meetings(angles, [first * math.tau, second * math.tau])

    # the second comes to the real axis halfway, and with the first to half a turn never
    assert shares(0.0, 0.1) == pytest.approx([0.5])
    # the first comes to the second after 0.25 of 0.29 turns
    assert shares(0.29, 0.0) == pytest.approx([0.25 / 0.29])
    # both go down: the first comes to the axis at two thirds
    assert shares(-0.3, -0.1) == pytest.approx([2 / 3])
    assert shares(0.01, 0.01) == []


def test_a_pair_may_have_met_the_axis_if_its_way_there_and_back_is_no_longer_than_others() -> None:
    before = np.array([0.2, 0.5, np.pi - 0.3])
    after = np.array([0.1, 0.5, np.pi - 0.1])
    longest = 0.45 / parameter_scan.MAY_HAVE_MET
    found = parameter_scan._returns_from_axis(before, after, longest)
    assert found == pytest.approx([0.2 / 0.3, 0.3 / 0.4])


def test_a_pair_that_comes_to_the_axis_between_two_values_is_looked_for_in_the_middle() -> None:
    """Two real multipliers at one value, and a pair beside them at the other."""
    angle = 0.01
    pair = 0.99 * np.exp(1j * np.array([angle, -angle]))
    real = np.array([0.992 + 0j, 0.988 + 0j])
    assert 0.5 in parameter_scan._shares_of_change(real, pair)
    assert 0.5 in parameter_scan._shares_of_change(pair, real)
    assert 0.5 not in parameter_scan._shares_of_change(pair, 0.99 * pair)


@pytest.mark.parametrize(("share", "computed"), [(0.5, 3), (0.05, 2), (0.95, 2)])
def test_no_value_is_computed_very_close_to_another(
    share: float, computed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def shares(low: object, high: object) -> list[float]:
        return [share]

    monkeypatch.setattr(parameter_scan, "_doubtful_shares", shares)
    scan = parameter_scan.Scan(Parameters(N=1, Omega=1), "c", 1e-12)
    found: Any = SimpleNamespace(motion="steady_sliding")
    monkeypatch.setattr(parameter_scan, "find_cycle", lambda p, tol: found)
    for value in (0.0, 1.0):
        scan.is_stable(value)
    scan.refine(0.3, Bar(0))
    assert len(scan.motions) == computed


def test_neutral_sliding_is_not_said_to_be_stable() -> None:
    """Without a damper in the plane the slider's own mode neither grows nor decays."""
    block = Parameters(n_diameters=-1, N=100, Omega=10, c_p=0, mu_s=0.4, mu_k=0.4)
    found = critical.critical(block, "Omega", (5, 20), points=4, kind="sliding")
    assert found.message.startswith("steady sliding has no growing mode at any of the ")


def test_a_neutral_mode_does_not_hide_a_stretch_where_another_mode_grows() -> None:
    """Between values with a growth rate of 0, the search followed rounding errors."""

    def mode(x: float) -> Any:
        other = 0.1 - abs(x - 1.4)
        values = np.array([1e4j, -1e4j, other + 2e4j, other - 2e4j])
        growing = values[values.real > 0]
        rate = max(0.0, other)
        return SimpleNamespace(
            status=SlidingStatus.OK, eigenvalues=values, growing=growing, growth_rate=rate
        )

    scan = parameter_scan.SlidingScan(Parameters(N=1, Omega=1), "c", 1e-12)
    scan.motion_of = lambda case: mode(case.c)  # type: ignore[method-assign]
    for value in (0.0, 1.0, 2.0, 3.0):
        scan.is_stable(value)
    scan.refine(1e-3, Bar(0))
    assert any(not scan.is_stable(value) for value in scan.motions)


def test_sliding_that_is_neutral_throughout_takes_no_further_values() -> None:
    """Each third of the values was examined for an extreme of rounding errors."""
    block = Parameters(n_diameters=-1, N=100, Omega=10, c_p=0, mu_s=0.4, mu_k=0.4)
    found = critical.critical(block, "Omega", (5, 20), points=9, kind="sliding")
    assert found.values.size == 9
    np.testing.assert_array_equal(found.growth_rate, np.zeros(9))


def made_up(crossings: list[float], unstable_above: list[bool]) -> critical.Critical:
    """A result over values from 1 to 9 with these changes of stability."""
    return critical.Critical(
        parameters=BLOCK,
        name="Omega",
        value=math.nan,
        crossings=np.array(crossings),
        unstable_above=np.array(unstable_above),
        values=np.array([1.0, 9.0]),
        growth_rate=np.zeros(2),
        resolution=8.0,
    )


def test_the_border_is_where_the_motion_becomes_unstable_for_good() -> None:
    """Three arrays had to be combined for it, of each sample of a sweep."""
    assert made_up([2.0, 3.0, 5.0], [True, False, True]).border == 5.0
    assert math.isnan(made_up([2.0, 3.0], [True, False]).border)
    assert math.isnan(made_up([], []).border)


def test_cycles_that_never_stick_are_said_to_be_for_another_function() -> None:
    with refusal(r"kind='slipping': must be .*; cycles that never stick .* continue_cycle"):
        critical.critical(BLOCK, "c", (0, 1), kind="slipping")
