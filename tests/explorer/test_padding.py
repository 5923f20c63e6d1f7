"""Counts at places of a list beyond what was found."""

import numpy as np
import xarray as xr

from disc_model.explorer.padding import without_padding
from tests.explorer.test_page import flagged


def test_there_is_no_count_of_a_further_attractor() -> None:
    """The page said that 0 starts reach it, beside "no further attractor" of its period."""
    dims = ["Omega", "attractor"]
    kinds = np.array([[1, 0], [1, 2]], np.int8)
    data = {
        "attractor_kind": (dims, kinds, flagged("none quiet separating")),
        "attractor_starts": (dims, np.array([[4, 0], [3, 0]])),
        "attractor_period": (dims, np.array([[0.1, np.nan], [0.1, 0.2]])),
        "status": ("Omega", np.zeros(2, np.int8), flagged("ok failed")),
    }
    study = xr.Dataset(data, {"Omega": [9.0, 12.0], "attractor": [1, 2]})
    found = without_padding(study)
    np.testing.assert_array_equal(found["attractor_starts"], [[4, np.nan], [3, 0]])
    for name in ("attractor_kind", "attractor_period", "status"):
        assert found[name].identical(study[name])
    others = study.drop_vars("attractor_kind")
    assert without_padding(others).identical(others)
