"""Batches put together again: in the grid's order, whole, and with failures named."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from disc_model.studies.merge import MergeError, _excluded, merge_batches, merge_cases
from disc_model.studies.point_lists import _status_text, failures, point_text, remarks
from disc_model.studies.run import run_batch
from tests.studies.conftest import computed
from tests.studies.refused import parse_grid

#: The slider stays where it is on the disc: nothing has to be computed.
STILL = {"study": "still", "quantity": "floquet", "base": {"k_p": 0}, "batch": {"size": 2}}
STILL["axes"] = {"N": [100, 200], "Omega": [10, 20]}


@pytest.fixture
def batches() -> list[xr.Dataset]:
    return [run_batch(text) for text in parse_grid(STILL).batches.values()]


def test_merged_points_are_in_the_order_of_the_grid(
    batches: list[xr.Dataset], tmp_path: Path
) -> None:
    study = parse_grid(STILL)
    path = tmp_path / "still.nc"
    merge_batches(batches[::-1], study.grid, {"title": "t"}).to_netcdf(path)
    merged = xr.load_dataset(path)
    assert dict(merged["status"].sizes) == {"N": 2, "Omega": 2}
    assert merged["N"].values.tolist() == [100, 200]
    assert merged.attrs["title"] == "t"
    assert json.loads(merged.attrs["base"])["contact"] == "unilateral"
    assert merged["Omega"].attrs["units"] == "rad s-1"
    assert merged["growth_rate"].attrs["units"] == "s-1"
    lines = list(failures(merged))
    assert len(lines) == 4
    where = "N = 100 N, Omega = 10 rad/s"
    assert lines[0].startswith(f"{where}: permanent stick: at_rest: the slider stays")
    assert "Nothing ever slips" in lines[0]


def test_a_remark_on_a_point_with_a_result_is_no_failure() -> None:
    """It stood in the file of failed points, as of one whose motion had not settled."""
    flags = {"flag_meanings": "ok failed excluded"}
    study = xr.Dataset(
        {
            "status": ("N", np.array([0, 0, 1, 2], np.int8), flags),
            "message": ("N", ["", "not settled", "ParameterError: x", ""]),
        },
        {"N": [1.0, 2.0, 3.0, 4.0]},
    )
    assert list(failures(study)) == ["N = 3 N: failed: ParameterError: x"]
    assert list(remarks(study)) == ["N = 2 N: not settled"]


def test_what_is_no_parameter_has_its_unit_in_lists_of_points() -> None:
    point = {"perturbation_f": 0.1, "mu_k_over_mu_s": 0.5, "sample": 3}
    expected = "perturbation_f = 0.1 rad/s, mu_k_over_mu_s = 0.5, sample = 3"
    assert point_text(point) == expected


def test_a_study_states_its_rules() -> None:
    raw = {
        "quantity": "floquet",
        "base": {"k_p": 0, "Omega": 10},
        "axes": {"N": [100, 200], "c": [0.0, 1.0]},
        "where": ["N > 50", "c < 2 or N < 150"],
    }
    done = computed(**raw)
    assert done.attrs["where"] == "(N > 50) and (c < 2 or N < 150)"


def test_the_table_of_cases_has_their_messages_and_labels() -> None:
    cases = {
        name: xr.DataTree(xr.Dataset({"N": N}, attrs={"message": message, "source_hash": "1"}))
        for name, N, message in (("A", 1.0, ""), ("B", 2.0, "a paradox"))
    }
    merged = merge_cases(cases, {"A": {"title": "first", "reference": "Fig. 1"}}).to_dataset()
    assert merged["case"].values.tolist() == ["A", "B"]
    for name, texts in {
        "message": ["", "a paradox"],
        "title": ["first", ""],
        "reference": ["Fig. 1", ""],
    }.items():
        assert merged[name].values.tolist() == texts
    assert merged.attrs["source_hash"] == "1"


def test_what_a_quantity_varies_is_no_value_of_the_base(fake_motions: None) -> None:
    """A study of critical speeds stated a speed of 0, and one along mu_s the default."""
    scan = {"start": 12, "stop": 13, "count": 2}
    options = {"horizons": [900], "scan": scan, "precision": 1}
    done = computed(quantity="critical_speed", options=options, axes={"N": [200], "c": [0.0]})
    base = json.loads(done.attrs["base"])
    assert not {"N", "c", "Omega"} & base.keys()
    assert base["mu_s"] == 0.4
    still = {"N": 200, "Omega": 20, "k_p": 0}
    options = {"parameter": "mu_k_over_mu_s", "scan": {"start": 0.4, "stop": 0.5, "count": 2}}
    done = computed(quantity="sliding", options=options, base=still, axes={"c": [0.0]})
    base = json.loads(done.attrs["base"])
    assert "mu_k" not in base
    assert base["mu_s"] == 0.4
    assert done["value"].attrs["units"] == "1", "a coordinate in mm or N had no unit"


def test_a_damping_that_a_ratio_replaces_is_no_value_of_the_base() -> None:
    """A study of modes stated D_star = 1e-5, which none of its points had."""
    options = {"parameter": "Omega", "scan": {"start": 10, "stop": 20, "count": 2}}
    given = {"N": 200, "damping_ratio": 0.001}
    modes = computed(quantity="sliding", options=options, base=given, axes={"c": [0.0]})
    assert modes["value"].attrs["units"] == "rad s-1"
    cycles = computed(
        quantity="floquet", base={"N": 385, "Omega": 10}, axes={"damping_ratio": [0.001]}
    )
    for study in (modes, cycles):
        assert "D_star" not in json.loads(study.attrs["base"])


def test_words_are_those_of_the_table_whatever_the_batches_say(batches: list[xr.Dataset]) -> None:
    """A word that was changed cost all computations."""
    study = parse_grid(STILL)
    assert all(
        "long_name" not in batch[name].attrs for batch in batches for name in batch.data_vars
    )
    older = [batch.copy() for batch in batches]
    for batch in older:
        batch["period"].attrs = {"units": "s", "long_name": "a period, nan if there is none"}
    merged, again = (merge_batches(each, study.grid, {"study": "x"}) for each in (batches, older))
    assert again.identical(merged)
    assert merged["period"].attrs["long_name"] == "period of the cycle"
    assert merged["period"].attrs["missing"] == "there is no cycle"


def test_merging_refuses_what_does_not_fit(batches: list[xr.Dataset]) -> None:
    study = parse_grid(STILL)
    fewer = parse_grid(STILL | {"axes": {"N": [100], "Omega": [10, 20]}})
    for some, grid in (
        (batches[1:], study.grid),
        ([*batches, batches[0]], study.grid),
        (batches, fewer.grid),
    ):
        with pytest.raises(MergeError, match="not those of the grid"):
            merge_batches(some, grid, {})


def test_a_study_states_the_discs_of_all_batches() -> None:
    table = {"diameters": [0], "omega": [1500.0], "amplitude": [2.0], "damping_ratio": [1e-3]}
    discs = {"a": table, "b": {**table, "omega": [1600.0]}}
    raw = {"study": "s", "quantity": "floquet", "discs": discs, "batch": {"size": 1}}
    raw |= {"base": {"N": 200, "Omega": 20}, "axes": {"disc": ["a", "b"]}}
    grid = parse_grid(raw)
    assert len(grid.batches) == 2
    point = {"status": ("point", np.array([0], np.int8), {"flag_meanings": "ok failed"})}
    batches = []
    for text in grid.batches.values():
        [name] = json.loads(text)["discs"]
        coords = {"disc": ("point", [name])}
        batches.append(xr.Dataset(point, coords, {"specification": text}))
    merged = merge_batches(batches, grid.grid, {})
    stated = json.loads(merged.attrs["discs"])
    assert {name: disc["omega"] for name, disc in stated.items()} == {"a": [1500], "b": [1600]}


def test_what_a_rule_leaves_out_is_missing_and_no_number() -> None:
    done = computed(
        quantity="floquet",
        base={"k_p": 0, "Omega": 10},
        axes={"N": [100, 200], "c": [0.0, 1.0]},
        where="c < 150/N",
    )
    assert done["status"].attrs["flag_meanings"].split()[-1] == "excluded"
    assert done["status"].values[1, 1] == len(done["status"].attrs["flag_meanings"].split()) - 1
    assert np.isnan(done["period"].values[1, 1])
    assert done["message"].values[1, 1] == ""


def test_a_status_is_said_once_and_a_message_that_has_its_word_keeps_it() -> None:
    assert _status_text("failed", "failed: no steps") == "failed: no steps"
    assert (
        _status_text("failed", "ParameterError: it failed") == "failed: ParameterError: it failed"
    )


def test_what_is_left_out_has_no_number_no_text_and_a_count_of_none() -> None:
    number, _ = _excluded(xr.DataArray([1.0]))
    count, _ = _excluded(xr.DataArray([1]))
    word, _ = _excluded(xr.DataArray(["x"]))
    assert np.isnan(number)
    assert count == 0
    assert word == ""
