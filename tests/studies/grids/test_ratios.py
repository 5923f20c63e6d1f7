"""Axes of ratios, which stand for a parameter."""

from typing import Any

import numpy as np

import disc_model as dm
from disc_model.data.variables import flag_names
from disc_model.studies.grids.merge import merge_batches
from disc_model.studies.grids.run import run_batch
from tests.studies.refused import parse_grid

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
