"""Titles of many values above axes of a reader."""

import json

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

import disc_model as dm
from disc_model.figures.drawing import large
from disc_model.figures.sizes import COLUMN, INCH
from tests.figures.reading import as_map

MANY = {"mu_k": 0.25, "E": 2e11, "m": 0.3, "D_star": 2e-5, "k_p": 1.5e4, "nu": 0.3}
FEW = {"k_p": 1.5e4}


def outcomes(values: dict[str, float]) -> xr.Dataset:
    """Outcomes over speed and preload."""
    words = np.full((4, 4), "quiet")
    words[2:] = "separating"
    plane = xr.DataArray(words, {"Omega": [5.0, 6, 7, 8], "N": [200.0, 300, 400, 500]})
    case = dm.Parameters(N=385, Omega=15, **values)
    return plane.to_dataset(name="outcome").assign_attrs(base=json.dumps(case.model_dump()))


@pytest.mark.parametrize(("values", "share"), [(MANY, 0.75), (FEW, 1.0)])
def test_many_values_above_a_column_wide_map_have_two_lines(
    values: dict[str, float], share: float
) -> None:
    """They had three, of 10 points."""
    _, ax = pyplot.subplots(figsize=(COLUMN, 70 / INCH), layout="constrained")
    as_map(outcomes(values), "outcome", ax=ax, title=True)
    title = ax.get_title(loc="left")
    assert title.count("\n") < 2
    assert "more" not in title
    assert ax._left_title.get_fontsize() == pytest.approx(share * large(8))
