"""Axes of ratios, which stand for a parameter."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import disc_model as dm
from disc_model.data.variables import flag_names
from disc_model.studies.grids.merge import merge_batches
from disc_model.studies.grids.run import run_batch
from disc_model.studies.study import parse_study
from tests.studies.refused import faults_of, parse_grid

AXES = {"mu_s": [0.4, 0.5], "mu_k_over_mu_s": [0.5, 0.9]}


def raw(**changes: Any) -> dict[str, Any]:
    return {"study": "s", "quantity": "floquet", "base": {"N": 385, "Omega": 15}, "axes": AXES} | changes


def test_a_ratio_varies_a_parameter_with_another() -> None:
    grid = parse_grid(raw(where="mu_k < 0.4", figures={"f": {"kind": "heat_map", "variable": "period", "x": "mu_s"}
                                                       | {"y": "mu_k_over_mu_s"}}))  # fmt: skip
    study = merge_batches([run_batch(text) for text in grid.batches.values()], grid.grid, grid.attrs)
    assert "mu_k" not in grid.base
    for s in AXES["mu_s"]:
        for ratio in AXES["mu_k_over_mu_s"]:
            one = study.sel(mu_s=s, mu_k_over_mu_s=ratio)
            if ratio * s < 0.4:
                expected = dm.floquet(dm.Parameters(N=385, Omega=15, mu_s=s, mu_k=ratio * s))
                np.testing.assert_array_equal(one["growth_rate"], expected.growth_rate)
            else:
                assert flag_names(one["status"]) == "excluded"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"axes": AXES | {"mu_k": [0.2]}}, "axes.mu_k_over_mu_s: stands for mu_k, which is given as well"),
        ({"base": {"N": 1, "Omega": 1, "mu_k": 0.2}}, "axes.mu_k_over_mu_s: stands for mu_k, which is given as well"),
        ({"axes": {"mu_k_over_mu_s": [0.9, 1.5]}}, "axes.mu_k_over_mu_s: mu_k=0.6000000000000001: must be <= mu_s=0.4"),
        ({"axes": {"mu_k_over_mu_s": [0]}}, "axes.mu_k_over_mu_s = 0: must be > 0"),
        ({"axes": {"mu_k_over_k": [0.5]}}, "axes.mu_k_over_k: cannot be an axis, did you mean mu_k_over_mu_s?"),
        (
            {"quantity": "stability_curves", "axes": {"k_p_over_k": [0.4]}, "base": {}}
            | {"options": {"x": "k", "x_range": [1e4, 1e5], "y": "N", "y_lines": {"start": 1, "stop": 2, "count": 2}}},
            "axes.k_p_over_k: needs k, which the quantity stability_curves varies",
        ),
    ],
)
def test_what_a_ratio_cannot_be_is_refused(changes: dict[str, Any], said: str) -> None:
    assert said in faults_of(parse_study, raw(**changes))
