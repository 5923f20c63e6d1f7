"""Neutral curves and folds over two parameters."""

import numpy as np
import pytest
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.growth_map import curves_of
from tests.stability.toy_map import fold_at, outside
from tests.studies.conftest import computed

CURVES = {
    "study": "curves",
    "quantity": "stability_curves",
    "options": {"x_range": [12, 18], "y_lines": {"start": 385, "stop": 400, "count": 2}, "points": 7, "max_points": 12},
    "axes": {"normalization": ["as_published"]},
}


def test_curves_are_stored_point_by_point(plane: xr.Dataset) -> None:
    one = plane.squeeze("normalization")
    assert one["n_curves"] == 2
    assert one["n_continuation_failures"] == 0
    kinds = flag_names(one["kind"])
    assert sorted(kinds[:2]) == ["fold", "neutral"]
    for i, kind in enumerate(kinds[:2]):
        x, y = (one[name].isel(curve=i).dropna("curve_point").values for name in ("x", "y"))
        assert np.abs(outside(x, y) if kind == "neutral" else x - fold_at(y)).max() < 1e-5
    # the ellipse only borders on stable cycles
    (drawn,) = curves_of(one)
    assert drawn.kind == "neutral"


@pytest.mark.compiled
def test_the_fold_of_the_paper_is_found_once_and_named() -> None:
    one = computed(**CURVES).isel(normalization=0)
    assert flag_names(one["status"]) == "ok"
    folds = np.flatnonzero(flag_names(one["kind"]) == "fold")
    at = [
        np.interp(385.0, *np.sort(one[["y", "x"]].isel(curve=i).dropna("curve_point").to_array().values)) for i in folds
    ]
    near = [i for i, speed in zip(folds, at, strict=True) if abs(speed - 15.0949) < 5e-3]
    assert len(near) == 1
    drawn = [curve for curve in curves_of(one) if curve.kind == "fold"]
    assert "2 f_s = 135.42 Hz" in [curve.label for curve in drawn]
