"""What motions come to: multipliers and early judgement against long simulations."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import yaml
from scipy.stats import qmc

from disc_model.analysis.classify import Motion, Settled
from disc_model.data.variables import Outcome
from disc_model.disc.plate import mode_arrays
from disc_model.engine.record import EVENT_ROW, LOSS_OF_CONTACT, STICK_TO_SLIP
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.states import State, perturb, slip_rate, static_start
from disc_model.stability import attractors
from disc_model.stability.attractors import Arrival, Basins, random_perturbation
from disc_model.stability.follower import OutcomeResult, find_outcome, growing
from disc_model.stability.segments import Segment, final_segment

P14 = Parameters(N=385, Omega=14)
SMALL = Parameters(N=200, Omega=20, n_diameters=1, c=20.0, D_star=1e-3)


def paradox() -> tuple[Parameters, State]:
    """A case and a state from which rigid friction has no solution."""
    p = Parameters(N=100, Omega=20, mu_k=50, mu_s=60, k_p=2e7, n_diameters=1)
    start = simulate(p, 1e-6).final_state
    return p, start.replace(phase="slip", direction=1, f=10.0, b=np.array([0.0, -2.0]))


# ------------------------------------------------------------------------ One motion
TEXTS = yaml.safe_load(Path(__file__).with_name("outcomes.yaml").read_text(encoding="utf-8"))
OUTCOMES = TEXTS["each outcome"]


@pytest.mark.parametrize(
    ("changes", "grows"),
    [
        ([1e-3, 1e-2], False),
        ([1e-3, 1e-2, 1e-2], True),
        ([1e-3, 1e-4, 1e-2, 1e-4, 1e-2, 1e-4], False),  # single ones are high
        ([1e-3, 1e-4, 1e-2, 1e-2, 1e-5], True),  # bounded later
        ([1e-2, 1.4e-2, 1.4e-2], False),
        ([1e-2, 1.4e-2, 1.8e-2, 1.9e-2], True),  # above the least of all that came before
        ([1e-9, 8e-9, 9e-9], False),  # the motion has arrived: rounding
        ([1e-9, 2e-8, 2e-8], True),
        ([1e-3, np.nan, 1e-2, np.nan], True),  # nan: there was no close return
        ([np.nan] * 4, False),
    ],
)
def test_two_successive_changes_that_have_risen_are_growth(
    changes: list[float], grows: bool
) -> None:
    assert growing(changes) is grows


@pytest.mark.compiled
@pytest.mark.parametrize("which", OUTCOMES)
def test_each_outcome_is_told(which: str) -> None:
    values, horizon, outcome = OUTCOMES[which]
    found = find_outcome(Parameters(**values), horizon)
    assert found.outcome is Outcome(outcome)
    assert math.isfinite(found.first_separation) == (outcome == Outcome.SEPARATION)


def test_a_simulation_that_fails_says_so() -> None:
    p, start = paradox()
    found = find_outcome(p, 1.0, start=start)
    assert found.outcome is None
    assert found.status.value == "paradox"
    assert found.message
    failed, nothing = final_segment(p, start, 0.1, 0.05, 1e-8)
    assert failed.status.value == "paradox"
    assert nothing is None


PLANES: tuple[dict[str, Any], ...] = (
    {"N": (50, 600), "Omega": (5, 50)},
    {"N": (50, 600), "Omega": (5, 50), "normalization": "orthonormal"},
    {"N": 300, "Omega": (5, 50), "k_p": (5e3, 1e5)},
    {"Omega": 15, "N": (50, 600), "c_p": (0, 1)},
)
MOST_WRONG = 0.05
"""Share of points at which shortcut and simulation may disagree: those where the outcome hangs on the last digit of a
long motion. At the 1304 points of the former coarse maps there was none."""


@pytest.mark.slow
@pytest.mark.compiled
def test_shortcuts_agree_with_brute_force() -> None:
    """Points spread over four planes: simulated throughout, to a horizon at which all outcomes
    occur."""
    horizon = 400.0
    points = 0
    simulated = 0.0
    disagree: list[tuple[dict[str, float], OutcomeResult, float]] = []
    for number, plane in enumerate(PLANES):
        varied = {name: bounds for name, bounds in plane.items() if isinstance(bounds, tuple)}
        for share in qmc.Halton(len(varied), seed=number).random(10):
            lows, highs = np.array(list(varied.values())).T
            values = lows + share * (highs - lows)
            at = dict(zip(varied, values.tolist(), strict=True))
            p = Parameters(**{**plane, **at})
            found = find_outcome(p, horizon)
            whole = find_outcome(p, horizon, early=False)
            points += 1
            simulated += found.simulated
            if math.isfinite(whole.first_separation) != (found.outcome is Outcome.SEPARATION):
                disagree.append((at, found, whole.first_separation))
            if found.outcome is Outcome.STICK_SLIP and found.simulated == 0.0:
                assert not growing(whole.changes), at
    assert len(disagree) <= MOST_WRONG * points, disagree
    assert simulated < 0.5 * points * horizon


def kick_energy(p: Parameters, state: State, start: State) -> float:
    """Of the difference of two states: the modes', that of the slider's mass and of its spring, and that
    of the mass on a surface that moves along."""
    omega = mode_arrays(p).omega
    moved = np.array([omega * (state.a - start.a), omega * (state.b - start.b)])
    speeds = np.array([state.alpha - start.alpha, state.beta - start.beta])
    slider = p.k * (state.u - start.u) ** 2 + p.m * (state.u_velocity - start.u_velocity) ** 2
    along = p.m * (p.r_0 * (state.f - start.f)) ** 2
    return 0.5 * (float(np.sum(moved**2) + np.sum(speeds**2)) + slider + along)


def test_a_kick_of_the_surface_has_the_energy_asked_for() -> None:
    p = P14.replace(friction_offset=0.02)
    start = static_start(p)
    kicked = random_perturbation(p, start, 0.3, (1, 0, 5))
    assert kick_energy(p, kicked, start) == pytest.approx(0.3, rel=1e-12)


def test_a_kick_has_the_energy_asked_for_and_its_direction_hangs_on_its_key_alone() -> None:
    start = static_start(P14)
    one, again, other = (random_perturbation(P14, start, 0.3, (1, 0, i)) for i in (5, 5, 6))
    # differences of the static deflection lose some of its 16 digits
    assert kick_energy(P14, one, start) == pytest.approx(0.3, rel=1e-12)
    # slider and disc go along
    assert one.u == pytest.approx(float(mode_arrays(P14).psi @ one.a), rel=1e-14)
    assert np.array_equal(one.beta, again.beta)
    assert not np.array_equal(one.a, other.a)
    # modes without nodal diameter have no second component
    assert not one.b[mode_arrays(P14).diameters == 0].any()
    assert random_perturbation(P14, start, 0.0, (1, 0, 5)) is start


@pytest.mark.compiled
def test_a_periodic_attractor_is_known_by_its_fixed_point() -> None:
    """The separating motion at 14 rad/s separates once between two releases of stick, again and
    again."""
    basins = Basins(P14, 100.0)
    quiet, separating = basins.known
    assert separating.kind == Outcome.SEPARATING
    assert separating.releases == 1
    # one separation more or less in a leg of five seconds
    in_a_period = separating.period * separating.segment.separation_rate
    assert in_a_period == pytest.approx(1, abs=1 / (5 * 135))
    assert quiet.kind == Outcome.STICK_SLIP
    assert quiet.segment.separation_rate == 0
    assert quiet.points is not None


@pytest.mark.compiled
def test_a_torus_is_an_attractor_once_the_record_shows_that_the_motion_has_settled() -> None:
    """After a small kick it takes 300 s, and a record of 200 s after that."""
    p = Parameters(N=385, Omega=10)
    kick = random_perturbation(p, static_start(p), 0.01, (1, 0, 0))
    kinds = [Basins(p, horizon).follow(kick).outcome for horizon in (300.0, 500.0)]
    assert kinds == [Outcome.UNDECIDED, Outcome.QUASI_PERIODIC]


def stretch(**changes: float) -> Segment:
    """Of a separating motion, for tests of what is said of one."""
    segment = Segment(
        P_min=0.0,
        P_max=1.0,
        u_min=-0.01,
        u_max=0.01,
        stick_fraction=0.25,
        slip_fraction=0.65,
        separation_fraction=0.10,
        separation_rate=135.0,
    )
    return replace(segment, **changes)


def legs_with(losses: Any, releases: Any = (), end: float = 100.0) -> list[Any]:
    """A record of 100 s in two legs, with losses of contact and releases at some times (s)."""
    times = np.concatenate([losses, releases])
    rows = np.zeros((times.size, len(EVENT_ROW)))
    rows[:, EVENT_ROW.index("time")] = times
    rows[:, EVENT_ROW.index("kind")] = [LOSS_OF_CONTACT] * len(losses) + [STICK_TO_SLIP] * len(
        releases
    )
    rows = rows[np.argsort(times)]
    cut = np.searchsorted(rows[:, EVENT_ROW.index("time")], 70.0)
    parts = [(rows[:cut], 70.0), (rows[cut:], end)]
    return [
        SimpleNamespace(event_rows=part, final_state=SimpleNamespace(time=stop))
        for part, stop in parts
    ]


# ------------------------------------------------------------------------ Comparison of attractors


@pytest.mark.parametrize(
    ("rate", "error", "separates", "kind"),
    [
        (0.05, 0.001, True, Outcome.IRREGULAR),
        (-0.05, 0.001, True, Outcome.SEPARATING),
        (-0.05, 0.001, False, Outcome.OTHER_CYCLE),
        (0.05, 0.02, True, Outcome.QUASI_PERIODIC),  # within four standard errors
        (-0.05, 0.02, True, Outcome.QUASI_PERIODIC),
        (math.nan, 0.001, True, Outcome.UNDECIDED),
        (-math.inf, 0.001, True, Outcome.UNDECIDED),
        (0.05, math.nan, True, Outcome.UNDECIDED),
    ],
)
def test_a_motion_that_does_not_repeat_is_named_by_its_largest_exponent(
    rate: float, error: float, separates: bool, kind: Outcome, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Intervals of the golden rotation never repeat; those of releases do, every 10 ms."""
    count = 60
    even = 0.01 * np.arange(1, count + 1)
    uneven = np.cumsum(0.01 + 1e-3 * np.cos(2 * np.pi * 0.6180339887 * np.arange(count)))
    found = SimpleNamespace(exponents=np.array([rate]), errors=np.array([error]))
    monkeypatch.setattr(attractors, "lyapunov_exponents", lambda *_, **__: found)

    def regularity(times: Any) -> Motion:
        [run, _] = legs_with(times, even) if separates else legs_with([], times)
        run.status = Status.OK
        monkeypatch.setattr(attractors, "simulate", lambda *_, **__: run)
        return attractors.regularity(P14, static_start(P14), 1e-10)

    motion = regularity(uneven)
    assert motion.kind == kind
    assert motion.period == 0
    # a period shows without exponents
    assert regularity(even).period > 0
    assert regularity(even[:10]).kind is Outcome.UNDECIDED


@pytest.mark.compiled
def test_a_stay_is_doubled_until_it_has_settled_and_no_further(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """From a value inside the sweep rises to the last, and falls to the first."""
    stays = {10.0: 0.1, 11.0: 0.2, 12.0: 0.4}  # 0.4 s are allowed

    def settles(p: Parameters, legs: Any) -> Arrival:
        done = 0.1 * 2 ** (len(legs) - 1) >= {10.0: 0.1, 11.0: 0.2, 12.0: 9.0}[p.Omega]
        return Arrival(Settled.SETTLED if done else Settled.UNDECIDED)

    monkeypatch.setattr(attractors, "arrival", settles)
    swept = [*attractors.sweep(P14, "Omega", [*stays], 0.1, 0.5, 0.05, 1e-8, lowest=1)]
    assert [step for step, *_ in swept] == [(0, 1), (0, 2), (1, 2), (1, 1), (1, 0)]
    begin = 0.0
    for (_, i), run, segment, reached in swept:
        assert reached.stay == [*stays.values()][i]
        assert segment is not None
        # the late segment comes after the stay
        assert run.final_state.time == pytest.approx(begin + reached.stay + 0.05)
        begin = run.final_state.time


# ------------------------------------------------------------------------ Motions without stick
EVEN = np.arange(5, 99.995, 0.01)
UNEVEN = EVEN + np.where(np.arange(EVEN.size) % 2, 1e-3, 0.0)
UNEVEN[:3000] += np.geomspace(1e-3, 1e-9, 3000)  # a transient, up to the last 40 s


@pytest.mark.parametrize(
    ("legs", "repeats"),
    [
        (legs_with(UNEVEN, releases=[20.0, 59.0]), True),
        (legs_with(EVEN + 1e-5 * np.sin(EVEN)), False),  # a beat
        (legs_with(EVEN + 2e-8 * EVEN**2), False),  # a drift of 4e-12 s each time
        (legs_with(EVEN, releases=[61.0]), False),
        (legs_with(EVEN[EVEN > 65]), False),  # since too short a time
        (legs_with(EVEN[EVEN < 90]), False),  # it has ceased
        (legs_with([]), False),
    ],
)
def test_a_motion_that_never_sticks_has_settled_if_its_losses_of_contact_repeat(
    legs: list[Any], repeats: bool
) -> None:
    assert (attractors.settling_of(legs) is Settled.SETTLED) == repeats


@pytest.mark.compiled
def test_a_motion_that_slips_and_loses_contact_repeats_after_a_transient() -> None:
    """Transients decay at half the damping of the modes, about 0.1/s: they are seen after 60 s, not
    after 240 s, nor at any later time."""
    p = Parameters(N=350, Omega=24)
    rest = static_start(p)
    state = perturb(p, rest, u=-3 * abs(rest.u))
    for end, settled in ((60, False), (240, True), (600, True)):
        run = simulate(p, end, tol=1e-8, initial_state=state)
        state = run.final_state
        reached = attractors.arrival(p, [run])
        assert reached.near is None
        assert (reached.answer is Settled.SETTLED) == settled


# ------------------------------------------------------------------------ Cycles and perturbations
def test_a_perturbation_leaves_contact_and_the_slip_speed_as_they_are() -> None:
    """The slider's height follows the disc under it, and its rotation the disc's surface: the state
    is consistent, so that the engine changes nothing of it."""
    p = Parameters(N=385, Omega=14, friction_offset=5e-3)
    events = simulate(p, 0.5).events
    released = events["time"][events["kind"] == "stick_to_slip"].iloc[0]
    state = simulate(p, released + 1e-4).final_state
    assert state.phase == "slip"
    kicked = random_perturbation(p, state, 1e-3, (1, 2, 3))
    # far more than rounding
    assert abs(kicked.f - state.f) > 1e-3
    assert slip_rate(p, kicked) == pytest.approx(slip_rate(p, state), rel=1e-9)
    known = simulate(p, 1e-12, initial_state=kicked.replace(time=0.0)).final_state
    assert known.u == pytest.approx(kicked.u, rel=1e-6)
    assert known.u_velocity == pytest.approx(kicked.u_velocity, rel=1e-6)
