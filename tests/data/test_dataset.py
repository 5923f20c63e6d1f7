"""Datasets and results in files: what comes back, what other programs find, and what is refused."""

import os
import resource
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import disc_model as dm
from disc_model.data.dataset import MissingFile, UnreadableFile, WriteError, load_cases, load_tree
from disc_model.data.variables import STATUSES
from disc_model.errors import ParameterError
from disc_model.simulation.case import CaseSpec
from disc_model.simulation.named_case import run_case
from tests.refusals import refusal

P = dm.Parameters(N=200, Omega=50, n_diameters=1)
RUN = dm.simulate(P, 0.02, {"all": dm.Window(rate=2000)})
DISC = dm.Disc(diameters=[2], omega=[900], amplitude=[1])
FLAGS = {"flag_values": np.arange(2, dtype=np.int8), "flag_meanings": "stick slip"}
PLANE = ("N", "Omega")
ALL_KINDS = xr.Dataset(
    {
        "growth": (PLANE, [[1.5, np.nan, -np.inf], [0.0, 1e-300, 3.0]], {"units": "s-1"}),
        "status": (PLANE, [["ok", "", "two words "], ["Ωµ", "line\nline", "|"]]),
        "stable": ("N", [True, False]),
        "count": ("Omega", [1, 2, 2**53 + 1]),
        "phase": ("Omega", np.array([0, 1, 0], np.int8), FLAGS),
        "short": ("Omega", np.array([0.1, 0.2, 0.3], np.float32)),
        "one": ((), 2.5, {"units": "m", "scale": 3, "weights": np.array([0.5, 0.25])}),
        "word": ((), "stick_slip"),
        "nothing": ((), ""),
        "none": ("empty", np.zeros(0)),
    },
    {"N": [100.0, 200.0], "Omega": ("Omega", [1.0, 2.0, 3.0], {"units": "rad s-1"})},
    {"function": "floquet", "number": 2.0},
)


def sweep() -> xr.Dataset:
    """Multipliers, which are complex, and a point without any."""
    return dm.sweep(dm.floquet, P, zip={"N": [150, 200], "mu_k": [0.2, 0.41]})


# ---- What comes back


@pytest.mark.parametrize(
    "make", [lambda: ALL_KINDS, sweep, RUN.to_tree], ids=["all", "sweep", "run"]
)
def test_data_come_back_as_they_were(make: Any, tmp_path: Path) -> None:
    data = make()
    longest = tmp_path / f"{'x' * 252}.nc"
    dm.save(data, longest)
    found = dm.load(longest)
    xr.testing.assert_identical(found, data)
    kinds = {name: x.dtype.kind for name, x in data.variables.items()}
    assert {name: x.dtype.kind for name, x in found.variables.items()} == kinds
    dm.save(data, tmp_path / "b.nc")
    assert longest.read_bytes() == (tmp_path / "b.nc").read_bytes()


def test_discs_are_words() -> None:
    swept = dm.sweep(dm.steady_sliding, dm.Parameters(N=100, Omega=20), disc=[None, DISC])
    assert swept["disc"].values.tolist() == ["None", str(DISC)]


def test_complex_numbers_are_two_variables() -> None:
    """The imaginary part was 0 where there was no cycle."""
    data = sweep()
    expected = dm.floquet(P.replace(N=150, mu_k=0.2)).multipliers
    np.testing.assert_array_equal(data["multipliers_real"][0], expected.real)
    np.testing.assert_array_equal(data["multipliers_imag"][0], expected.imag)
    assert data["multipliers_imag"][1].isnull().all()
    assert data["multipliers_imag"].attrs["long_name"] == "multiplier of the cycle"


EVENTS = RUN.to_tree()["events"].to_dataset()


@pytest.mark.parametrize(
    ("data", "heads", "first"),
    [
        (ALL_KINDS[["growth", "phase"]], ["N", "Omega (rad s-1)", "growth (s-1)", "phase"], "stick"),
        (EVENTS[["P", "kind"]], ["event", "P (N)", "kind", "time (s)"], RUN.events["kind"][0]),
        (xr.Dataset({"status": "ok"}), ["status"], "ok"),
        (ALL_KINDS["growth"], ["N", "Omega (rad s-1)", "growth (s-1)"], 1.5),
    ],
)  # fmt: skip
def test_a_table_has_units_in_its_heads_and_words(
    data: Any, heads: list[str], first: object, tmp_path: Path
) -> None:
    dm.save(data, tmp_path / "x.csv")
    table = pd.read_csv(tmp_path / "x.csv")
    assert table.columns.tolist() == heads
    assert first in table.iloc[0].tolist()


PHASE = ALL_KINDS["phase"]


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (PHASE, ["stick", "slip", "stick"]),
        (PHASE.where(ALL_KINDS["Omega"] > 1), ["", "slip", "stick"]),
        (dm.words(ALL_KINDS)["phase"], ["stick", "slip", "stick"]),
        (xr.DataArray(np.array(["yes", None], object), attrs=FLAGS), ["yes", ""]),
        (dm.words(RUN.to_tree())["events/kind"], RUN.events["kind"].tolist()),
    ],
)
def test_words_stand_for_numbers(data: xr.DataArray, expected: list[str]) -> None:
    found = dm.words(data)
    assert found.values.tolist() == expected
    assert not {"units", "flag_values", "flag_meanings"} & found.attrs.keys()


# ---- What is refused

BY_CASE = xr.Dataset(coords={"case": ("case", [P])})
PAIRS = pd.MultiIndex.from_product([["a", "b"], [1, 2]], names=["word", "number"])
LEVELS = xr.Dataset({"x": ("i", range(4))}, xr.Coordinates.from_pandas_multiindex(PAIRS, "i"))
ONE = xr.Dataset({"x": ("i", [1])})


@pytest.mark.parametrize(
    ("data", "name", "error", "message"),
    [
        (BY_CASE, "x.nc", ParameterError, "must hold numbers and words"),
        (LEVELS, "x.nc", ParameterError, "must hold numbers and words"),
        (xr.Dataset({"x": 1j}), "x.nc", ParameterError, "must hold numbers and words"),
        (ONE.assign_attrs(a=None), "x.nc", ParameterError, "attributes that are text or numbers"),
        (ONE.assign_attrs(a={}), "x.nc", ParameterError, "attributes that are text or numbers"),
        (ONE.assign_attrs(a=True), "x.nc", ParameterError, "attributes that are text or numbers"),
        (ONE["x"].rename(None), "x.nc", ParameterError, "^data: .*unnamed"),
        (ALL_KINDS["N"], "x.nc", ParameterError, "^data: .*same name as one of its coordinates"),
        (ALL_KINDS, "x.txt", ParameterError, "^path=.*: must end in .nc or .csv"),
        (RUN, "x.csv", ParameterError, "^path=.*: must end in .nc"),
        (RUN.to_tree(), "x.csv", ParameterError, "must be one group to be a table"),
        ([1, 2], "x.nc", ParameterError, "^data=.*must be an xarray.Dataset or xarray.DataTree"),
        (ALL_KINDS, ".", ParameterError, "^path=.*: must be the name of a file"),
        (ALL_KINDS, "no/x.nc", WriteError, r"no/x\.nc: must be in a folder that exists"),
        (ALL_KINDS, "x" * 253 + ".nc", WriteError, "cannot be written: .*too long"),
        (RUN, "a\0b.nc", WriteError, "cannot be written: "),
    ],
)
def test_what_cannot_be_written_is_one_clear_error(
    data: Any, name: str, error: type[Exception], message: str, tmp_path: Path
) -> None:
    with pytest.raises(error, match=message):
        dm.save(data, tmp_path / name)
    assert not [*tmp_path.iterdir()]


def test_a_file_that_cannot_be_written_stays_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "case.nc"
    dm.save(ALL_KINDS, path)
    before = path.read_bytes()
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    larger = xr.Dataset({"x": ("t", np.random.default_rng(1).random(50_000))})
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, limits[1]))
    try:
        with pytest.raises(WriteError, match=r"^[^\n]*case\.nc: cannot be written: [^\n]*$"):
            dm.save(larger, path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert path.read_bytes() == before
    assert os.listdir(tmp_path) == ["case.nc"]


@pytest.mark.parametrize(
    "read", [dm.load, dm.Result.load, load_tree, lambda path: load_cases([path])]
)
def test_what_cannot_be_read_is_one_clear_error(read: Any, tmp_path: Path) -> None:
    path = tmp_path / "a.nc"
    with pytest.raises(MissingFile, match=r"a\.nc: there is no such file"):
        read(path)
    RUN.save(path)
    whole = path.read_bytes()
    for left in (0, 1, 100, len(whole) // 2):
        path.write_bytes(whole[:left])
        with pytest.raises(UnreadableFile, match=r"a\.nc: cannot be read: [^\n]*(\nDelete it|$)"):
            read(path)
    with refusal("^path=.*: must be the name of a file"):
        read(tmp_path)


# ---- Files of named cases


CASE = dm.Parameters(N=200, Omega=50)


def tree_of(p: dm.Parameters, **spec: Any) -> xr.DataTree:
    return run_case(CaseSpec(parameters=p, **{"t_end": 0.05, **spec}))


@pytest.mark.compiled
def test_equal_cases_give_equal_bytes(tmp_path: Path) -> None:
    windows = {
        "history": dm.Window(start=0, stop=0.04, rate=1000, envelope=10),
        "pressed": dm.Window(start=0.01, stop=0.02, rate=2000, theta=0.5),
    }
    events = {"start": 0.01, "stop": 0.05}
    record = {"windows": windows, "poincare": dm.Poincare(theta=2.0), "events": events}
    for file in ("a.nc", "b.nc"):
        dm.save(tree_of(CASE, record=record), tmp_path / file)
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()
    tree = load_tree(tmp_path / "a.nc")
    assert {*tree.children} == {"events", "history", "pressed", "poincare"}
    for node in tree.subtree:
        for name, variable in node.to_dataset(inherit=False).variables.items():
            assert variable.attrs["units"], name
            assert variable.attrs["long_name"], name
            assert not variable.ndim or variable.encoding["fletcher32"], name


def test_a_failed_case_is_a_status() -> None:
    failed = tree_of(CASE.replace(disc=DISC, contact_compliance="residual"))
    assert STATUSES[int(failed["status"])] == failed.attrs["status"] == "failed"
    assert "disc.static_compliance" in failed.attrs["message"]
    assert np.isnan(failed["first_separation"])
