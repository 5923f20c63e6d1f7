"""Grids: values along axes, points and jobs, and results over their dimensions."""

import json
import math
from itertools import chain
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import disc_model as dm
from disc_model.studies.compute import stack
from disc_model.studies.grid import expand
from disc_model.studies.run import merge, points_of, run_job, told_points
from disc_model.studies.study import Study, parse_study

STUDY: dict[str, Any] = {
    "study": "small",
    "quantity": "floquet",
    "base": {"mu_k": 0.2},
    "axes": {"N": [385, 300], "Omega": {"start": 10, "stop": 14, "step": 1}},
    "points_per_job": 4,
}


def study_of(**changes: Any) -> Study:
    return parse_study({**STUDY, **changes})


@pytest.mark.parametrize(
    ("axis", "values"),
    [
        ([0.3, "1e-1", 0.20], [0.1, 0.2, 0.3]),
        ({"start": 0, "stop": 0.3, "step": 0.1}, [0.0, 0.1, 0.2, 0.3]),
        ({"start": 0.1, "stop": 10, "count": 3, "scale": "log"}, [0.1, 1.0, 10.0]),
        ([{"start": 1, "stop": 2, "count": 2}, 1.5, 1], [1.0, 1.5, 2.0]),
        (["500 N s/m", 0.1], [0.1, 500.0]),
    ],
)
def test_an_axis_mixes_values_and_ranges(axis: Any, values: list[float]) -> None:
    grid = study_of(axes={**STUDY["axes"], "c": axis})
    assert grid.dims["c"]["c"].tolist() == values


def test_points_are_a_table_in_the_order_of_the_parameters() -> None:
    dims = {
        "N": pd.DataFrame({"N": [1.0, 2.0]}),
        "k_m": pd.DataFrame({"k": [1.0, 2.0], "m": [3.0, 4.0]}),
    }
    assert expand(dims).to_dict("list") == {
        "N": [1.0, 1.0, 2.0, 2.0],
        "k": [1.0, 2.0, 1.0, 2.0],
        "m": [3.0, 4.0, 3.0, 4.0],
    }


def test_jobs_hold_all_points_once_and_are_named_by_their_content() -> None:
    grid = study_of()
    jobs = {key: json.loads(text) for key, text in grid.jobs.items()}
    assert [len(job["points"]) for job in jobs.values()] == [4, 3, 3]
    assert [*chain(*(job["points"] for job in jobs.values()))] == grid.points.to_dict("records")
    assert grid.jobs == study_of().jobs
    contents = {key.partition("-")[0] for key in jobs}
    assert len(contents) == 1
    further = {
        key.partition("-")[0] for key in study_of(axes={"N": [385], "Omega": [11, 12, 13.5]}).jobs
    }
    assert further == contents
    for change in ({"base": {"mu_k": 0.21}}, {"options": {"tol": 1e-11}}):
        assert {key.partition("-")[0] for key in study_of(**change).jobs}.isdisjoint(contents)


def test_a_study_a_sweep_and_direct_calls_give_equal_numbers() -> None:
    """Over three axes; by a study, jobs and their merging, a sweep, and one call."""
    axes = {"N": [385, 300], "Omega": [10, 12], "mu_k": [0.2, 0.24]}
    study = dm.run_study({**STUDY, "base": {}, "axes": axes})
    swept = dm.sweep(
        dm.floquet, dm.Parameters(N=385, Omega=15), **{name: sorted(x) for name, x in axes.items()}
    )
    grid = study_of(base={}, axes=axes)
    results = [row for job in grid.jobs.values() for _, row in points_of(run_job(job))]
    merged = merge(json.loads(json.dumps(grid.layout)), results, {})
    for name in ("growth_rate", "period", "stick_fraction"):
        assert study[name].dims == swept[name].dims == ("N", "Omega", "mu_k")
        np.testing.assert_array_equal(study[name], swept[name])
        np.testing.assert_array_equal(study[name], merged[name])
    case = dm.Parameters(N=300, Omega=12, mu_k=0.2)
    assert study["growth_rate"].sel(N=300, Omega=12, mu_k=0.2) == dm.floquet(case).growth_rate
    assert study["growth_rate"].attrs["units"] == "s-1"
    assert dm.words(study["status"]).values.tolist() == swept["status"].values.tolist()


def test_a_further_value_takes_points_that_are_known() -> None:
    known = [run_job(job) for job in study_of().jobs.values()]
    calls = []

    def counted(*args: Any, **options: Any) -> Any:
        calls.append(args)
        return original(*args, **options)

    more = study_of(axes={"N": [385, 300], "Omega": [10, 11, 11.5, 12, 13, 14]}, points_per_job=100)
    [job] = more.jobs.values()
    quantity = more.of
    original = quantity.function
    object.__setattr__(quantity, "function", counted)
    try:
        results = run_job(job, known)
    finally:
        object.__setattr__(quantity, "function", original)
    assert len(calls) == 2
    xr.testing.assert_equal(results, run_job(job))


def test_what_failed_is_missing() -> None:
    study = dm.run_study({**STUDY, "base": {"N": 385}, "axes": {"Omega": [12], "mu_k": [0.2, 0.5]}})
    words = dm.words(study["status"]).values
    assert words.tolist() == [["ok", "failed"]]
    assert np.isnan(study["growth_rate"].values[words != "ok"]).all()
    failures, _ = told_points(study)
    assert failures["mu_k"].tolist() == [0.5]


def test_what_a_rule_leaves_out_is_missing_and_no_failure() -> None:
    whole = dm.run_study(STUDY)
    study = dm.run_study({**STUDY, "where": "N < Omega * 30"})
    words = dm.words(study["status"])
    kept = words == "ok"
    assert {*words.values.ravel().tolist()} == {"ok", "excluded"}
    np.testing.assert_array_equal(kept, (study["N"] < 30 * study["Omega"]).broadcast_like(kept))
    np.testing.assert_array_equal(study["growth_rate"], whole["growth_rate"].where(kept))
    assert told_points(study)[0].empty


def test_an_infinite_value_and_words_go_through_jobs() -> None:
    axes = {
        "friction_decay": [1, math.inf],
        "normalization": ["orthonormal"],
        "N": [385],
        "Omega": [12],
    }
    [job] = study_of(axes=axes, points_per_job=9).jobs.values()
    results = run_job(job)
    assert results["friction_decay"].values.tolist() == [1.0, math.inf]
    assert results["normalization"].values.tolist() == ["orthonormal"] * 2


def test_stacked_results_keep_kinds_and_end_in_what_is_missing() -> None:
    rows = [
        xr.Dataset({"n": 1, "x": ("i", [1.0, 2.0]), "word": "a", "stable": True}),
        xr.Dataset({"n": 2, "x": ("i", [3.0]), "word": "bcd"}),
    ]
    found = stack(rows, {"N": pd.DataFrame({"N": [1.0, 2.0]})})
    assert found["n"].dtype.kind == "i"
    assert found["word"].values.tolist() == ["a", "bcd"]
    np.testing.assert_array_equal(found["x"], [[1, 2], [3, math.nan]])
    np.testing.assert_array_equal(found["stable"], [1, math.nan])
