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
from disc_model.stability import critical, parameter_scan
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
def test_a_pair_that_only_touches_the_axis_is_looked_for() -> None:
    """Between 10,200 and 10,300 N/m a pair passes through 1 and comes back: its angle has the same
    sign at both. The cycle folds twice there, and the search finds the unstable one in between."""
    p = Parameters(N=182.84010057915575, Omega=9.219889478738258, normalization="orthonormal")
    found = critical.critical(p, "k_p", (10_100, 10_300), points=3)
    there = p.replace(k_p=10_233.7228)
    assert not floquet(there).stable
    assert floquet(there, guess=simulate(there, 150).final_state).stable
    inside = (found.values > 10_232) & (found.values < 10_235.5)
    assert inside.any()
    assert found.crossings.shape == (2,)


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
    p = Parameters(N=385, Omega=14.95)
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
