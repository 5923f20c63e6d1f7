"""Results: constants that runs share, and what is handed on: files, tables, pictures."""

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from disc_model import Parameters, Poincare, Ramp, Result, Window, simulate
from disc_model.data.dataset import MissingFile, UnreadableFile, load_tree, save
from tests.refusals import refusal

P = Parameters(N=200, Omega=50, n_diameters=1)
WINDOWS = {
    "late": Window(last=0.02, rate=1000),
    "bins": Window(rate=500, envelope=5),
    "1 of 2": Poincare(),
}
RAMPS = (Ramp(parameter="N", to=190, start=0.01, end=0.02),)
RUN = simulate(P, 0.05, WINDOWS, ramps=RAMPS)
OVERFLOW = {"phase": "slip", "direction": 1, "f": 1e308}


def overflowed() -> Result:
    start = simulate(P, 1e-6).final_state.replace(**OVERFLOW)
    with np.errstate(all="ignore"):
        return simulate(P, 0.01, initial_state=start)


@pytest.mark.parametrize(
    "run", [RUN, overflowed(), simulate(P, 0.02, events=False), simulate(P.replace(Omega=0), 0.01)]
)
def test_a_result_survives_its_file_to_the_last_bit(tmp_path: Path, run: Result) -> None:
    path = tmp_path / "r.nc"
    run.save(path)
    again = Result.load(path)
    assert again == run
    assert hash(again.final_state) == hash(run.final_state)
    assert repr(again) == repr(run)
    assert again.events.equals(run.events)
    assert again.parameters.replace(mu_s=0.5) == run.parameters.replace(mu_s=0.5)
    for name in run.windows:
        assert again[name].identical(run[name])
    if run.status.complete:
        states = [each.final_state for each in (again, run)]
        one, other = (simulate(P, duration=0.01, initial_state=state) for state in states)
        assert one == other


def test_what_differs_in_one_number_is_not_equal() -> None:
    state = RUN.final_state
    assert state == state.replace()
    assert state != state.replace(psi=np.nextafter(state.psi, 1.0))
    assert state != dataclasses.replace(state, a=np.nextafter(state.a, 1.0))
    assert state != dataclasses.replace(state, mode_amplitudes=None)
    assert state != "state"
    assert dataclasses.replace(RUN, u_0=np.nextafter(RUN.u_0, 1.0)) != RUN
    late = RUN.samples["late"]
    other = RUN.samples | {"late": late | {"P": np.nextafter(late["P"], 1e9)}}
    assert dataclasses.replace(RUN, samples=other) != RUN


def test_a_result_stays_what_it_is_in_later_runs() -> None:
    first = simulate(P, 0.03)
    kept = first.final_state.a.copy(), first.event_rows.copy()
    simulate(P, 0.06)
    np.testing.assert_array_equal(first.final_state.a, kept[0])
    np.testing.assert_array_equal(first.event_rows, kept[1])
    with pytest.raises(ValueError, match="read-only"):
        first.final_state.a[0] = 1


def test_files_have_units_and_the_case(tmp_path: Path) -> None:
    RUN.save(tmp_path / "run.nc")
    tree = xr.open_datatree(tmp_path / "run.nc")
    columns = tree["events"].to_dataset().drop_vars("direction").data_vars.values()
    assert [x.name for x in columns if "long_name" not in x.attrs] == []
    for name in ("late", "events"):
        assert tree[name].attrs["parameters"] == RUN.parameters.canonical_json


@pytest.mark.parametrize(
    ("place", "other"),
    [
        *((place, None) for place in ("status", "windows", "final_state", "tol", "u_0")),
        (("final_state", "phase"), ...), (("final_state", "a"), ...), (("parameters", "N"), -1),
        (("windows", "late"), 3),
        ("status", "fine"), ("more", 1),
    ],
)  # fmt: skip
def test_a_file_with_another_header_is_unreadable(tmp_path: Path, place: Any, other: Any) -> None:
    path = tmp_path / "r.nc"
    RUN.save(path)
    tree = load_tree(path)
    header = json.loads(tree.attrs["result"])
    *outer, name = [place] if isinstance(place, str) else place
    part = header[outer[0]] if outer else header
    part[name] = other
    if other is ...:
        del part[name]
    tree.attrs["result"] = json.dumps(header)
    save(tree, path)
    with pytest.raises(UnreadableFile, match="cannot be read: "):
        Result.load(path)


@pytest.mark.parametrize("missing", ["late", "events/time"])
def test_so_is_one_without_a_column(tmp_path: Path, missing: str) -> None:
    path = tmp_path / "r.nc"
    RUN.save(path)
    tree = load_tree(path)
    group, _, column = missing.partition("/")
    if column:
        tree[group].dataset = tree[group].to_dataset().drop_vars(column)
    else:
        del tree[group]
    save(tree, path)
    with pytest.raises(UnreadableFile, match="cannot be read: "):
        Result.load(path)


def test_files_of_no_kind_are_refused(tmp_path: Path) -> None:
    with refusal(r"path=.* must end in \.nc"):
        RUN.save(tmp_path / "r")
    path = tmp_path / "r.nc"
    with pytest.raises(MissingFile):
        Result.load(path)
    path.write_bytes(b"# 1")
    with pytest.raises(UnreadableFile, match="cannot be read"):
        Result.load(path)
    RUN["late"].to_netcdf(path)
    with refusal(r"must be a file written by Result\.save"):
        Result.load(path)


@pytest.mark.parametrize(
    ("name", "window", "span"),
    [("end", None, (0.05, 0.07)), ("late", None, (0.06, 0.07)), ("late", "late", (0.06, 0.065))],
)
def test_pictures_show_the_run_where_it_is(
    name: str, window: Any, span: tuple[float, float]
) -> None:
    """A window that was recorded, or else one of the run simulated once more."""
    start = simulate(P, 0.05).final_state
    recorded = {"late": Window(start=0.06, stop=0.065, rate=1e4)}
    run = simulate(P, 0.07, recorded, initial_state=start)
    if name == "late":
        ax = run.plot_spectrum(window)
        assert "Frequency" in ax.get_xlabel()
        return
    ax = run.plot(window)
    time = np.concatenate([line.get_xdata() for line in np.ravel(ax)[-1].lines])
    assert time.size


@pytest.mark.parametrize(
    ("arguments", "fault"),
    [
        ({"path": "film.mov"}, "path=.*must end in .gif or .mp4"),
        ({"path": "no/folder/film.gif"}, "path=.* in a folder that exists"),
        ({"frames": 0}, "frames=0: must be >= 1"),
        ({"fps": 0}, "fps=0: must be > 0"),
    ],
)
def test_a_film_that_cannot_be_written_is_refused(arguments: Any, fault: str) -> None:
    with refusal(fault):
        RUN.animate(**arguments)
