"""Results and states: constants that runs share, and what is handed on: files, a line of text, another time."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from disc_model import Execution, ParameterError, Parameters, Record, State, Window, load, simulate
from disc_model.simulation.states import engine_case
from tests.simulation.equal import same

P = Parameters(N=200, Omega=50, n_diameters=1)
LONG = Parameters(N=385, Omega=15.1)


def test_a_case_seen_before_gives_the_same_to_the_last_bit() -> None:
    seen = simulate(LONG, 0.1)
    engine_case.cache_clear()
    fresh = simulate(LONG, 0.1)
    same(seen, fresh)


def test_two_runs_of_a_case_at_a_time_do_not_meet() -> None:
    """A run's progress may start another run of the same case."""
    alone = simulate(LONG, 0.5)
    inner = []
    outer = simulate(LONG, 0.5, execution=Execution(progress=lambda _: inner.append(simulate(LONG, 0.5))))
    assert inner
    for result in (outer, *inner):
        same(result, alone)


def test_a_result_stays_what_it_is_in_later_runs() -> None:
    first = simulate(P, 0.03)
    kept = first.final_state.a.copy(), first.event_rows.copy()
    simulate(P, 0.06)
    np.testing.assert_array_equal(first.final_state.a, kept[0])
    np.testing.assert_array_equal(first.event_rows, kept[1])
    with pytest.raises(ValueError, match="read-only"):
        first.final_state.a[0] = 1


def test_a_result_is_saved_and_loaded_as_its_tree(tmp_path: Path) -> None:
    windows = (Window(last=0.02, rate=1000), Window(rate=500, envelope=5))
    result = simulate(P, 0.05, record=Record(windows=windows))
    result.save(tmp_path / "r.nc", ["late", "whole"])
    assert load(tmp_path / "r.nc").identical(result.to_tree(["late", "whole"]))


NO_GROUP = (".", "..", "a\nb", "x" * 300, " a", "a ", "\x00", "\ud800", "a/b", "events", 3, ["a"])


@pytest.mark.parametrize("names", [*([name] for name in NO_GROUP), 3, "a", []], ids=repr)
def test_names_that_no_group_can_have_are_refused(tmp_path: Path, names: Any) -> None:
    """They ended in errors of libraries, some of them when the file was half written."""
    result = simulate(P, 0.01, record=Record(windows=(Window(rate=1000),)))
    with pytest.raises(ParameterError, match=r"^names=.*: must be 1 different names, one a window"):
        result.save(tmp_path / "r.nc", names)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["x" * 240, "é" * 120, "a\0b", "\ud800", "", "..", 3, None, b"x"], ids=repr)
def test_names_that_no_file_can_have_are_refused(tmp_path: Path, name: Any) -> None:
    result = simulate(P, 0.01)
    path = str(tmp_path) + "/" + name if isinstance(name, str) else name
    for use in (result.save, result.final_state.save, load, State.load):
        with pytest.raises(ParameterError, match=r"^path=.*: must be the name of a regular file, of at most 233 bytes"):
            use(path)
    assert not list(tmp_path.iterdir())


def test_values_are_shown_in_a_line() -> None:
    result = simulate(P, 0.05)
    assert repr(result) == (
        f"Result(N=200 N, Omega=50 rad/s: ok at 0.05 s, no separation, {result.statistics['events']} events, 0 windows)"
    )
    text = repr(result.final_state)
    assert text.startswith("State(time=0.05 s, ")
    assert text.endswith("2 modes)")
    assert len(text) < 140


def test_a_state_survives_its_file_to_the_last_bit(tmp_path: Path) -> None:
    state = simulate(P, 0.0371).final_state
    state.save(tmp_path / "state.nc")
    again = State.load(tmp_path / "state.nc")
    for name in State.__dataclass_fields__:
        assert np.array_equal(getattr(again, name), getattr(state, name)), name
    one, other = (simulate(P, 0.06, initial_state=start).final_state for start in (state, again))
    assert np.array_equal(one.a, other.a)
    simulate(P, 0.01).save(tmp_path / "result.nc")
    with pytest.raises(ParameterError, match=r"must be a file written by State\.save"):
        State.load(tmp_path / "result.nc")


def test_a_state_can_be_given_another_time() -> None:
    """What the clock had lost to rounding stayed behind, and was more than the last digit of 0."""
    state = simulate(P, 0.0371).final_state.replace(time_low=3e-18)
    moved = state.replace(time=0)
    assert (moved.time, moved.time_low) == (0, 0.0)
    assert simulate(P, 0.01, initial_state=moved).status.complete
    assert state.replace(psi=0.1).time_low == state.time_low


def test_a_height_that_contradicts_contact_is_refused() -> None:
    """It used to be passed over in silence: in contact the disc says where the slider is."""
    state = simulate(P, 0.0371).final_state
    assert state.phase != "separation"
    with pytest.raises(ParameterError, match=r"initial_state.u=.*: must be the disc's displacement under the slider"):
        simulate(P, 0.06, initial_state=state.replace(u=state.u + 1e-6))
    # as far as rounding goes it may differ
    assert simulate(P, 0.06, initial_state=state.replace(u=state.u * (1 + 1e-12))).status.complete
    apart = state.replace(u=state.u + 1e-3, phase="separation", direction=0)
    assert simulate(P, 0.04, initial_state=apart).status.complete
