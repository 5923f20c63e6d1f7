"""Results and states: constants that runs share, and what is handed on: files, a line of text,
another time."""

from pathlib import Path

import numpy as np
import pytest

from disc_model import ParameterError, Parameters, Poincare, Ramp, Result, State, Window, simulate
from disc_model.data.dataset import MissingFile, UnreadableFile
from tests.simulation.equal import same

P = Parameters(N=200, Omega=50, n_diameters=1)


def test_a_result_stays_what_it_is_in_later_runs() -> None:
    first = simulate(P, 0.03)
    kept = first.final_state.a.copy(), first.event_rows.copy()
    simulate(P, 0.06)
    np.testing.assert_array_equal(first.final_state.a, kept[0])
    np.testing.assert_array_equal(first.event_rows, kept[1])
    with pytest.raises(ValueError, match="read-only"):
        first.final_state.a[0] = 1


WINDOWS = {
    "late": Window(last=0.02, rate=1000),
    "bins": Window(rate=500, envelope=5),
    "turns": Poincare(),
}


@pytest.mark.parametrize("suffix", [".nc", ".mat"])
@pytest.mark.parametrize("events", [True, False])
def test_a_result_survives_its_file_to_the_last_bit(
    tmp_path: Path, suffix: str, events: bool
) -> None:
    ramps = (Ramp(parameter="N", to=190, start=0.01, end=0.02),)
    result, path = simulate(P, 0.05, WINDOWS, events=events, ramps=ramps), tmp_path / f"r{suffix}"
    result.save(path)
    assert b"unilateral" in path.read_bytes(), "and not the older word of texts that identify cases"
    again = Result.load(path)
    same(again, result)
    assert repr(again) == repr(result)
    assert again.events.equals(result.events)
    for name in ("parameters", "tol", "t_end", "status", "message", "windows", "ramps", "u_0"):
        assert getattr(again, name) == getattr(result, name), name
    for name in WINDOWS:
        assert again[name].identical(result[name])
    goes_on, went_on = (
        simulate(P, 0.06, initial_state=run.final_state, ramps=ramps) for run in (again, result)
    )
    assert np.array_equal(goes_on.final_state.a, went_on.final_state.a)
    path.write_bytes(b"# 1")
    with pytest.raises(UnreadableFile, match="cannot be read"):
        Result.load(path)
    path.unlink()
    with pytest.raises(MissingFile):
        Result.load(path)


def test_files_of_no_kind_and_names_that_matlab_has_not_are_refused(tmp_path: Path) -> None:
    result = simulate(P, 0.01, {"1 of 2": Window(rate=1000)})
    for name, rule in (
        ("r", r"path=.* must end in \.nc or"),
        ("r.mat", "windows.1 of 2: must be a name that"),
    ):
        with pytest.raises(ParameterError, match=rule):
            result.save(tmp_path / name)
    result.final_state.save(tmp_path / "state.nc")
    with pytest.raises(ParameterError, match=r"must be a file written by Result\.save"):
        Result.load(tmp_path / "state.nc")
    assert [path.name for path in tmp_path.iterdir()] == ["state.nc"]


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


def test_a_height_that_contradicts_contact_is_refused() -> None:
    """It used to be passed over in silence: in contact the disc says where the slider is."""
    state = simulate(P, 0.0371).final_state
    assert state.phase != "separation"
    with pytest.raises(
        ParameterError,
        match=r"initial_state.u=.*: must be the disc's displacement under the slider",
    ):
        simulate(P, 0.06, initial_state=state.replace(u=state.u + 1e-6))
    # as far as rounding goes it may differ
    assert simulate(P, 0.06, initial_state=state.replace(u=state.u * (1 + 1e-12))).status.complete
    apart = state.replace(u=state.u + 1e-3, phase="separation", direction=0)
    assert simulate(P, 0.04, initial_state=apart).status.complete
