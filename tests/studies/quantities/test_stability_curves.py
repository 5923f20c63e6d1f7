"""Neutral curves and folds over two parameters."""

import numpy as np
import xarray as xr

from disc_model.data.variables import flag_names
from disc_model.figures.curves import curves_of
from tests.stability.toy_map import fold_at, outside


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
