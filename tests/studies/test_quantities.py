"""Quantities of studies: what functions of a case say of motions that are known, and what they refuse."""

import importlib
import math
import pickle
from collections.abc import Callable, Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy import stats

import disc_model as dm
from disc_model.analysis.classify import Settled
from disc_model.analysis.contact_loss import excess_of_flights
from disc_model.data.variables import OF_QUANTITIES, CycleStatus, Outcome
from disc_model.errors import Status
from disc_model.parameters import Parameters
from disc_model.stability import attractors
from disc_model.stability.follower import Attractor, NearCycle, OutcomeResult
from disc_model.studies.quantity import HOMES, Range, quantity_of
from tests.refusals import refusal
from tests.stability.test_attractor import stretch

P = Parameters(N=385, Omega=14)
SEPARATED = {"prerun": {"parameters": {"Omega": 15.1}, "time": 70}}
NARROW = {"distribution": "uniform", "low": 0.9999, "high": 1.0001, "relative": True}
FALLING = P.replace(Omega=15, mu_s=0.3, mu_k=0.2, friction_decay=2.0, normalization="orthonormal")


def function_of(name: str) -> Callable[..., xr.Dataset]:
    """The public function of a quantity, which checks its options and returns words."""
    module = importlib.import_module(f"disc_model.studies.quantities.{HOMES[name]}")
    function: Callable[..., xr.Dataset] = getattr(module, name)
    return function


def message_of(found: xr.Dataset) -> str:
    return str(found.attrs["message"])


# ---- All quantities

TABLE: list[tuple[str, Parameters, dict[str, Any], dict[str, Any]]] = [
    (
        "floquet",
        P.replace(N=300),
        {},
        {"growth_rate": 0.06907159, "period": 0.014554692, "stick_fraction": 0.2358604},
    ),
    (
        "lyapunov_exponents",
        P.replace(Omega=15.1),
        {"transient": 15, "duration": 5, "start": SEPARATED},
        {"exponent": [-0.1496, -0.1544], "converged": ["no", "no"], "averaging_time": 5},
    ),
    (
        "neutral_curves",
        P,
        {"bounds": (14.5, 15.5), "lines": (370, 385), "points": 9, "max_points": 12},
        {"kind": ["fold", "none"], "resonance_frequency": 135.419172, "n_curves": 1},
    ),
    (
        "sliding_modes",
        FALLING,
        {"bounds": (10, 50), "step": 20},
        {"unstable_modes": [1, 3, 3], "largest_growth_rate": [42.786285, 7.8807809, 3.2208469]},
    ),
    (
        "outcome",
        P.replace(Omega=15.1),
        {"horizon": 100},
        {"outcome": "separation", "first_separation": 54.418906, "time_reached": 59.418906},
    ),
    (
        "bifurcation",  # once for each of the two separations in a period
        P.replace(Omega=14.5),
        {"transient": 60, "samples": 4, "start": SEPARATED},
        {"psi": [0.0544399, 0.0719417] * 2, "period_events": 2, "kind": "separating"},
    ),
    (
        "branches",  # the fold lies at 15.0949 rad/s
        P,
        {"bounds": (14.75, 15.25), "step": 0.25, "dwell": 60},
        {"n_branches": 2, "separations": [0, 2], "sweep_range": [8.896294e-05, 1.5593372e-04]},
    ),
    (
        "hysteresis",
        P,
        {"bounds": (14, 16), "dwell": 20, "max_dwell": 80},
        {"onset_speed": 16, "offset_speed": math.nan, "stay": [20, 20, 80, 20, 20, 20]},
    ),
    (
        "critical_speed",
        P,
        {"bounds": (15, 16), "step": 0.5, "horizon": (50, 100)},
        {"critical_speed": [15.3, 15.1], "n_crossings": [1, 1], "simulations": 6},
    ),
    (
        "basins",
        P,
        {"energies": (1e-4, 0.1), "n_starts": 3, "horizon": 60},
        {"critical_energy": 0.0707107, "attractor_starts": [3, 3], "separating_fraction": 0.5},
    ),
    (
        "campbell",  # at 7.35 rad/s the motion is near another cycle, of 0.0004/s
        P.replace(N=375),
        {"bounds": (7.3, 7.4), "step": 0.05},
        {"near_motion": [1, 0, 1], "growth_rate": [8.115285e-4, 0.2788523, 3.201901e-4]},
    ),
    (
        "sensitivity",
        P.replace(N=260, Omega=19),
        {"distributions": {"k": NARROW}, "samples": 2, "simulated_samples": 2},
        {"outcome": ["separation"] * 2, "probability_separation": 1.0},
    ),
    (
        "locking",
        P.replace(N=300, Omega=20),
        {"start": {"prerun": {"parameters": {}, "time": 300}}, "probes": 2},
        {"period_releases": 45, "period_separations": 316, "leading_multiplier": 0.7792300},
    ),
    (
        "ramps",  # onset comes late, and the end far below
        P,
        {"bounds": (8, 22), "dwell": 20, "rates": (0.05, 0.1)},
        {"onset_speed": [17.350035, 19.032361], "offset_speed": [9.427039, 9.244294]},
    ),
    (
        "ramps",  # at the top it separates once in each vibration of 135.4 Hz
        P,
        {"bounds": (8, 22), "dwell": 20, "rates": (0.1,)},
        {"top_separation_rate": 135.35},
    ),
    (
        "range_law",
        P.replace(Omega=15.1),
        {"horizon": 3, "displaced_horizon": 20},
        {"range": [math.nan, 0.03517120], "deviation": [math.nan, 0.02223191]},
    ),
    (
        "regions",
        P.replace(N=100),
        {"horizon": 50},
        {"cycle": "followed", "growth_rate": -0.0031225616},
    ),
]
"""Quantity, case, options, and values of variables, of which arrays may have more."""


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("name", "case", "options", "expected"), TABLE, ids=[row[0] for row in TABLE]
)
def test_a_quantity_says_what_is_known(
    name: str, case: Parameters, options: dict[str, Any], expected: dict[str, Any]
) -> None:
    found = function_of(name)(case, **options)
    assert {*found["status"].values.ravel()} == {"ok"}
    for variable, values in expected.items():
        first = found[variable].values.ravel()[: np.size(values)].tolist()
        if isinstance(first[0], str):
            assert first == np.atleast_1d(values).tolist()
        else:
            rough = 1e-3 if name == "lyapunov_exponents" else 1e-6
            assert first == pytest.approx(np.atleast_1d(values).tolist(), rel=rough, nan_ok=True)
    columns = OF_QUANTITIES[name]["columns"]
    assert {*found.data_vars} >= {*columns}
    for variable, array in found.data_vars.items():
        assert array.attrs["long_name"], variable
        missing = array.dtype.kind == "f" and bool(np.isnan(array.values).any())
        assert not missing or "missing" in array.attrs, f"{variable} does not say why it is nan"


@pytest.mark.parametrize("name", HOMES)
def test_a_quantity_can_be_sent_to_other_processes(name: str) -> None:
    function = quantity_of(name).function
    assert pickle.loads(pickle.dumps(function)) is function
    assert pickle.loads(pickle.dumps(function_of(name))) is function_of(name)


SWEEP = {"bounds": (10, 20), "step": 5, "dwell": 10}
FAULTS: list[tuple[str, dict[str, Any], str]] = [
    ("hysteresis", SWEEP | {"dwell": 0.1}, "evaluation_time=5 must be <= dwell=0.1"),
    ("hysteresis", SWEEP | {"max_dwell": 5}, "max_dwell=5 must be >= dwell=10"),
    ("hysteresis", SWEEP | {"step": 3}, "must be a multiple of step=3"),
    ("branches", SWEEP | {"sweep_from": 21}, "sweep_from=21 must be <= the greatest value, 20"),
    ("locking", {"record": 5, "max_record": 4}, "record=5 must be <= max_record=4"),
    (
        "outcome",
        {"horizon": 0.5},
        "evaluation_time=1 must be <= after_separation=5 and <= horizon=0.5",
    ),
    ("outcome", {"horizon": 5, "scan": 1}, "scan=1: unknown"),
    ("outcome", {"start": {"w": 1}}, "start.*w"),
    ("ramps", {"bounds": (3, 2), "rates": [1]}, "must ascend"),
    ("ramps", {"bounds": (2, 3), "rates": {"start": 0, "stop": 1, "count": 2}}, "must be > 0"),
    ("range_law", {"horizon": 1}, "horizon=1 must be > 2"),
    (
        "critical_speed",
        {"step": 0.5, "precision": 0.2},
        "step=0.5 rad/s must be a multiple of precision=0.2",
    ),
    ("critical_speed", {"bounds": 14}, "bounds=14"),
    ("critical_speed", {"bounds": (15, 14)}, "start=15 must be < stop=14"),
    ("critical_speed", {"bounds": (0, 1e6), "step": 1}, "must be at most 100000 values"),
    ("basins", {"energies": [0, 1], "n_starts": 2}, "n_starts=2 must be 1 where an energy is 0"),
    ("basins", {"energies": [2, 1]}, "must ascend"),
    (
        "sensitivity",
        {"distributions": {"k": NARROW}, "samples": 3},
        "samples=3 must be a power of two",
    ),
    ("sensitivity", {"distributions": {"k": NARROW | {"low": 2}}}, "low=2 must be < high=1.0001"),
    ("sensitivity", {"distributions": {"kk": NARROW}}, "must be of a parameter that is a number"),
    ("neutral_curves", {"bounds": (1, 2), "lines": [1], "x": "N"}, "x and y must differ"),
    ("bifurcation", {"transient": 500}, "max_transient=480 must be >= transient=500"),
]
"""Options that cannot be, and what is said of them."""


@pytest.mark.parametrize(("name", "options", "said"), FAULTS)
def test_what_cannot_be_is_said(name: str, options: dict[str, Any], said: str) -> None:
    with refusal(said):
        function_of(name)(P, **options)


def test_ranges_have_equal_steps_or_equal_ratios_and_both_ends() -> None:
    assert Range(start=1, stop=2, step=0.25).values == [1, 1.25, 1.5, 1.75, 2]
    assert Range(start=0.1, stop=0.5, count=5).values == [0.1, 0.2, 0.3, 0.4, 0.5]
    assert Range(start=2, stop=162, count=5, scale="log").values == [2, 6, 18, 54, 162]


# ---- Critical speeds

CROSSINGS = [
    # separation after so many seconds from a speed on, horizons, critical speeds, crossings of the first
    ({13.4: 10.0}, (900,), [13.4], [(13.4, "begins")]),
    ({13.0: 10.0, 14.2: math.inf}, (900,), [13.0], [(13.0, "begins"), (14.2, "ends")]),
    ({12.0: 10.0}, (900,), [12.0], []),
    ({13.0: 50.0, 14.0: 5.0}, (10, 50), [14.0, 13.0], [(14.0, "begins")]),
    ({13.0: math.nan, 14.0: 5.0}, (10,), [math.nan], []),  # an unknown speed hides those above it
]


def moving(first: dict[float, float]) -> Callable[..., OutcomeResult]:
    """Motions whose first separation comes after so many seconds from a speed on."""

    def find_outcome(p: Parameters, horizon: float, **_: Any) -> OutcomeResult:
        reached = [time for speed, time in first.items() if p.Omega > speed - 1e-6]
        time = reached[-1] if reached else math.inf
        if math.isnan(time):
            lost: Any = SimpleNamespace(status=Status.NON_FINITE, message="lost")
            return OutcomeResult(failed=lost)
        return OutcomeResult(simulated=2.0, first_separation=time if time <= horizon else math.nan)

    return find_outcome


@pytest.mark.parametrize(("first", "horizons", "speeds", "crossings"), CROSSINGS)
def test_every_crossing_is_found_and_bisected(
    first: dict[float, float],
    horizons: tuple[float, ...],
    speeds: list[float],
    crossings: list[tuple[float, str]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("disc_model.stability.follower.find_outcome", moving(first))
    found = dm.critical_speed(P, (12, 15), horizons, step=0.5)
    assert found["critical_speed"].values == pytest.approx(speeds, nan_ok=True)
    for i, (speed, kind) in enumerate(crossings):
        assert found["crossing"].values[0, i] == pytest.approx(speed)
        assert found["crossing_kind"].values[0, i] == kind
    assert found["n_crossings"].values[0] == len(crossings)
    assert found["simulated_time"] == 2 * found["simulations"] or math.isnan(speeds[0])


@pytest.mark.parametrize(
    ("horizon", "speed", "least"), [(900, 16, math.nan), ([5, 900], 12, 12), (900, 13, 13)]
)
def test_a_critical_speed_may_be_the_lowest_of_the_scan_or_missing(
    horizon: Any, speed: float, least: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("disc_model.stability.follower.find_outcome", moving({speed: 10.0}))
    found = dm.critical_speed(P, (12, 15), horizon)
    assert message_of(found) == ""
    assert found["critical_speed"].values.ravel()[-1] == pytest.approx(least, nan_ok=True)
    assert found["critical_speed"].ndim == np.ndim(horizon)
    assert bool(found["at_lower_bound"].values.any()) == (speed == 12)


def test_what_has_no_room_is_told() -> None:
    modes = dm.sliding_modes(FALLING, bounds=(10, 50), step=20, modes=4)
    assert message_of(modes) == "10 were found along mode, which has room for 4"
    every = dm.sliding_modes(FALLING, bounds=(10, 50), step=20)
    np.testing.assert_array_equal(modes["frequency"], every["frequency"][:, :4])


# ---- Hysteresis

LOST: Any = SimpleNamespace(status=Status.NON_FINITE, message="lost")
SWEEPS = [
    # separation rates up and down, onset, offset
    ([[0, 0, 0], [0, 0, 0]], math.nan, math.nan),
    ([[0, 0, 9], [9, 9, 9]], 16, math.nan),
    ([[9, 9, 9], [0, 9, 9]], math.nan, 14),
    ([[0, 9, 0], [0, 0, 0]], 14, math.nan),
    ([[0, 0, 9], [0, 9, 9]], 16, 14),
    ([[0, 0, 9], [9, 0, 9]], 16, 16),  # a gap ends it, though it begins again below
    ([[0, 0, 9], [None, 9, 9]], 16, math.nan),
]


@pytest.mark.parametrize(("rates", "onset", "offset"), SWEEPS)
def test_a_sweep_has_an_onset_and_an_end_between_its_bounds(
    rates: list[list[Any]], onset: float, offset: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    def sweep(*_: Any) -> Iterator[Any]:
        settled = attractors.Arrival(Settled.SETTLED)
        for place in [(0, 0), (0, 1), (0, 2), (1, 2), (1, 1), (1, 0)]:
            rate = rates[place[0]][place[1]]
            late = None if rate is None else stretch(separation_rate=rate)
            yield place, LOST, late, settled

    monkeypatch.setattr(attractors, "sweep", sweep)
    found = dm.hysteresis(P, (12, 16), 10, step=2)
    assert found["onset_speed"].item() == pytest.approx(onset, nan_ok=True)
    assert found["offset_speed"].item() == pytest.approx(offset, nan_ok=True)
    failed = "Omega = 12 rad/s: lost" if None in rates[1] else ""
    assert message_of(found) == failed


# ---- Basins

CALM = stretch(u_min=0, u_max=1e-5, separation_rate=0, stick_fraction=0.3, separation_fraction=0)
NEAR = Attractor(Outcome.STICK_SLIP, CALM, 0.015, 1, np.zeros((1, 2)))
APART = Attractor(Outcome.SEPARATING, stretch(u_min=0, u_max=0.03))
UNDECIDED = OutcomeResult(Outcome.UNDECIDED, 60.0)
FAILED = OutcomeResult(None, 1.0, failed=LOST)


@pytest.fixture
def kicked(monkeypatch: pytest.MonkeyPatch) -> Callable[..., xr.Dataset]:
    """Basins of made-up starts: start i separates beyond an energy, or comes to what is said."""

    def found(
        least: Callable[[int], float] = lambda i: 0.02 * (i + 1),
        known: dict[int, OutcomeResult] | None = None,
        **options: Any,
    ) -> xr.Dataset:
        def follow(_: Any, start: tuple[float, int]) -> OutcomeResult:
            energy, i = start
            attractor = APART if energy > least(i) else NEAR
            return (known or {}).get(i, OutcomeResult(attractor.kind, 50.0, attractor=attractor))

        made = type("Made", (), {"__init__": lambda *_, **__: None, "follow": follow})
        monkeypatch.setattr(attractors, "Basins", made)
        monkeypatch.setattr(
            attractors, "random_perturbation", lambda p, s, energy, key: (energy, key[2])
        )
        return dm.basins(P, **options)

    return found


def test_shares_are_counted_with_wilsons_intervals(kicked: Callable[..., xr.Dataset]) -> None:
    """Three of ten: 0.108 to 0.603 at 95 % (Wilson 1927)."""
    found = kicked(energies=[0.07], n_starts=10)
    of_class = found.sel(attractor_class="separating")
    for share in ("basin_fraction", "separating_fraction"):
        assert of_class[share] == 0.3
        both = of_class[f"{share}_low"].item(), of_class[f"{share}_high"].item()
        assert both == pytest.approx((0.1078, 0.6032), abs=1e-4)
    assert found["attractor_starts"].values[:3].tolist() == [7, 3, 0]
    assert found["attractor_index"].values[0].tolist() == [2, 2, 2, *[1] * 7]


@pytest.mark.parametrize(
    ("undecided", "ends"), [(4, (0.0, 1.0)), (2, (0.0456, 0.9544)), (0, (0.15, 0.85))]
)
def test_undecided_starts_widen_intervals(
    kicked: Callable[..., xr.Dataset], undecided: int, ends: tuple[float, float]
) -> None:
    known = dict.fromkeys(range(undecided), UNDECIDED)
    found = kicked(lambda i: 1.0 * (i % 2), known, energies=[0.5], n_starts=4)
    both = found["separating_fraction_low"].item(), found["separating_fraction_high"].item()
    assert both == pytest.approx(ends, abs=1e-4)
    assert found["basin_fraction"].sum() == pytest.approx(1)


ENERGIES = [
    # least separating energy by start, critical energy
    (lambda i: 0.02 * (i + 1), 0.02),
    (lambda i: -1.0, 0.0),
    (lambda i: (0.04, 0.01, 9)[i], 0.04),
    (lambda i: 9.0, math.nan),
]


@pytest.mark.parametrize(("least", "energy"), ENERGIES)
def test_the_least_kick_is_bisected(
    kicked: Callable[..., xr.Dataset], least: Any, energy: float
) -> None:
    found = kicked(least, energies=[0.05, 1.0], n_starts=3)
    assert found["critical_energy"].item() == pytest.approx(energy, rel=0.05, nan_ok=True)


@pytest.mark.parametrize(
    ("known", "status", "said"),
    [
        ({0: FAILED}, "ok", "1 of 3 starts failed, such as lost"),
        (dict.fromkeys(range(3), FAILED), "non_finite", "3 of 3 starts failed, such as lost"),
        (
            {0: UNDECIDED, 1: replace(UNDECIDED, first_separation=2.0)},
            "ok",
            "2 of 3 starts undecided within the horizon: raise it",
        ),
    ],
)
def test_starts_of_which_nothing_is_known_are_told(
    kicked: Callable[..., xr.Dataset], known: Any, status: str, said: str
) -> None:
    found = kicked(known=known, energies=[0.01], n_starts=3)
    assert found["status"] == status
    assert message_of(found) == said


# ---- Campbell diagrams

SPEEDS = np.linspace(8, 12, 401)
MEETING = 10.0  # rad/s, where the stick-slip frequency of 10 Omega meets the mode of 100 Hz
NOWHERE = np.full(401, math.nan)
MADE_UP: list[tuple[dict[str, Any], list[tuple[float, float]]]] = [
    # frequencies, and whether the motion is near the cycle; crossings: speed, multiple
    ({}, [(10, 1)]),
    ({"releases": 20 * SPEEDS}, [(10, 0.5)]),
    ({"releases": 4 * SPEEDS - 0.01}, [(8.335833, 3), (10.0025, 2.5)]),
    # none within a gap, nor where the frequency jumps over that of the mode
    ({"near": np.where(np.abs(SPEEDS - MEETING) < 0.055, 0.0, math.nan)}, []),
    ({"releases": np.where(SPEEDS < MEETING - 0.005, 9 * SPEEDS, 11 * SPEEDS)}, []),
]


@pytest.mark.parametrize(("made", "crossings"), MADE_UP)
def test_crossings_are_where_frequencies_meet(
    made: dict[str, Any], crossings: list[tuple[float, float]], monkeypatch: pytest.MonkeyPatch
) -> None:
    at = {"releases": 10 * SPEEDS, "near": NOWHERE, **made}
    modes = SimpleNamespace(
        frequency=np.array([100.0]),
        growth_rate=np.array([-1.0]),
        diameters=np.array([1]),
        forward=np.array([0.5]),
    )

    def frequencies(p: Parameters, tol: float) -> Any:
        i = int(np.argmin(np.abs(SPEEDS - p.Omega)))
        cycle = SimpleNamespace(
            status=CycleStatus.OK,
            growth_rate=-0.1,
            releases=1,
            period=1 / at["releases"][i],
            sliding=SimpleNamespace(growth_rate=0.0),
            near=at["near"][i],
            message="",
        )
        return cycle, modes, (np.array([100.0]), np.array([-0.1]), np.array([1.0]))

    monkeypatch.setattr("disc_model.stability.frequencies.frequencies", frequencies)
    monkeypatch.setattr("disc_model.stability.frequencies.may_be_near", lambda cycle: cycle.near)
    found = dm.campbell(P, bounds=(8, 12), step=0.01)
    count = found["n_crossings"].item()
    names = ("crossing_Omega", "crossing_multiple")
    speeds, multiples = (found[name].values[:count] for name in names)
    assert speeds == pytest.approx([speed for speed, _ in crossings], abs=1e-6)
    assert multiples.tolist() == [multiple for _, multiple in crossings]


# ---- Sensitivity


def test_samples_are_of_the_distributions_and_more_of_them_keep_the_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def find_cycle(p: Parameters, tol: float) -> Any:
        motion = "unstable" if p.k > 5e4 else "stable"
        return SimpleNamespace(motion=motion, growth_rate=p.k)

    monkeypatch.setattr("disc_model.stability.cycle.find_cycle", find_cycle)
    ends = {"k": {"low": 4e4, "high": 6e4}, "mu_k": {"low": 0.2, "high": 0.5}}
    distributions = {name: {"distribution": "uniform", **pair} for name, pair in ends.items()}
    few, many = (
        dm.sensitivity(P, distributions=distributions, samples=n, seed=3) for n in (16, 256)
    )
    drawn = many["parameter_values"].sel(parameter="k").values
    np.testing.assert_array_equal(few["parameter_values"], many["parameter_values"][:16])
    shares = (np.sort(drawn) - 4e4) / 2e4
    assert np.max(np.abs(shares - (np.arange(256) + 0.5) / 256)) < 0.5 / 256
    # mu_k above mu_s makes no case: a third of the samples has failed, and says so
    ok = many["status"].values == "ok"
    assert 0.6 < ok.mean() < 0.7
    assert "must be <= mu_s" in str(many["message"].values[~ok][0])
    hits = int((drawn[ok] > 5e4).sum())
    assert many["n_failed_cycles"] == (~ok).sum()
    assert many["probability_unstable"] == hits / ok.sum()
    least = stats.binomtest(hits, 256).proportion_ci(0.95, "wilson").low
    assert many["probability_unstable_low"].item() == pytest.approx(least)


# ---- Regions


def near(*, stable: bool = False) -> NearCycle:
    """A cycle that the static start follows."""
    known = {"growth_rate": 0.1, "period": 0.015, "releases": 1, "separations": 0, "parameters": P}
    cycle: Any = SimpleNamespace(stable=stable, **known)
    map_: Any = SimpleNamespace(deflection=1.0)
    return NearCycle(cycle, True, map_, np.zeros(2), np.zeros(2), np.eye(2))


NO_CYCLE = SimpleNamespace(motion=CycleStatus.NO_CYCLE)
STARTS = [
    # what the search finds, method, outcome, what is said of the cycle
    (near(stable=True), "multipliers", "stick_slip", "followed"),
    (near(), "simulation", "separation", "followed"),
    (NO_CYCLE, "simulation", "separation", "no_cycle"),
]


@pytest.mark.parametrize(("start", "method", "outcome", "cycle"), STARTS)
def test_a_region_says_how_its_outcome_is_known(
    start: Any, method: str, outcome: str, cycle: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    separation = OutcomeResult(Outcome.SEPARATION, 1.0, first_separation=40.0)
    monkeypatch.setattr("disc_model.stability.follower.cycle_of_static_start", lambda p: start)
    monkeypatch.setattr("disc_model.stability.follower.find_outcome", lambda *_, **__: separation)
    found = dm.regions(P, 10)
    assert found["method"].item() == method
    assert found["outcome"].item() == outcome
    assert found["cycle"].item() == cycle


@pytest.mark.compiled
def test_a_separation_has_a_time_where_that_is_asked_for() -> None:
    """At 273 s, after a slow departure from the cycle, which is extrapolated elsewhere."""
    case = P.replace(N=260, Omega=19)
    rough = dm.regions(case, 500)
    exact = dm.regions(case, 500, timed=[{"N": 260, "Omega": 19}])
    assert rough["outcome"].item() == exact["outcome"].item() == "separation"
    assert rough["method"].item() == "extrapolation"
    assert math.isnan(rough["first_separation"].item())
    assert exact["first_separation"].item() == pytest.approx(272.5209)


# ---- Motions


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("changes", "extent"),  # mm, as printed with three digits by other runs of the paper's cases
    [
        ({"N": 200, "Omega": 20}, 18.2),
        ({"N": 300, "Omega": 20}, 27.4),
        ({"N": 385, "Omega": 15.1}, 35.2),
        ({"N": 200, "Omega": 20, "k": 2e4}, 15.6),
        ({"N": 400, "Omega": 30, "normalization": "orthonormal"}, 9.31),
    ],
)
def test_separation_holds_the_range_where_contact_is_lost(
    changes: dict[str, Any], extent: float
) -> None:
    found = dm.range_law(P.replace(**changes), horizon=3, displaced_horizon=20).sel(
        begin="displaced"
    )
    assert 1e3 * found["range"].item() == pytest.approx(extent, rel=0.005)
    assert min(found["vibration_share"], found["force_share"]) >= 0.95
    flights = excess_of_flights(found["separation_fraction"].item())
    assert found["deviation"].item() == pytest.approx(flights, abs=0.01)


MOTIONS = [
    # changes of the case, the blow, range in mm, lowest force in N, separations in the last second
    ({"stretching": "clamped"}, 0.0, 0.0, 200.0, False),
    ({"stretching": "clamped"}, 5.0, 7.4, 0.0, True),
]


@pytest.mark.compiled
@pytest.mark.parametrize(("changes", "blow", "extent", "force", "lost"), MOTIONS)
def test_motions_in_contact_are_measured_where_asked(
    changes: dict[str, Any], blow: float, extent: float, force: float, lost: bool
) -> None:
    """A plate that stretches, as published: quiet from rest, and separating after a blow of 5 m/s."""
    case = Parameters(N=200, Omega=20, **changes)
    found = dm.range_law(case, horizon=5, displaced_horizon=50, blow=blow, in_contact=True)
    motion = found.sel(begin="displaced" if blow else "static")
    assert 1e3 * motion["range"].item() == pytest.approx(extent, abs=0.1)
    assert motion["earlier_range"].item() == pytest.approx(motion["range"].item(), abs=1e-4)
    assert motion["lowest_force"].item() == pytest.approx(force, abs=2)
    assert (motion["separation_rate"].item() > 0) is lost


LOCKS = [
    # start, changes of the case, what the motion does
    ({"parameters": {"N": 385, "Omega": 15.1}, "time": 70}, {}, "without_stick"),
    ({"parameters": {}, "time": 5}, {}, "in_contact"),
    ({"parameters": {"N": 385, "Omega": 20}, "time": 60}, {"n_circles": 1}, "undecided"),
]


@pytest.mark.compiled
@pytest.mark.parametrize(("start", "changes", "motion"), LOCKS)
def test_a_motion_locks_only_with_stick_and_separation(
    start: dict[str, Any], changes: dict[str, Any], motion: str
) -> None:
    case = Parameters(N=200, Omega=20, **changes)
    found = dm.locking(case, start={"prerun": start}, transient=5, record=5, max_record=10)
    assert found["motion"].item() == motion
    assert found["period_releases"] == 0


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("case", "kind", "transient"),
    [
        (Parameters(N=200, Omega=0), "at_rest", 2.0),
        (Parameters(N=50, Omega=15, c_p=0.5), "steady_sliding", 2.0),
        # contact is first lost at 11 s; the cycle that it comes to has 86 separations
        (Parameters(N=800, Omega=40, n_diameters=2), "separating", 32.0),
    ],
)
def test_a_transient_is_doubled_until_the_motion_has_settled(
    case: Parameters, kind: str, transient: float
) -> None:
    found = dm.bifurcation(case, transient=2, max_transient=600, samples=5)
    assert found["kind"].item() == kind
    assert found["transient_time"].item() == transient
    assert message_of(found) == ""
    assert np.isfinite(found["psi"]).sum() == (5 if kind == "separating" else 0)


@pytest.mark.compiled
def test_columns_are_those_of_steady_sliding_at_each_value() -> None:
    found = dm.sliding_modes(FALLING, name="mu_k", bounds=(0.1, 0.3), step=0.1)
    for i, mu_k in enumerate((0.1, 0.2, 0.3)):
        case = FALLING.replace(mu_k=mu_k)
        sliding = dm.steady_sliding(case)
        assert found["largest_growth_rate"].values[i] == sliding.growth_rate
        upper = sliding.eigenvalues[sliding.eigenvalues.imag > 0]
        of_modes = found.isel(value=i).dropna("mode", subset=["frequency"])
        assert sorted(2 * np.pi * of_modes["frequency"].values) == pytest.approx(
            sorted(upper.imag), rel=1e-10
        )
        assert sorted(of_modes["mode_growth_rate"].values) == pytest.approx(
            sorted(upper.real), abs=1e-9
        )
    without = dm.sliding_modes(FALLING, bounds=(0, 20), step=10)
    assert message_of(without).startswith("Omega = 0 rad/s: The disc is not driven")
    assert np.isnan(without["largest_growth_rate"].values).tolist() == [True, False, False]
