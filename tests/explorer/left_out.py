"""A made-up study whose rule leaves points out: all of those at the first value of mu_s, and one more."""

import numpy as np
import xarray as xr

from disc_model.studies.run import describe
from tests.explorer.test_page import flagged

RULE = "mu_k <= mu_s"
CALL = {
    "quantity": "outcome",
    "columns": ["outcome", "P_max"],
    "recipes": [
        {
            "function": "dm.outcome",
            "arguments": [],
            "numbers": {"outcome": "", "P_max": ""},
            "takes_kick": True,
        }
    ],
}


def ruled() -> xr.Dataset:
    """Outcomes over speed, preload and static friction."""
    axes = {"Omega": [10.0, 15.0, 20.0], "N": [300.0, 385.0], "mu_s": [0.2, 0.4]}
    left_out = np.zeros((3, 2, 2), dtype=bool)
    left_out[:, :, 0] = True
    left_out[2, 1, :] = True
    status = np.where(left_out, 2, 0).astype(np.int8)
    outcome = np.where(left_out, 2, 0).astype(np.int8)
    force = np.where(left_out, np.nan, 400.0)
    data = {
        "status": ([*axes], status, flagged("ok failed excluded")),
        "outcome": ([*axes], outcome, flagged("quiet growing excluded")),
        "P_max": ([*axes], force, {"long_name": "greatest contact force", "units": "N"}),
        "message": ([*axes], np.full((3, 2, 2), "", dtype=object)),
    }
    coords = {name: (name, values, describe(name)) for name, values in axes.items()}
    stated = {"title": "With a rule", "quantity": "outcome", "options": '{"horizon": 200}'}
    return xr.Dataset(data, coords, {**stated, "where": f"({RULE})"})
