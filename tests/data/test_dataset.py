"""Results as datasets and files: names, units, flags, round trips, equal bytes; whole, or
noticed."""

import json
import os
import resource
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from disc_model import Disc, Parameters, Poincare, Window
from disc_model.data.dataset import UnreadableFile, WriteError, load, load_cases, load_result, save
from disc_model.data.variables import STATUSES, flag_names
from disc_model.simulation.case import CaseSpec
from disc_model.simulation.named_case import run_case
from disc_model.studies.merge import merge_cases

P = Parameters(N=385, Omega=15.1)
T_END = 0.5


def spec_of(p: Parameters = P, events: tuple[float, float] | None = (0.1, T_END)) -> CaseSpec:
    windows = (
        ("history", Window(start=0, stop=0.4995, rate=1000, envelope=50)),
        ("zoom", Window(start=0.1, stop=0.2, rate=2000, theta=0.5)),
    )
    return CaseSpec(
        parameters=p, t_end=T_END, windows=windows, poincare=Poincare(theta=2.0), events=events
    )


@pytest.fixture(scope="module")
def tree() -> xr.DataTree:
    return run_case(spec_of())


@pytest.mark.compiled
def test_every_variable_has_a_unit_and_a_name(tree: xr.DataTree) -> None:
    for node in tree.subtree:
        for name, variable in node.to_dataset(inherit=False).variables.items():
            assert variable.attrs["units"], name
            assert variable.attrs["long_name"], name


@pytest.mark.compiled
def test_a_file_without_compression_holds_the_same(tree: xr.DataTree, tmp_path: Path) -> None:
    small = tmp_path / "small.nc"
    large = tmp_path / "large.nc"
    save(tree, small)
    save(tree, large, compressed=False)
    assert load(large).identical(load(small))
    for path in (small, large):
        forces = load(path)["zoom/P"]
        assert forces.encoding["fletcher32"]
        assert forces.encoding["zlib"] == (path == small)


@pytest.mark.compiled
def test_equal_runs_give_equal_bytes(tmp_path: Path) -> None:
    for name in ("a.nc", "b.nc"):
        case = run_case(spec_of())
        save(case, tmp_path / name)
        save(
            merge_cases({"A": case, "B": case}, {"A": {"title": "é"}}), tmp_path / f"merged_{name}"
        )
    b_path = tmp_path / "b.nc"
    a_path = tmp_path / "a.nc"
    assert a_path.read_bytes() == b_path.read_bytes()
    merged_b_path = tmp_path / "merged_b.nc"
    merged_a_path = tmp_path / "merged_a.nc"
    assert merged_a_path.read_bytes() == merged_b_path.read_bytes()


@pytest.mark.compiled
def test_merged_file_is_a_table_with_a_group_per_case(tree: xr.DataTree, tmp_path: Path) -> None:
    other = run_case(spec_of(P.replace(N=200)))
    other.attrs["git_commit"] = "another"
    labels = {"A": {"title": "first", "reference": "Fig. 1"}, "B": {"title": "zweite, größer"}}
    file = tmp_path / "cases.nc"
    save(merge_cases({"A": tree, "B": other}, labels), file)
    table = xr.open_dataset(file)
    assert list(table["case"].values) == ["A", "B"]
    assert list(table["N"].values) == [385, 200]
    assert list(table["title"].values) == ["first", "zweite, größer"]
    assert list(table["reference"].values) == ["Fig. 1", ""]
    assert list(flag_names(table["status"])) == ["ok", "ok"]
    assert table["first_separation"].attrs["units"] == "s"
    assert {"source_hash", "git_commit", "versions", "Conventions"} <= set(table.attrs)
    assert table.attrs["source_hash"] == tree.attrs["source_hash"]
    assert json.loads(table.attrs["git_commit"]) == sorted([tree.attrs["git_commit"], "another"])
    table.close()
    merged = load(file)
    for name in ("history", "zoom", "poincare"):
        xr.testing.assert_identical(
            merged[f"A/{name}"].to_dataset(inherit=False), tree[name].to_dataset(inherit=False)
        )
    assert merged["A"].attrs["parameters"] == tree.attrs["parameters"]


def test_a_failed_case_is_a_status_in_the_table(tree: xr.DataTree, tmp_path: Path) -> None:
    """Its scalars ask for the compliance of which it failed; a disc given by its modes could not be
    saved."""
    disc = Disc(diameters=[0], omega=[9000], amplitude=[2], static_compliance=1e-9)
    failed = run_case(
        CaseSpec(parameters=P.replace(disc=disc, contact_compliance="residual"), t_end=1.0)
    )
    assert STATUSES[int(failed["status"])] == failed.attrs["status"]
    assert failed.attrs["status"] == "failed"
    for name in ("first_separation", "contact_compliance"):
        assert np.isnan(failed[name])
    file = tmp_path / "cases.nc"
    save(merge_cases({"A": tree, "B": failed}, {}), file)
    table = load(file)
    assert list(flag_names(table["status"])) == ["ok", "failed"]
    assert "static compliance" in str(table["message"].values[1])
    assert list(table["N"].values) == [385, 385]
    assert [Disc.model_validate_json(text) if text else None for text in table["disc"].values] == [
        None,
        disc,
    ]


def test_parameters_that_do_not_count_have_no_number_in_a_file(tmp_path: Path) -> None:
    """D_star was 1e-5 beside the damping ratio that replaces it, and an absent ratio a text."""
    damped = P.replace(
        damping_ratio=1e-3, normalization="orthonormal", contact_force="normal", contact="bilateral"
    )
    disc = P.replace(disc=Disc(diameters=[0], omega=[9000], amplitude=[2]))
    found = {}
    for name, p in {"paper": P, "damped": damped, "given": disc}.items():
        spec = CaseSpec(parameters=p, t_end=0.01)
        save(run_case(spec), tmp_path / f"{name}.nc")
        found[name] = load(tmp_path / f"{name}.nc")
    assert found["paper"]["D_star"] == 1e-5
    assert np.isnan(found["paper"]["damping_ratio"])
    assert np.isnan(found["damped"]["D_star"])
    assert found["damped"]["damping_ratio"] == 1e-3
    assert np.isnan([found["given"][name] for name in ("D_star", "E", "a", "b", "h", "nu")]).all()
    assert found["given"]["m"] == P.m
    for name, word in (
        ("normalization", "orthonormal"), ("contact_force", "normal"), ("contact", "bilateral"),
    ):  # fmt: skip
        assert found["damped"][name].dtype == np.int8
        assert flag_names(found["damped"][name]) == word
    table = merge_cases(found, {}).to_dataset()
    np.testing.assert_array_equal(table["damping_ratio"], [np.nan, 1e-3, np.nan])


HISTORY = np.sin(np.arange(3000.0))
TREE = xr.DataTree.from_dict(
    {"/history": xr.Dataset(dict.fromkeys(("P", "history"), ("time", HISTORY)))}
)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    file = tmp_path / "case.nc"
    save(TREE, file)
    return file


def test_a_variable_with_the_name_of_its_group_is_loaded(path: Path) -> None:
    loaded = load(path)
    path.unlink()
    assert np.array_equal(loaded["history"]["history"], HISTORY)


def test_a_file_that_cannot_be_written_stays_as_it_was(path: Path) -> None:
    before = path.read_bytes()
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    larger = xr.DataTree(xr.Dataset({"x": ("t", np.random.default_rng(1).random(20_000))}))
    resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, limits[1]))
    try:
        with pytest.raises(WriteError, match=r"case\.nc: cannot be written: "):
            save(larger, path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert path.read_bytes() == before
    assert os.listdir(path.parent) == ["case.nc"]


def test_a_damaged_result_says_what_to_do(tmp_path: Path) -> None:
    damaged = tmp_path / "a.nc"
    damaged.write_bytes(b"no netCDF file")
    for read in (load_result, lambda path: load_cases([path])):
        with pytest.raises(UnreadableFile, match=r"a\.nc: cannot be read[^\n]*\nDelete it"):
            read(damaged)
