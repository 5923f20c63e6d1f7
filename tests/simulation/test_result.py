"""Results and states: constants that runs share, and what is handed on: files, a line of text,
another time."""

import copy
import dataclasses
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model import ParameterError, Parameters, Poincare, Ramp, Result, State, Window, simulate
from disc_model.data.dataset import MissingFile, UnreadableFile
from disc_model.data.tables import load_tables, save_tables
from disc_model.simulation.shown import simulated_again
from tests.refusals import refusal
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


@pytest.mark.parametrize("events", [True, False])
def test_a_result_survives_its_file_to_the_last_bit(tmp_path: Path, events: bool) -> None:
    ramps = (Ramp(parameter="N", to=190, start=0.01, end=0.02),)
    result = simulate(P, 0.05, WINDOWS, events=events, ramps=ramps)
    path = tmp_path / "r.nc"
    result.save(path)
    assert b"unilateral" in path.read_bytes(), "and not the older word of texts that identify cases"
    again = Result.load(path)
    same(again, result)
    assert again == result
    assert again.final_state == result.final_state
    assert hash(again.final_state) == hash(result.final_state)
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
    with refusal(r"path=.* must end in \.nc"):
        result.save(tmp_path / "r")
    file = tmp_path / "state.nc"
    result.final_state.save(file)
    with refusal(r"must be a file written by Result\.save"):
        Result.load(file)
    assert [path.name for path in tmp_path.iterdir()] == ["state.nc"]


def test_a_state_survives_its_file_to_the_last_bit(tmp_path: Path) -> None:
    state = simulate(P, 0.0371).final_state
    state_path = tmp_path / "state.nc"
    state.save(state_path)
    again = State.load(state_path)
    for name in State.__dataclass_fields__:
        assert np.array_equal(getattr(again, name), getattr(state, name)), name
    one, other = (simulate(P, 0.06, initial_state=start).final_state for start in (state, again))
    assert np.array_equal(one.a, other.a)
    result_path = tmp_path / "result.nc"
    simulate(P, 0.01).save(result_path)
    with refusal(r"must be a file written by State\.save"):
        State.load(result_path)


def test_a_window_knows_its_case_without_the_result(tmp_path: Path) -> None:
    """A window in a file of its own had lost its load and speed."""
    result = simulate(P, 0.05, WINDOWS)
    result["late"].to_netcdf(tmp_path / "late.nc")
    with xr.open_dataset(tmp_path / "late.nc") as late:
        case = Parameters.model_validate_json(late.attrs["parameters"])
    events = result.to_tree()["events"]
    assert case == P
    assert events.attrs["parameters"] == P.canonical_json


def test_what_files_of_states_hold_has_units_and_meanings(tmp_path: Path) -> None:
    simulate(P, 0.05).save(tmp_path / "run.nc")
    run = xr.open_datatree(tmp_path / "run.nc")
    columns = [*run["final_state"].data_vars.values(), *run["events"].data_vars.values()]
    assert {"a", "mode_amplitudes", "direction"} < {str(column.name) for column in columns}
    assert [x.name for x in columns if "long_name" not in x.attrs] == []
    assert run["final_state"]["alpha"].attrs["units"] == "kg0.5 m s-1"


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


def test_a_run_that_overflowed_is_saved_but_its_last_state_is_not(tmp_path: Path) -> None:
    start = simulate(P, 1e-6).final_state
    with np.errstate(all="ignore"):
        run = simulate(P, 0.01, initial_state=start.replace(phase="slip", direction=1, f=1e308))
    run_path = tmp_path / "run.nc"
    run.save(run_path)
    same(Result.load(run_path), run)
    broken = start.replace(a=np.full_like(start.a, np.nan))
    state_path = tmp_path / "state.nc"
    with refusal(r"^a=.*: must be finite"):
        broken.save(state_path)
    assert not state_path.exists()


def test_pictures_of_a_run_begin_where_it_begins() -> None:
    run = simulate(P, duration=0.02, initial_state=simulate(P, 0.05).final_state)
    for name in ("run", "late"):
        time = simulated_again(run, name)[name]["time"].values
        assert 0.05 <= time[0] <= time[-1] <= 0.07
    whole = simulated_again(run, "run")["run"]["time"].values
    assert np.ptp(whole) == pytest.approx(0.02, rel=0.01)
    half = simulated_again(run, "late")["late"]["time"].values
    assert half[[0, -1]] == pytest.approx([0.06, 0.07], abs=1e-3)


# ---- Files that another program has put together


def edits(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], Any]]:
    """Paths into a structure of JSON, with what may stand there instead; ... for nothing at all."""
    for other in (..., None, "x", [], {}, [[[]]], -1, 1e300, True, "NaN", "1e999"):
        if path:
            yield path, other
    names: Any = value.keys() if isinstance(value, dict) else ()
    if isinstance(value, list):
        names = range(len(value))
    for name in names:
        yield from edits(value[name], (*path, name))


def edited(value: Any, path: tuple[Any, ...], other: Any) -> Any:
    """A copy of a structure with something else at a path."""
    changed = copy.deepcopy(value)
    part = changed
    for step in path[:-1]:
        part = part[step]
    if other is ...:
        del part[path[-1]]
    else:
        part[path[-1]] = other
    return changed


RECORDED = simulate(
    P,
    0.02,
    {"late": Window(last=0.01, rate=1000), "turns": Poincare()},
    ramps=Ramp(parameter="N", to=190, start=0.01, end=0.02),
    initial_state=simulate(P, 1e-6).final_state,
)


def test_what_is_no_result_is_an_unreadable_file_whatever_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ten of sixteen files ended in a KeyError, TypeError or RecursionError."""
    path = tmp_path / "r.nc"
    RECORDED.save(path)
    text, tables = load_tables(path)
    header = json.loads(text)
    refused = 0
    changed: list[Any] = [edited(header, *edit) for edit in edits(header)]
    changed += [None, 1, [], "x", {}]
    texts = [json.dumps(each) for each in changed] + ["{", "[" * 100_000, "\0"]
    for each in texts:
        monkeypatch.setattr("disc_model.data.tables.load_tables", lambda _, x=each: (x, tables))
        try:
            Result.load(path)
        except UnreadableFile:
            refused += 1
    assert len(texts) > 700
    # the others are numbers and texts that may be there
    assert refused > 0.6 * len(texts)


Columns = dict[str, dict[str, Any]]


STATE = ("a", "b", "alpha", "beta")
NEEDED = {"events": ("kind", "phase"), "final_state": STATE, "initial_state": STATE}
"""Columns beside the time without which a table is none of a result."""


def _wrong_columns(tables: Columns) -> Iterator[Columns]:
    """Tables that are not those of a result."""
    for name, table in tables.items():
        yield {**tables, name: {}}
        for key, column in table.items():
            yield {**tables, name: {**table, key: np.append(column, 0.0)}}
            if key == "time" or key in NEEDED.get(name, ()):
                yield {**tables, name: {x: y for x, y in table.items() if x != key}}
        yield {**tables, name: {**table, "other": np.zeros(len(next(iter(table.values()))))}}
    yield {**tables, "more": tables["late"]}
    yield {name: table for name, table in tables.items() if name != "late"}
    for key in ("kind", "phase"):
        yield {**tables, "events": {**tables["events"], key: tables["events"][key] + 7}}


def test_so_is_one_with_other_columns(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "r.nc"
    RECORDED.save(path)
    text, tables = load_tables(path)
    for each in _wrong_columns(tables):
        monkeypatch.setattr("disc_model.data.tables.load_tables", lambda _, x=each: (text, x))
        with pytest.raises(UnreadableFile, match="cannot be read: "):
            Result.load(path)
    monkeypatch.undo()
    save_tables(tables | {"late": {"time": np.array(["a", "b"])}}, text, path, xr.DataTree())
    with pytest.raises(UnreadableFile, match="cannot be read: "):
        Result.load(path)


def test_a_run_that_was_saved_before_a_column_was_known_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All runs saved before had been unreadable files."""
    path = tmp_path / "r.nc"
    RECORDED.save(path)
    text, tables = load_tables(path)
    header = json.loads(text)
    del header["statistics"]["surface_speed"]
    older = {name: dict(table) for name, table in tables.items()}
    for name, column in (("late", "psi_velocity"), ("turns", "w"), ("events", "u_velocity")):
        del older[name][column]
    monkeypatch.setattr("disc_model.data.tables.load_tables", lambda _: (json.dumps(header), older))
    run = Result.load(path)
    assert np.isnan(run.events["u_velocity"]).all()
    assert np.array_equal(run.events["P"], RECORDED.events["P"])
    assert "psi_velocity" not in run["late"]
    assert run["late"]["P"].equals(RECORDED["late"]["P"])
    assert math.isnan(run.statistics["surface_speed"])


def test_a_state_that_cannot_be_is_an_unreadable_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A phase "x" and a psi of nan were read, and refused by simulate."""
    path = tmp_path / "s.nc"
    state = RECORDED.final_state
    state.save(path)
    text, tables = load_tables(path)
    values = json.loads(text)
    arrays = tables["state"]
    found = []
    for name, wrong in (
        ("phase", "x"), ("psi", "NaN"), ("time", "Infinity"), ("direction", 2), ("roots", [9, 0]),
        ("roots", [1]), ("drive_angle", "x"), ("case_key", 1), ("u", None),
    ):  # fmt: skip
        found.append((json.dumps({**values, name: wrong}), arrays, name))
    for name in arrays:
        found.append((text, {**arrays, name: arrays[name][:-1]}, "numbers, as many as of a"))
    found.append((text, {**arrays, "a": np.full(len(arrays["a"]), np.nan)}, "a=.*must be finite"))
    found.append((text, {"a": arrays["a"]}, "arrays=.*: must be a, b, alpha, beta"))
    for each, columns, fault in found:
        monkeypatch.setattr(
            "disc_model.data.tables.load_tables", lambda _, x=each, y=columns: (x, {"state": y})
        )
        with pytest.raises(UnreadableFile, match=f"s\\.nc: cannot be read: .*{fault}"):
            State.load(path)


def test_states_and_results_that_differ_in_one_number_are_not_equal() -> None:
    """Equality was that of objects: a state was unlike its copy in a file."""
    run = simulate(P, 0.03, {"late": Window(last=0.02, rate=1000)})
    state = run.final_state
    assert state == state.replace()
    assert state != state.replace(psi=np.nextafter(state.psi, 1.0))
    a = state.a.copy()
    a[0] = np.nextafter(a[0], 1.0)
    assert state != dataclasses.replace(state, a=a)
    assert state != dataclasses.replace(state, mode_amplitudes=None)
    assert state != "state"

    assert run == simulate(P, 0.03, {"late": Window(last=0.02, rate=1000)})
    assert run != dataclasses.replace(run, u_0=run.u_0 + 1e-18)
    samples = {name: values.copy() for name, values in run.samples["late"].items()}
    samples["P"][3] += 1e-9
    assert run != dataclasses.replace(run, samples={"late": samples})
