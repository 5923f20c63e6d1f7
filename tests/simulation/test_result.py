"""Between parameters and the engine: constants that runs share, and states there and back."""

from __future__ import annotations

import numpy as np
import pytest

from disc_model import Parameters, Ramp, simulate
from disc_model.engine import layout
from disc_model.plate import mode_arrays
from disc_model.simulation.result import Workspace, engine_case, read_state, series_order, write_state
from tests.contact_laws import COMPILES, LAWS
from tests.simulation.equal import same

P = Parameters(N=385, Omega=15.1)
APART = Parameters(N=700, Omega=50, k=0, mu_s=1.4, mu_k=0.2, n_diameters=1)


def test_a_case_seen_before_gives_the_same_to_the_last_bit() -> None:
    seen = simulate(P, 0.1)
    engine_case.cache_clear()
    fresh = simulate(P, 0.1)
    same(seen, fresh)


def test_two_runs_of_a_case_at_a_time_do_not_meet() -> None:
    """A run's progress may start another run of the same case."""
    alone = simulate(P, 0.5)
    inner = []
    outer = simulate(P, 0.5, progress=lambda _: inner.append(simulate(P, 0.5)))
    assert inner
    for result in (outer, *inner):
        same(result, alone)


def soil(workspace: Workspace) -> None:
    """Fill a workspace with what no run leaves there, but for the constants among its series."""
    series = workspace.series
    constants = series.up.copy(), series.down.copy()
    for array in (*series, *workspace.state, *workspace.probe, workspace.phase_times, workspace.sums):
        array[:] = np.nan
    workspace.counters[:] = -1
    series.up[:], series.down[:] = constants


@pytest.mark.parametrize(
    ("changes", "ramps"),
    [
        ({}, ()),
        ({}, Ramp(parameter="Omega", to=16.0, start=0.01, end=0.2)),
        pytest.param({"n_circles": 2}, (), marks=COMPILES),
        pytest.param(LAWS["compliant"], (), marks=COMPILES),
    ],
    ids=["paper", "ramp", "more_modes", "compliant"],
)
def test_a_run_finds_nothing_of_the_runs_before_it(changes: dict[str, float], ramps: tuple[Ramp, ...] | Ramp) -> None:
    """Runs of a case, one after the other, write to the same arrays."""
    p = P.replace(**changes)
    engine_case.cache_clear()
    one = simulate(p, 0.03, ramps=ramps)
    (workspace,) = engine_case(p).idle[series_order(one.tol)]
    soil(workspace)
    other = simulate(p, 0.03, ramps=ramps)
    assert len(one.event_rows) > 2
    same(one, other)


def test_a_result_stays_what_it_is_in_later_runs() -> None:
    first = simulate(P, 0.03)
    kept = first.final_state.a.copy(), first.event_rows.copy()
    simulate(P, 0.06)
    np.testing.assert_array_equal(first.final_state.a, kept[0])
    np.testing.assert_array_equal(first.event_rows, kept[1])


@pytest.mark.parametrize("p", [P, APART], ids=["contact", "apart"])
def test_a_state_survives_the_way_there_and_back(p: Parameters) -> None:
    state = simulate(p, 0.1).final_state
    case = engine_case(p)
    place = layout.build_state(case.model)
    write_state(case, state, place)
    back = read_state(case, place)
    for name in ("a", "b", "alpha", "beta", "time", "psi", "f", "phase", "u"):
        np.testing.assert_array_equal(getattr(back, name), getattr(state, name))
    assert not back.b[mode_arrays(p).diameters == 0].any()
    with pytest.raises(ValueError, match="read-only"):
        back.a[0] = 1


def test_events_beyond_the_first_small_buffer_are_all_kept() -> None:
    result = simulate(P, 10.0)
    assert len(result.event_rows) == result.statistics["events"] > 600
    assert (np.diff(result.event_rows[:, 0]) >= 0).all()
