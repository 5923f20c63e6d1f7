"""Between parameters and the engine: constants that runs share, and states there and back."""

import numpy as np
import pytest

from disc_model import Parameters, simulate
from disc_model.engine import layout
from disc_model.plate import mode_arrays
from disc_model.simulation.result import engine_case, read_state, write_state
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


@pytest.mark.compiled
def test_events_beyond_the_first_small_buffer_are_all_kept() -> None:
    result = simulate(P, 10.0)
    assert len(result.event_rows) == result.statistics["events"] > 600
    assert (np.diff(result.event_rows[:, 0]) >= 0).all()
