"""Periods of motions with stick and separation, with a test that can fail, and their multipliers."""

import math
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

from disc_model.parameters import Parameters
from disc_model.simulation.api import simulate
from disc_model.simulation.case import Window
from disc_model.simulation.result import Result
from disc_model.simulation.states import engine_case
from disc_model.stability import locking
from disc_model.stability.cycle import multipliers
from disc_model.stability.locking import Releases, lock_of, releases_of
from tests.references.fixed_step import switches

CASE = Parameters(N=200, Omega=20, normalization="as_published")
GOLDEN = (math.sqrt(5) - 1) / 2


def record(intervals: np.ndarray, vibrations: np.ndarray) -> Releases:
    """A record of releases with given intervals, s, and numbers of vibrations between them."""
    times = np.concatenate([[0.0], np.cumsum(intervals)])
    return Releases(times, np.zeros(len(times)), np.asarray(vibrations), 7.4e-3)


def test_a_record_that_repeats_has_its_period() -> None:
    vibrations = np.tile([2, 17, 2, 19, 19], 4)
    intervals = 7.4e-3 * vibrations + np.tile([1e-4, 0, 0, 2e-4, 3e-4], 4)
    found = lock_of(record(intervals, vibrations))
    assert found is not None
    assert found.releases == 5
    assert found.vibrations == 59
    assert found.period == pytest.approx(intervals[:5].sum())


def test_a_record_shorter_than_two_periods_shows_none() -> None:
    vibrations = np.tile([2, 17, 2, 19, 19], 2)[:9]
    intervals = 7.4e-3 * vibrations + np.tile([1e-4, 0, 0, 2e-4, 3e-4], 2)[:9]
    assert lock_of(record(intervals, vibrations)) is None


def test_a_quasi_periodic_record_shows_none() -> None:
    """A rotation by the golden mean comes near to its start again and again, and never repeats."""
    turns = (GOLDEN * np.arange(2000)) % 1
    vibrations = np.where(turns < GOLDEN, 2, 17)
    assert lock_of(record(7.4e-3 * vibrations + 1e-4 * turns, vibrations)) is None


def test_equal_intervals_with_other_numbers_of_vibrations_are_no_period() -> None:
    vibrations = np.array([2, 3, 2, 2, 3, 2, 2, 2])
    assert lock_of(record(np.full(8, 0.1), vibrations)) is None


def run_of(rows: list[tuple[float, str]]) -> Any:
    """A made-up run with events: times and kinds."""
    return SimpleNamespace(events=pd.DataFrame(rows, columns=["time", "kind"]))


def test_the_phase_of_a_release_is_its_time_since_a_loss_of_contact_over_their_interval() -> None:
    apart = [(1.0 + 0.1 * i, "separation") for i in range(6)]
    # the first one before the first loss of contact
    released = [(0.95, "stick_to_slip"), (1.13, "stick_to_slip"), (1.36, "stick_to_slip")]
    found = releases_of(run_of(sorted(apart + released)))
    assert found is not None
    assert found.times.tolist() == [1.13, 1.36]
    assert found.phases == pytest.approx([0.3, 0.6])
    assert found.vibrations.tolist() == [2]
    assert found.vibration == pytest.approx(0.1)
    # with a loss of contact known before the run, and its interval
    found = releases_of(run_of(sorted(apart + released)), since=(0.9, 0.2))
    assert found is not None
    assert found.times.tolist() == [0.95, 1.13, 1.36]
    assert found.phases == pytest.approx([0.25, 0.15, 0.3])
    assert found.vibration == 0.2
    assert releases_of(run_of(sorted(apart[:2] + released))) is None


# ---- The motion at 200 N


def settled(Omega: float, tol: float = 1e-10) -> Result:
    """Twelve seconds of the motion with separation, as long as two periods or more, after it has
    settled."""
    p = CASE.replace(Omega=Omega)
    begun = simulate(CASE, 560, tol=tol, events=False)
    state = simulate(p, duration=60, tol=tol, initial_state=begun.final_state, events=False)
    return simulate(p, duration=12, tol=tol, initial_state=state.final_state)


def locked(run: Result) -> tuple[int, int]:
    """Releases and separations in a period."""
    found = releases_of(run)
    if found is None:
        lock = None
    else:
        lock = lock_of(found)
    assert lock is not None
    return lock.releases, lock.vibrations


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("Omega", "tol", "period"),
    [
        (19.83, 1e-10, (34, 371)),
        (19.97, 1e-10, (34, 371)),
        (19.99, 1e-10, (35, 371)),
        (20.18, 1e-10, (41, 449)),
        (19.9, 1e-8, (34, 371)),
        (19.9, 1e-12, (34, 371)),
        (20.1, 1e-8, (41, 449)),
        (20.1, 1e-12, (41, 449)),
    ],
)
def test_periods_stay_over_steps_of_the_speed_and_at_all_tolerances(
    Omega: float, tol: float, period: tuple[int, int]
) -> None:
    assert locked(settled(Omega, tol)) == period


@pytest.fixture(scope="module")
def run() -> Result:
    return settled(19.9)


@pytest.mark.compiled
def test_multipliers_are_those_of_the_disc_and_one_of_the_slider(run: Result) -> None:
    """The disc's damping, half of 2 xi omega, holds for its weakly coupled modes; the real
    multiplier is that of the slider's swings, but for what these do to the vibration."""
    p = run.parameters
    found = releases_of(run)
    assert found is not None
    lock = lock_of(found)
    assert lock is not None
    cycle = locking.locked_cycle(p, run.final_state, lock)
    assert cycle is not None
    assert cycle.counts.releases == lock.releases
    wrong = lock._replace(vibrations=lock.vibrations + 1)
    assert locking.locked_cycle(p, run.final_state, wrong) is None
    known = multipliers(cycle.jacobian)
    assert (abs(known) < 1).all()
    rate = math.log(abs(known[0])) / lock.period
    model = engine_case(p).model
    assert -rate == pytest.approx(float(model.damping0.min()) / 2, rel=0.01)

    real = known[abs(known.imag) < 1e-9].real.max()
    assert product_of_swings(run, lock) == pytest.approx(real, rel=0.05)


def product_of_swings(run: Result, lock: locking.Lock) -> float:
    """The product over a period of cos(w t) - kappa sin(w t), of a slip of the duration t; docs/model.md,
    Why separated motions lock."""
    p = run.parameters
    length = 1.1 * lock.period
    windows = {"force": Window(last=length, rate=1e5)}
    period = simulate(p, windows=windows, duration=length, initial_state=run.final_state)
    events = period.events
    stops = events["time"][events["kind"] == "slip_to_stick"].to_numpy()
    releases = events["time"][events["kind"] == "stick_to_slip"].to_numpy()[: lock.releases]
    lasts = stops[np.searchsorted(stops, releases)] - releases
    # the force when stick ends, and its rate, from the last samples of stick
    last = np.searchsorted(period["force"]["time"], releases) - 1
    force = period["force"]["P"].values
    rate = (3 * force[last] - 4 * force[last - 1] + force[last - 2]) * 1e5 / 2
    swing = math.sqrt(p.k_p / p.m)
    rho = p.Omega - p.mu_s * rate / (p.r_0 * p.k_p)
    kappa = (p.mu_s - p.mu_k) * force[last] / (p.r_0 * p.m * swing * rho)
    return float(np.prod(np.cos(swing * lasts) - kappa * np.sin(swing * lasts)))


@pytest.mark.compiled
def test_the_map_of_phases_contracts_where_the_motion_is(run: Result) -> None:
    found = releases_of(run)
    assert found is not None
    places = locking.phase_map(run.parameters, run, 200, 1e-10)
    inside = (places.phases > found.phases.min()) & (places.phases < found.phases.max())
    assert set(places.vibrations[inside]) == {2, 17, 19} == set(found.vibrations)
    slopes = places.slopes[inside]
    assert np.nanmax(abs(slopes)) < 1

    # the slope of a piece is also that between its places
    piece = inside & (places.vibrations == 2)
    secant = np.diff(places.following[piece]) / np.diff(places.phases[piece])
    middle = (places.slopes[piece][1:] + places.slopes[piece][:-1]) / 2
    np.testing.assert_allclose(secant, middle, rtol=1e-3)


@pytest.mark.slow
@pytest.mark.compiled
def test_a_method_of_fixed_steps_finds_the_same_numbers_of_vibrations(run: Result) -> None:
    """It shares no code with the engine; its errors leave each number of a period as it is."""
    found = releases_of(run)
    assert found is not None
    expected = found.vibrations[:68].tolist()
    assert vibrations_by_fixed_steps(run, 6.0)[: len(expected)] == expected


def vibrations_by_fixed_steps(run: Result, duration: float) -> list[int]:
    """Numbers of separations between releases, from the state in which a run begins."""
    p = run.parameters
    assert run.initial_state is not None
    _, kinds = switches(p, run.initial_state, duration)
    releases = [at for at, kind in enumerate(kinds) if kind == "stick_to_slip"]
    return [kinds[at:end].count("separation") for at, end in pairwise(releases)]
