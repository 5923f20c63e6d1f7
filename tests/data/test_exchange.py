"""Datasets in files of other programs: what comes back, and what they find there."""

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import disc_model as dm
from tests.refusals import refusal

P = dm.Parameters(N=200, Omega=50, n_diameters=1)
RUN = dm.simulate(P, 0.02, {"all": dm.Window(rate=2000)})


def every_kind() -> xr.Dataset:
    """A dataset of two dimensions with variables of every kind."""
    words = np.array([["ok", "", "two words "], ["Ωµ", "line\nline", "|"]])
    roots = np.arange(6).reshape(2, 3) * (1 + 2j)
    roots[1, 2] = complex(np.nan, -0.0)
    flags = {"flag_values": np.arange(2, dtype=np.int8), "flag_meanings": "stick slip"}
    variables: dict[str, Any] = {
        "growth": (("N", "Omega"), np.array([[1.5, np.nan, -np.inf], [0.0, 1e-300, 3.0]])),
        "roots": (("N", "Omega"), roots, {"units": "s-1", "long_name": "roots"}),
        "status": (("N", "Omega"), words),
        "stable": ("N", [True, False]),
        "count": ("Omega", np.array([1, 2, 2**53 + 1])),
        "phase": ("Omega", np.array([0, 1, 0], np.int8), flags),
        "short": ("Omega", np.array([0.1, 0.2, 0.3], np.float32)),
        "one": ((), 2.5, {"units": "m", "scale": 3, "weights": np.array([0.5, 0.25])}),
        "root": ((), 1j),
        "word": ((), "stick_slip"),
        "nothing": ((), ""),
        "certain": ((), True),
        "none": ("empty", np.zeros(0)),
        "no_words": ("empty", np.array([], dtype=str)),
        "single": ("one_value", ["alone"]),
    }
    coordinates = {
        "N": ("N", [100.0, 200.0], {"units": "N"}),
        "Omega": ("Omega", [1.0, 2.0, 3.0], {"units": "rad s-1"}),
        "pole": ("N", [1 + 1j, 2 - 1j]),
        "mu_s": ((), 0.4),
    }
    return xr.Dataset(variables, coordinates, {"function": "floquet", "number": 2.0})


# ---- What comes back


def test_a_dataset_comes_back_as_it_was(tmp_path: Path) -> None:
    data = every_kind()
    path = tmp_path / "data.nc"
    dm.save(data, path)
    found = dm.load(path)
    xr.testing.assert_identical(found, data)
    assert list(found.variables) == list(data.variables)
    for name, variable in data.variables.items():
        assert found[name].dtype.kind == variable.dtype.kind, name
        if variable.dtype.kind not in "U":
            assert found[name].values.tobytes() == variable.values.tobytes(), name


def test_a_sweep_comes_back_as_it_was(tmp_path: Path) -> None:
    """Its multipliers are complex, which netCDF cannot hold."""
    swept = dm.sweep(dm.floquet, P, zip={"N": [150, 200], "mu_k": [0.2, 0.41]})
    assert swept["multipliers"].dtype == complex
    assert swept["status"].values.tolist() == ["ok", "failed"]
    dm.save(swept, tmp_path / "sweep.nc")
    xr.testing.assert_identical(dm.load(tmp_path / "sweep.nc"), swept)


def test_both_parts_of_missing_numbers_are_missing(tmp_path: Path) -> None:
    """Imaginary parts were 0 in the file where there was no cycle."""
    swept = dm.sweep(dm.floquet, P, zip={"N": [150, 200], "mu_k": [0.2, 0.41]})
    dm.save(swept, tmp_path / "sweep.nc")
    with xr.open_dataset(tmp_path / "sweep.nc") as file:
        failed = file.isel(N_mu_k=1)
        assert np.isnan(failed["multipliers_real"]).all()
        assert np.isnan(failed["multipliers_imag"]).all()


def test_a_sweep_over_discs_comes_back_as_it_was(tmp_path: Path) -> None:
    """Discs could not be saved."""
    columns = {"diameters": [2, 3], "omega": [900.0, 1500.0 / 7], "amplitude": [1.0, 1.0]}
    discs = [dm.Disc(**columns, damping_ratio=[ratio] * 2) for ratio in (1e-3, 1e-4 / 3)]
    case = dm.Parameters(N=100, Omega=20, r_0=0.2, disc=discs[0])
    for pairs in ({"disc": discs}, {"zip": {"disc": discs, "N": [50.0, 70.0]}}):
        swept = dm.sweep(dm.steady_sliding, case, Omega=[20.0, 30.0], **pairs)
        path = tmp_path / "sweep.nc"
        dm.save(swept, path)
        found = dm.load(path)
        assert found["disc"].values.tolist() == discs
        assert found["disc"].values.tolist() != discs[::-1]
        xr.testing.assert_identical(found, swept)


def test_a_sweep_over_the_plate_and_a_disc_comes_back_as_it_was(tmp_path: Path) -> None:
    """It could not be saved."""
    disc = dm.Disc(diameters=[2], omega=[900.0], amplitude=[1.0])
    path = tmp_path / "sweep.nc"
    for discs in ([None, disc], [None]):
        swept = dm.sweep(dm.steady_sliding, dm.Parameters(N=100, Omega=20), disc=discs)
        dm.save(swept, path)
        found = dm.load(path)
        assert found["disc"].values.tolist() == discs
        xr.testing.assert_identical(found, swept)


def test_a_table_names_the_plate_beside_a_disc(tmp_path: Path) -> None:
    disc = dm.Disc(diameters=[2], omega=[900.0], amplitude=[1.0])
    swept = dm.sweep(dm.steady_sliding, dm.Parameters(N=100, Omega=20), disc=[None, disc])
    path = tmp_path / "sweep.csv"
    dm.save(swept[["status", "growth_rate"]], path)
    plate, other = pd.read_csv(path)["disc"]
    assert plate == "plate"
    assert dm.Disc.model_validate_json(other) == disc


def test_groups_come_back_as_a_tree(tmp_path: Path) -> None:
    scalars = RUN.to_tree().to_dataset()
    tree = xr.DataTree.from_dict({"/": scalars, "grid": every_kind(), "grid/all": RUN["all"]})
    dm.save(tree, tmp_path / "tree.nc")
    found = dm.load(tmp_path / "tree.nc")
    assert isinstance(found, xr.DataTree)
    xr.testing.assert_identical(found, tree)


def test_a_part_without_the_other_stays_what_it_is(tmp_path: Path) -> None:
    data_path = tmp_path / "data.nc"
    dm.save(every_kind(), data_path)
    other_path = tmp_path / "other.nc"
    with xr.open_dataset(data_path) as opened:
        opened.drop_vars("roots_imag").to_netcdf(other_path)
    found = dm.load(other_path)
    np.testing.assert_array_equal(found["roots_real"], every_kind()["roots"].values.real)


# ---- What other programs find


def test_netcdf_has_real_and_imaginary_parts(tmp_path: Path) -> None:
    data = every_kind()
    path = tmp_path / "data.nc"
    dm.save(data, path)
    with xr.open_dataset(path) as opened:
        np.testing.assert_array_equal(opened["roots_real"], data["roots"].values.real)
        np.testing.assert_array_equal(opened["roots_imag"], data["roots"].values.imag)
        assert opened["roots_real"].attrs["units"] == "s-1"
        assert "roots" not in opened


# ---- What cannot be written or read

TWO_LEVELS = pd.MultiIndex.from_product([["a", "b"], [1, 2]], names=["word", "number"])
BY_CASE = xr.Dataset(coords={"case": ("case", [P])})


@pytest.mark.parametrize(
    ("data", "name", "message"),
    [
        (BY_CASE, "x.nc", "^case: must hold numbers or words to be saved, and holds Parameters$"),
        (xr.Dataset({"t": ("t", [np.datetime64("2026-01-01")])}), "x.nc", "^t: must hold numbers"),
        (xr.Dataset({"x": ("i", [1])}, attrs={"a": None}), "x.nc", "^a=None: must be text or num"),
        (xr.Dataset({"x": ("i", [1], {"a": True})}), "x.nc", "^x.a=True: must be text or numbers"),
        (xr.Dataset({"x": ((), 1j), "x_real": ((), 1.0)}), "x.nc", "^x_real: must have another"),
        (every_kind(), "x.txt", "must end in .nc or .csv"),
        (
            every_kind(),
            "x.csv",
            "^data=.*none, no_words, single.*: must be along N, Omega to be one",
        ),
        (RUN.to_tree(), "x.csv", "must be one group to be a table"),
    ],
)
def test_what_a_file_cannot_hold_is_refused(
    data: Any, name: str, message: str, tmp_path: Path
) -> None:
    with refusal(message):
        dm.save(data, tmp_path / name)
    assert not [*tmp_path.iterdir()]


def test_an_index_of_two_levels_is_refused(tmp_path: Path) -> None:
    data = xr.Dataset(
        {"x": ("i", range(4))}, xr.Coordinates.from_pandas_multiindex(TWO_LEVELS, "i")
    )
    with refusal(r"^i: must hold numbers or words"):
        dm.save(data, tmp_path / "x.nc")


# ---- Tables of text


def test_events_and_samples_are_written_as_text_with_units_and_words(tmp_path: Path) -> None:
    RUN.to_csv(tmp_path / "new" / "run")
    folder = tmp_path / "new" / "run"
    assert sorted(path.name for path in folder.iterdir()) == ["all.csv", "events.csv"]
    events = pd.read_csv(folder / "events.csv")
    assert events.columns[:4].tolist() == ["time (s)", "kind", "phase", "psi (rad)"]
    assert events["kind"].tolist() == RUN.events["kind"].tolist()
    with open(folder / "all.csv", encoding="utf-8", newline="") as file:
        samples = [*csv.DictReader(file)]
    np.testing.assert_array_equal([float(row["P (N)"]) for row in samples], RUN["all"]["P"])
    assert {row["phase"] for row in samples} == {"stick", "slip"}


def test_a_table_given_for_a_dataset_is_told_what_to_do(tmp_path: Path) -> None:
    table = tmp_path / "growth.csv"
    table.write_text("N,Omega\n1,2\n")
    with refusal(r"tables are for pandas"):
        dm.load(table)


def test_a_run_is_written_by_its_own_method(tmp_path: Path) -> None:
    """It was refused, since it has a method save."""
    dm.save(RUN, tmp_path / "run.nc")
    assert dm.Result.load(tmp_path / "run.nc") == RUN
    with refusal(r"must end in .nc"):
        dm.save(RUN, tmp_path / "run.csv")


def test_the_table_of_events_has_units() -> None:
    units = RUN.events.attrs["units"]
    of_file = RUN.to_tree()["events"]
    assert units == {
        "time": "s",
        "psi": "rad",
        "f": "rad s-1",
        "u": "m",
        "u_velocity": "m s-1",
        "P": "N",
    }
    assert all(of_file[name].attrs["units"] == unit for name, unit in units.items())


def test_an_array_is_written_as_a_dataset_of_it(tmp_path: Path) -> None:
    """It was refused, and `to_dataset` had to be called."""
    growth = dm.sweep(dm.floquet, dm.Parameters(N=385, Omega=15), Omega=[12, 14]).growth_rate
    dm.save(growth, tmp_path / "growth.nc")
    assert dm.load(tmp_path / "growth.nc").identical(growth.to_dataset())
    dm.save(growth, tmp_path / "growth.csv")
    assert (tmp_path / "growth.csv").read_text().startswith("Omega (rad s-1),growth_rate")
    with refusal(r"data: must have a name, which is that of its variable in the file"):
        dm.save(growth.rename(None), tmp_path / "growth.nc")
    with refusal(r"data: must have another name than its coordinate Omega"):
        dm.save(growth.Omega, tmp_path / "growth.nc")


GRID: dict[str, Any] = {
    "study": "s",
    "quantity": "outcome",
    "base": {"Omega": 50, "n_diameters": 1},
    "axes": {"N": [150, 200]},
    "options": {"horizon": 1},
}


def test_a_grid_is_written_as_a_table_with_units_and_words(tmp_path: Path) -> None:
    """A dataset could be saved for other programs, but not for a spreadsheet."""
    grid = dm.run_study(GRID)
    path = tmp_path / "grid.csv"
    dm.save(grid, path)
    table = pd.read_csv(path)
    assert table["N (N)"].tolist() == [150, 200]
    assert table["status"].tolist() == ["ok", "ok"]
    assert table["outcome"].tolist() == dm.words(grid["outcome"]).values.tolist()
    np.testing.assert_array_equal(table["P_max (N)"], grid["P_max"])
    assert not table.filter(like=") (").columns.tolist()


def test_a_sweep_is_a_table_with_a_row_for_each_further_place(tmp_path: Path) -> None:
    swept = dm.sweep(dm.floquet, P, N=[150, 200], mu_k=[0.2, 0.24])
    path = tmp_path / "sweep.csv"
    dm.save(swept[["growth_rate", "exponents"]], path)
    table = pd.read_csv(path)
    second = table[table["exponents_index"] == 1]
    assert second["N (N)"].tolist() == [150, 150, 200, 200]
    assert second["mu_k"].tolist() == [0.2, 0.24, 0.2, 0.24]
    np.testing.assert_array_equal(second["growth_rate (s-1)"], swept["growth_rate"].values.ravel())
    found = swept["exponents"].isel(exponents_index=1).values
    np.testing.assert_array_equal(second["exponents_imag (s-1)"], found.imag.ravel())


def test_a_result_without_points_is_a_table_of_one_row(tmp_path: Path) -> None:
    path = tmp_path / "outcome.csv"
    dm.save(dm.outcome(P, 1), path)
    assert pd.read_csv(path)["status"].tolist() == ["ok"]


# ---- Words


def test_words_of_studies_are_those_of_sweeps() -> None:
    """`status == "ok"` was false for all points of a study, and true for those of a sweep."""
    grid = dm.words(dm.run_study(GRID))
    swept = dm.sweep(dm.outcome, P.replace(Omega=50), horizon=1, N=[150, 200])
    for name in ("status", "outcome"):
        assert grid[name].values.tolist() == swept[name].values.tolist()
        assert "long_name" in grid[name].attrs
        assert not {"units", "flag_values", "flag_meanings"} & grid[name].attrs.keys()
    xr.testing.assert_identical(dm.words(swept), swept)


def test_words_of_a_variable_and_of_a_tree() -> None:
    tree = RUN.to_tree()
    kinds = RUN.events["kind"].tolist()
    assert dm.words(tree["events/kind"]).values.tolist() == kinds
    assert dm.words(tree)["events/kind"].values.tolist() == kinds
    xr.testing.assert_identical(dm.words(tree["events/time"]), tree["events/time"])


def test_a_point_that_is_left_out_has_no_word() -> None:
    status = dm.run_study(GRID)["status"]
    heavy = status.where(status["N"] > 160)
    assert dm.words(heavy).values.tolist() == ["", "ok"]
